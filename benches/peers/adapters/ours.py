"""fuzzyrs: the grid of TSK, and the same as a general system with rules as text."""

import numpy as np
from works import Breeder, Contender, Mamdani, Sampling, Search, Trainer, Training, Tsk

import fuzzyrs as fz


def tsk(work: Tsk) -> list[Contender]:
    x = _variable("x", 1, [fz.gaussian(*term) for term in work.x])
    y = _variable("y", 1, [fz.gaussian(*term) for term in work.y])
    grid = fz.TSK([x, y], work.constants)
    constants = {f"c{i}{j}": constant for i, j, constant in work.rules()}
    rules = [f"if x is t{i} and y is t{j} then z is c{i}{j}" for i, j, _ in work.rules()]
    output = fz.Output.sugeno("z", constants)
    system = fz.System([x, y], output, rules, conjunction="product")
    return [_contender("fuzzyrs TSK", grid, None), _contender("fuzzyrs System", system, None)]


def mamdani(work: Mamdani) -> list[Contender]:
    x = _variable("x", 10, [fz.trapezoidal(*term) for term in work.x])
    y = _variable("y", 10, [fz.trapezoidal(*term) for term in work.y])
    z = _variable("z", 100, [fz.trapezoidal(*term) for term in work.z])
    rules = [f"if x is t{i} and y is t{j} then z is t{k}" for i, j, k in work.rules()]
    sampled = fz.System([x, y], fz.Output.mamdani(z, sampling="endpoints", samples=101), rules)
    exact = fz.System([x, y], fz.Output.mamdani(z, sampling="exact"), rules)
    return [
        _contender("fuzzyrs System", sampled, Sampling.endpoints()),
        _contender("fuzzyrs System, exact", exact, Sampling.exact()),
    ]


def anfis(work: Training) -> list[Trainer]:
    terms = [fz.gaussian(mean, work.sigma) for mean in work.means]
    inputs = [_variable(name, 1, terms) for name in "xy"]
    start = fz.TSK(inputs, np.zeros((5, 5, 3)), order=1)

    def train(epochs):
        options = {"ridge": work.ridge, "premise": "batch", "rate": work.rate, "epochs": epochs}
        return fz.fit_anfis(start, work.points, work.targets, **options).system(work.points)

    return [Trainer("fuzzyrs", train)]


def search(work: Search) -> Breeder:
    terms = {f"t{index}": fz.gaussian(0, work.sigma) for index in range(work.means)}
    inputs = [fz.Variable(name, (-1, 1), terms) for name in "xy"]
    system = fz.TSK(inputs, np.zeros((work.means, work.means)))
    # The widths are genes too, but held: the others have 35, these 45.
    is_width = np.array([name.endswith("sigma") for name in system.parameter_names])
    bounds = np.tile([-1.0, 1.0], (len(is_width), 1))
    bounds[is_width] = work.sigma

    def run(generations):
        options = {"bounds": bounds, "population": work.population, "generations": generations}
        fitted, history = fz.fit_genetic(system, work.points, work.targets, **options)
        return fitted.parameters[~is_width], history[-1]

    return Breeder("fuzzyrs", run)


def _variable(name, high, functions):
    return fz.Variable(name, (0, high), {f"t{i}": f for i, f in enumerate(functions)})


def _contender(name, system, sampling):
    # A batch goes into an array that is kept; the others offer no such thing and make a new one.
    outputs = np.empty(0)

    def calls(points):
        return [system(x, y) for x, y in points]

    def batch(points):
        nonlocal outputs
        if len(outputs) != len(points):
            outputs = np.empty(len(points))
        return system(points, out=outputs)

    return Contender(name, calls, batch, sampling)
