"""Build a fuzzy system, evaluate it, tune it to data, save it and load it again."""

import numpy as np

import fuzzyrs as fz

# Two inputs with three Gaussian terms each; one rule for each of the nine combinations.
angle = fz.Variable.evenly("angle", (-1, 1), ["left", "ahead", "right"])
rate = fz.Variable.evenly("rate", (-1, 1), ["falling", "steady", "rising"])
steer = fz.TSK(
    [angle, rate],
    [[-0.5, -0.25, 0.0], [-0.25, 0.0, 0.25], [0.0, 0.25, 0.5]],
    name="steer",
    output="steering",
)
print(steer)
print("one point:", steer(0.4, -0.1))
print("many points:", steer(np.array([[0.4, -0.1], [0.0, 0.0], [-0.4, 0.1]])))
print("parameters:", steer.parameter_names[:2], "...", steer.parameter_names[-1])

# A genetic algorithm fits all 21 parameters to samples of some other controller.
rng = np.random.default_rng(0)
X = rng.uniform(-1, 1, (200, 2))
y = np.clip(0.8 * X[:, 0] + 0.3 * X[:, 1], -0.5, 0.5)
fitted, history = fz.fit_genetic(steer, X, y, generations=300, seed=1)
print(f"mean squared error: {history[0]:.4f} at first, {history[-1]:.4f} after 300 generations")

fitted.save("steer.json")
assert fz.load("steer.json") == fitted
