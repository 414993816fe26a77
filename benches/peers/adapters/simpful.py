"""simpful: rules as text, evaluated one point at a time."""

import contextlib
import io

import simpful
from works import Contender, Mamdani, Sampling, Tsk


def tsk(work: Tsk) -> list[Contender]:
    system = simpful.FuzzySystem(operators=["AND_PRODUCT"], show_banner=False, verbose=False)
    for name, terms in (("x", work.x), ("y", work.y)):
        sets = [simpful.GaussianFuzzySet(*term, f"t{i}") for i, term in enumerate(terms)]
        system.add_linguistic_variable(name, simpful.LinguisticVariable(sets))
    with contextlib.redirect_stdout(io.StringIO()):
        for i, j, constant in work.rules():
            system.set_crisp_output_value(f"c{i}{j}", constant)
            system.add_rules([f"IF (x IS t{i}) AND (y IS t{j}) THEN (z IS c{i}{j})"])

    def calls(points):
        return [float(_inputs(system, x, y).Sugeno_inference(["z"])["z"]) for x, y in points]

    return [Contender("simpful", calls, None)]


def mamdani(work: Mamdani) -> list[Contender]:
    system = simpful.FuzzySystem(show_banner=False, verbose=False)
    for name, high, terms in (("x", 10, work.x), ("y", 10, work.y), ("z", 100, work.z)):
        sets = [simpful.TrapezoidFuzzySet(*term, f"t{i}") for i, term in enumerate(terms)]
        universe = [0, high]
        system.add_linguistic_variable(
            name, simpful.LinguisticVariable(sets, universe_of_discourse=universe)
        )
    rules = [f"IF (x IS t{i}) AND (y IS t{j}) THEN (z IS t{k})" for i, j, k in work.rules()]
    with contextlib.redirect_stdout(io.StringIO()):
        system.add_rules(rules)

    def call(x, y):
        return _inputs(system, x, y).Mamdani_inference(["z"], subdivisions=101)["z"]

    def calls(points):
        return [call(x, y) for x, y in points]

    return [Contender("simpful", calls, None, Sampling.endpoints())]


def _inputs(system, x, y):
    system.set_variable("x", x)
    system.set_variable("y", y)
    return system
