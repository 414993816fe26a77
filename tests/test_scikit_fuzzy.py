"""scikit-fuzzy beside fuzzyrs, where both mean the same.

What differs, and is not compared: its sets are arrays over a universe, read by straight lines
between their samples, and the centroid and bisector are those of the polygon through the samples,
where fuzzyrs either weighs the samples (as MATLAB) or takes the exact set.
"""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import skfuzzy
from skfuzzy import control

import fuzzyrs as fz

# NumPy 2.5 says so of scikit-fuzzy 0.5.0.
pytestmark = pytest.mark.filterwarnings(
    "ignore:Passing more than 2 positional arguments:DeprecationWarning"
)

X = np.linspace(-1, 11, 1201)


def pairs(a, b, c, d):
    """Their degrees at X, and our function, for vertices a < b < c < d."""
    return {
        "gaussmf": (skfuzzy.gaussmf(X, b, c - a), fz.gaussian(b, c - a)),
        "gauss2mf": (
            skfuzzy.gauss2mf(X, b, b - a, c, d - c),
            fz.two_sided_gaussian(b, b - a, c, d - c),
        ),
        "gbellmf": (skfuzzy.gbellmf(X, b - a, d, c), fz.bell(c, b - a, d)),
        "sigmf, rising": (skfuzzy.sigmf(X, b, c), fz.sigmoid(b, c)),
        "sigmf, falling": (skfuzzy.sigmf(X, b, -c), fz.sigmoid(b, -c)),
        # Where theirs is negative ours is the absolute difference, as MATLAB's.
        "dsigmf": (np.abs(skfuzzy.dsigmf(X, b, a, c, d)), fz.sigmoid_difference(b, a, c, d)),
        "psigmf": (skfuzzy.psigmf(X, b, a, c, -d), fz.sigmoid_product(b, a, c, -d)),
        "smf": (skfuzzy.smf(X, b, c), fz.s_shape(b, c)),
        "zmf": (skfuzzy.zmf(X, b, c), fz.z_shape(b, c)),
        "pimf": (skfuzzy.pimf(X, a, b, c, d), fz.pi_shape(a, b, c, d)),
        "trimf": (skfuzzy.trimf(X, [a, b, d]), fz.triangular(a, b, d)),
        "trapmf": (skfuzzy.trapmf(X, [a, b, c, d]), fz.trapezoidal(a, b, c, d)),
        "trapmf, vertical": (skfuzzy.trapmf(X, [0, 0, c, 10]), fz.trapezoidal(0, 0, c, 10)),
        "piecemf": (skfuzzy.piecemf(X, [a, b, c]), fz.points([(a, 0), (b, b / c), (c, 1)])),
    }


@pytest.mark.parametrize("name", pairs(1, 2, 3, 4))
def test_membership_functions_are_the_same(name):
    rng = np.random.default_rng(4)
    for _ in range(20):
        theirs, ours = pairs(*np.sort(rng.uniform(0.2, 9.8, 4)).tolist())[name]
        np.testing.assert_allclose(ours(X), theirs, rtol=1e-9, atol=1e-12)


Z = {
    "left": fz.trapezoidal(0, 0, 1, 4),
    "middle": fz.gaussian(5, 1.2),
    "right": fz.triangular(4, 9, 10),
}
METHODS = {
    "mom": "mean_of_maximum",
    "som": "smallest_of_maximum",
    "lom": "largest_of_maximum",
    "centroid": "centroid",
    "bisector": "bisector",
}
STRENGTHS = [strengths for strengths in itertools.product([0, 0.37, 1], repeat=3) if any(strengths)]


def defuzzified(method, samples):
    """Cut the terms of z at the strengths, in fuzzyrs and by hand for scikit-fuzzy."""
    inputs = [fz.Variable(name, (0, 1), {"full": fz.ramp(0, 1)}) for name in "abc"]
    output = fz.Output.mamdani(
        fz.Variable("z", (0, 10), Z), defuzzifier=METHODS[method], samples=samples
    )
    rules = [f"if {x} is full then z is {term}" for x, term in zip("abc", Z, strict=True)]
    ours = fz.System(inputs, output, rules)(np.array(STRENGTHS, dtype=float))
    positions = np.linspace(0, 10, samples)
    terms = np.array([degree(positions) for degree in Z.values()])
    unions = [np.minimum(np.array(s)[:, None], terms).max(axis=0) for s in STRENGTHS]
    return ours, [skfuzzy.defuzz(positions, union, method) for union in unions]


@pytest.mark.parametrize("method", ["mom", "som", "lom"])
def test_maxima_are_the_same(method):
    ours, theirs = defuzzified(method, samples=101)
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-12)


@pytest.mark.parametrize(("method", "steps"), [("centroid", 1), ("bisector", 2)])
def test_areas_are_the_same_to_the_distance_of_samples(method, steps):
    for samples in (101, 2001):
        ours, theirs = defuzzified(method, samples)
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=steps * 10 / (samples - 1))


TIPS = {"low": (0, 0, 13), "medium": (0, 13, 25), "high": (13, 25, 25)}
MARKS = {"poor": (0, 0, 5), "average": (0, 5, 10), "good": (5, 10, 10)}


def their_tipper(step):
    """The example of its documentation, on universes as fine as the step."""
    quality = control.Antecedent(np.arange(0, 10 + step / 2, step), "quality")
    service = control.Antecedent(np.arange(0, 10 + step / 2, step), "service")
    tip = control.Consequent(np.arange(0, 25 + step / 2, step), "tip")
    for variable, terms in ((quality, MARKS), (service, MARKS), (tip, TIPS)):
        for name, vertices in terms.items():
            variable[name] = skfuzzy.trimf(variable.universe, vertices)
    rules = [
        control.Rule(quality["poor"] | service["poor"], tip["low"]),
        control.Rule(service["average"], tip["medium"]),
        control.Rule(service["good"] | quality["good"], tip["high"]),
    ]
    simulation = control.ControlSystemSimulation(control.ControlSystem(rules))

    def call(x, y):
        simulation.input["quality"] = x
        simulation.input["service"] = y
        simulation.compute()
        return simulation.output["tip"]

    return call


def our_tipper():
    marks = {name: fz.triangular(*vertices) for name, vertices in MARKS.items()}
    tips = {name: fz.triangular(*vertices) for name, vertices in TIPS.items()}
    tip = fz.Output.mamdani(fz.Variable("tip", (0, 25), tips), sampling="exact")
    rules = """
        if quality is poor or service is poor then tip is low
        if service is average then tip is medium
        if service is good or quality is good then tip is high
    """
    inputs = [fz.Variable(name, (0, 10), marks) for name in ("quality", "service")]
    return fz.System(inputs, tip, rules)


def test_the_tip_is_the_one_of_its_documentation():
    assert their_tipper(1)(6.5, 9.8) == pytest.approx(19.847607361963192, abs=1e-12)
    # On a universe of 26 samples the corners where two terms meet are cut off.
    assert our_tipper()(6.5, 9.8) == pytest.approx(19.8476, abs=0.05)


def test_tips_are_the_same_on_a_fine_universe():
    theirs, ours = their_tipper(0.01), our_tipper()
    for x, y in np.random.default_rng(2).uniform(0, 10, (30, 2)).tolist():
        assert ours(x, y) == pytest.approx(theirs(x, y), abs=1e-4)
