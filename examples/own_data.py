"""Fit a fuzzy system to data of your own by ANFIS, judge it on samples it has not seen, look inside.

Here: how far a ball flies, from its speed and angle, with noise as a measurement has it.
"""

import numpy as np

import fuzzyrs as fz

random = np.random.default_rng(1)
speed, angle = random.uniform(5, 30, 600), random.uniform(0.1, 1.4, 600)
X = np.column_stack([speed, angle])
y = speed**2 * np.sin(2 * angle) / 9.81 + random.normal(0, 0.5, 600)
training, validation, test = np.split(np.arange(600), [400, 500])

inputs = [
    fz.Variable.evenly("speed", (5, 30), ["slow", "medium", "fast"]),
    fz.Variable.evenly("angle", (0.1, 1.4), ["flat", "middle", "steep"]),
]
start = fz.TSK(inputs, np.zeros((3, 3, 3)), order=1, output="distance")

fit = fz.fit_anfis(
    start,
    X[training],
    y[training],
    validation=(X[validation], y[validation]),
    rate=0.1,
    epochs=200,
    patience=20,
)
print(fit)

error = np.sqrt(np.mean((fit.system(X[test]) - y[test]) ** 2))
print(f"error on samples that were not seen: {error:.2f} m, the noise alone: 0.50 m")
for variable in fit.system.inputs:
    print(variable.name, {name: str(term) for name, term in variable.terms.items()})
