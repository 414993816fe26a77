"""fuzzytool: NumPy, rules as expressions, the trapezoidal rule."""

import fuzzytool as ft
from works import Contender, Mamdani, Sampling, Trainer, Training, Tsk


def tsk(work: Tsk) -> list[Contender]:
    x = _variable("x", 1, [ft.gauss(*term) for term in work.x])
    y = _variable("y", 1, [ft.gauss(*term) for term in work.y])
    system = ft.TSK(tnorm="prod")
    for i, j, constant in work.rules():
        system.rule(x[f"t{i}"] & y[f"t{j}"], constant)
    return [_contender(system, None)]


def mamdani(work: Mamdani) -> list[Contender]:
    x = _variable("x", 10, [ft.trap(*term) for term in work.x])
    y = _variable("y", 10, [ft.trap(*term) for term in work.y])
    z = _variable("z", 100, [ft.trap(*term) for term in work.z])
    system = ft.Mamdani()
    for i, j, k in work.rules():
        system.rule(x[f"t{i}"] & y[f"t{j}"], z[f"t{k}"])
    return [_contender(system, Sampling.trapezoids())]


def anfis(work: Training) -> list[Trainer]:
    # It spreads its Gaussians over the data's range itself.
    def train(epochs):
        model = ft.ANFIS(2, n_mf=len(work.means), learning_rate=work.rate, ridge=work.ridge)
        return model.fit(work.points, work.targets, epochs=epochs).predict(work.points)

    return [Trainer("fuzzytool", train)]


def _variable(name, high, functions):
    terms = {f"t{index}": function for index, function in enumerate(functions)}
    return ft.Variable(name, (0, high), terms, resolution=101)


def _contender(system, sampling):
    def calls(points):
        return [system(x=x, y=y) for x, y in points]

    def batch(points):
        return system.predict(x=points[:, 0], y=points[:, 1])

    return Contender("fuzzytool", calls, batch, sampling)
