"""ferrifuzz: Rust, rules as text, columns in dictionaries."""

import ferrifuzz as ff
from works import Contender, Mamdani, Sampling, Tsk


def tsk(work: Tsk) -> list[Contender]:
    system = ff.FuzzySystem(and_method="product", defuzz_method="weighted_average")
    for name, terms in (("x", work.x), ("y", work.y)):
        variable = ff.Variable(name, 0, 1)
        for index, (mean, sigma) in enumerate(terms):
            variable[f"t{index}"] = ff.mf.gaussian(mean, sigma)
        system.add_input(variable)
    output = ff.Variable("z", -1, 1)
    for i, j, constant in work.rules():
        output[f"c{i}{j}"] = ff.mf.singleton(constant)
        system.add_rule(f"IF x IS t{i} AND y IS t{j} THEN z IS c{i}{j}")
    system.add_output(output)
    return [_contender(system, None)]


def mamdani(work: Mamdani) -> list[Contender]:
    system = ff.FuzzySystem(resolution=100)
    system.add_input(_variable("x", 10, work.x))
    system.add_input(_variable("y", 10, work.y))
    system.add_output(_variable("z", 100, work.z))
    for i, j, k in work.rules():
        system.add_rule(f"IF x IS t{i} AND y IS t{j} THEN z IS t{k}")
    return [_contender(system, Sampling.endpoints())]


def _variable(name, high, terms):
    variable = ff.Variable(name, 0, high)
    for index, vertices in enumerate(terms):
        variable[f"t{index}"] = ff.mf.trapezoid(*vertices)
    return variable


def _contender(system, sampling):
    def calls(points):
        return [system.evaluate([x, y])[0] for x, y in points]

    def batch(points):
        return system.compute_batch({"x": points[:, 0], "y": points[:, 1]})["z"]

    return Contender("ferrifuzz", calls, batch, sampling)
