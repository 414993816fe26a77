"""scikit-fuzzy: Mamdani only; every set is an array over its universe."""

import numpy as np
import skfuzzy
from skfuzzy import control
from works import Contender, Mamdani, Sampling, Tsk

# The area under straight lines between the samples and the points where each term is cut; the
# corners where one cut term meets another are rounded off.
POLYGON = Sampling.exact(tolerance=0.05, remark="the polygon through 101 end points and cuts")


def tsk(work: Tsk) -> list[Contender]:
    del work
    return []


def mamdani(work: Mamdani) -> list[Contender]:
    x = _filled(control.Antecedent(np.linspace(0, 10, 1001), "x"), work.x)
    y = _filled(control.Antecedent(np.linspace(0, 10, 1001), "y"), work.y)
    z = _filled(control.Consequent(np.linspace(0, 100, 101), "z"), work.z)
    rules = [control.Rule(x[f"t{i}"] & y[f"t{j}"], z[f"t{k}"]) for i, j, k in work.rules()]
    system = control.ControlSystem(rules)
    # It remembers the outputs of inputs that it has seen, which would be no evaluation.
    simulation = control.ControlSystemSimulation(system, cache=False)

    def call(x, y):
        simulation.input["x"] = x
        simulation.input["y"] = y
        simulation.compute()
        return simulation.output["z"]

    def calls(points):
        return [call(x, y) for x, y in points]

    def batch(points):
        many = control.ControlSystemSimulation(system)
        many.input["x"] = points[:, 0]
        many.input["y"] = points[:, 1]
        many.compute()
        return many.output["z"]

    return [Contender("scikit-fuzzy", calls, batch, POLYGON)]


def _filled(variable, terms):
    for index, vertices in enumerate(terms):
        variable[f"t{index}"] = skfuzzy.trapmf(variable.universe, vertices)
    return variable
