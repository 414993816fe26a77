"""Rule systems: their outputs against the definitions, and numbers that can be checked by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fuzzyrs as fz
import rule_models as models


@settings(max_examples=200)
@given(models.systems(), st.data())
def test_outputs_follow_the_definitions(model, data):
    points = data.draw(models.points(model))
    before = data.draw(st.sampled_from([[math.nan] * 3, [0.5, -1.0, 0.25]]))[: len(model.outputs)]
    right = models.expected(model, points, before)
    system = models.build(model)
    if isinstance(right, type):
        with pytest.raises(right):
            system(points, previous=before)
        return
    outputs = system(points, previous=before)
    np.testing.assert_allclose(outputs.reshape(right.shape), right, rtol=1e-9, atol=1e-9)


# By hand. The terms of x, y and z are as true as the input is large: a term's degree is the input.

UNIT = [fz.Variable(name, (0, 1), {"on": fz.MembershipFunction("ramp", [0, 1])}) for name in "xyz"]


def strength(condition, x=0.5, y=0.5, z=0.5, **options):
    """Give the firing strength of "if condition ...", by summing ones that are weighted with it."""
    output = fz.Output.sugeno("u", {"one": 1}, defuzzifier="weighted_sum", no_rule_fires=0.0)
    return fz.System(UNIT, output, f"if {condition} then u is one", **options)(x, y, z)


PRODUCT = {"conjunction": "product", "disjunction": "probabilistic_sum"}


@pytest.mark.parametrize(
    ("condition", "degree"),
    [
        ("(x is on or y is on) and z is on", 0.375),
        ("x is on or y is on and z is on", 0.625),
        ("x is on and (y is on or z is on)", 0.375),
        ("x is on and y is on or z is on", 0.625),
        ("x is on and y is on and z is on", 0.125),
        ("not (x is on and y is on)", 0.75),
        ("not x is on and y is on", 0.25),
        ("not x is on and not y is on or z is on", 0.625),
        ("not not x is on and y is on", 0.25),
        ("very (x is on or y is on)", 0.5625),
        ("very x is on or y is on", 0.625),
        ("x is very on or y is on", 0.625),
        ("x is not very on", 0.75),
        ("x is very not on", 0.25),
        ("very not (x is on and very (y is on or z is on))", 0.71875**2),
    ],
)
def test_parentheses_and_precedence(condition, degree):
    assert strength(condition, **PRODUCT) == degree


def test_the_last_hedge_acts_first():
    assert strength("x is very not on", x=0.25) == 0.5625
    assert strength("x is not very on", x=0.25) == 0.9375
    assert strength("very not x is on", x=0.25) == 0.5625
    assert strength("not very (x is on)", x=0.25) == 0.9375


# Of 0.6 and 0.7.
@pytest.mark.parametrize(
    ("name", "conjunction", "disjunction"),
    [
        ("min", 0.6, None),
        ("max", None, 0.7),
        ("product", 0.42, None),
        ("probabilistic_sum", None, 0.88),
        ("lukasiewicz", 0.3, 1.0),
        ("drastic", 0.0, 1.0),
        ("einstein", 0.42 / 1.12, 1.3 / 1.42),
        ("hamacher", 0.42 / 0.88, 0.46 / 0.58),
        ("nilpotent", 0.6, 1.0),
    ],
)
def test_norms(name, conjunction, disjunction):
    if conjunction is not None:
        came = strength("x is on and y is on", x=0.6, y=0.7, conjunction=name)
        assert came == pytest.approx(conjunction, rel=1e-15, abs=1e-15)
    if disjunction is not None:
        came = strength("x is on or y is on", x=0.6, y=0.7, disjunction=name)
        assert came == pytest.approx(disjunction, rel=1e-15)


# Of 1/16 and 3/4.
@pytest.mark.parametrize(
    ("hedge", "low", "high"),
    [
        ("not", 15 / 16, 1 / 4),
        ("very", 1 / 256, 9 / 16),
        ("extremely", 1 / 4096, 27 / 64),
        ("plus", 1 / 32, 0.75**1.25),
        ("minus", 1 / 8, 0.75**0.75),
        ("slightly", 2**-6.8, 0.75**1.7),
        ("somewhat", 1 / 4, math.sqrt(3) / 2),
        ("more_or_less", 1 / 4, math.sqrt(3) / 2),
        ("indeed", 1 / 128, 7 / 8),
        ("seldom", math.sqrt(1 / 32), 1 - math.sqrt(1 / 8)),
        ("any", 1.0, 1.0),
    ],
)
def test_hedges(hedge, low, high):
    assert strength(f"x is {hedge} on", x=1 / 16) == pytest.approx(low, rel=1e-15)
    assert strength(f"{hedge} (x is on)", x=0.75) == pytest.approx(high, rel=1e-15)
    for crisp in (0.0, 1.0):
        right = {"not": 1 - crisp, "any": 1.0}.get(hedge, crisp)
        assert strength(f"x is {hedge} on", x=crisp) == right


def test_hedges_of_ones_own():
    assert strength("x is rather on", x=0.25, hedges={"rather": "x^1.5"}) == 0.125
    assert strength("x is very on", x=0.25, hedges={"very": "x^1.5"}) == 0.125
    assert strength("x is very on", x=0.25) == 0.0625


# Sets: at 0, 1, 2, 3, 4 the term has the degrees 0, 1, 3/4, 1/2, 1/4.
SLOPE = fz.Variable("u", (0, 4), {"slope": fz.triangular(0, 1, 5)})


def mamdani(x, variable=SLOPE, then="u is slope", **options):
    output = fz.Output.mamdani(variable, **{"samples": 5, **options})
    return fz.System(UNIT[:1], output, f"if x is on then {then}")(x)


@pytest.mark.parametrize(
    ("defuzzifier", "whole", "half"),
    [
        ("centroid", 5 / 2.5, 4 / 1.75),
        ("bisector", 2, 2),
        ("mean_of_maximum", 1, 2),
        ("smallest_of_maximum", 1, 1),
        ("largest_of_maximum", 1, 3),
        ("height", 1, 1),
    ],
)
def test_defuzzifiers_of_whole_and_clipped_sets(defuzzifier, whole, half):
    assert mamdani(1, defuzzifier=defuzzifier) == pytest.approx(whole, rel=1e-15)
    assert mamdani(0.5, defuzzifier=defuzzifier) == pytest.approx(half, rel=1e-15)
    # What is scaled keeps its shape.
    assert mamdani(0.5, defuzzifier=defuzzifier, implication="product") == pytest.approx(whole)


def test_midpoints_are_the_middles_of_equal_parts():
    # Degrees 1/2, 7/8, 5/8, 3/8 at 1/2, 3/2, 5/2, 7/2.
    right = (0.25 + 1.3125 + 1.5625 + 1.3125) / 2.375
    assert mamdani(1, sampling="midpoints", samples=4) == pytest.approx(right, rel=1e-15)


def test_exact_centroids():
    triangle = fz.Variable("u", (-1, 6), {"slope": fz.triangular(0, 1, 5)})
    assert mamdani(1, triangle, sampling="exact") == pytest.approx(2, rel=1e-14)
    assert mamdani(0.5, triangle, sampling="exact", implication="product") == pytest.approx(2)
    # Clipped: a trapezoid with the corners 0, 1/2, 3, 5.
    assert mamdani(0.5, triangle, sampling="exact") == pytest.approx(48.75 / 22.5, rel=1e-14)
    # The universe cuts the triangle off at 1: what is left rises from 0 to 1.
    cut = fz.Variable("u", (-1, 1), {"slope": fz.triangular(0, 1, 5)})
    assert mamdani(1, cut, sampling="exact") == pytest.approx(2 / 3, rel=1e-14)
    # Samples come near.
    near = mamdani(0.5, triangle, samples=70_001)
    assert near == pytest.approx(48.75 / 22.5, rel=1e-8)


@pytest.mark.xfail(reason="the place of the clip is rounded to the corner")
@pytest.mark.parametrize("x", [1e-12, 1e-15, 1e-18, 1e-30, 1e-150])
def test_the_exact_centroid_of_a_weak_rule(x):
    """Clipped this low the trapezoid is a rectangle from 0 to 4."""
    variable = fz.Variable("u", (-1, 5), {"slope": fz.trapezoidal(0, 0.5, 1.5, 4)})
    assert mamdani(x, variable, sampling="exact") == pytest.approx(2, rel=1e-11)


def test_hedges_of_conclusions_change_the_set():
    # Squared degrees: 1, 9/16, 1/4, 1/16.
    right = (1 + 2 * 9 / 16 + 3 / 4 + 4 / 16) / (1 + 9 / 16 + 1 / 4 + 1 / 16)
    assert mamdani(1, then="u is very slope") == pytest.approx(right, rel=1e-15)
    # 1, 0, 1/4, 1/2, 3/4.
    assert mamdani(1, then="u is not slope") == pytest.approx(5 / 2.5, rel=1e-15)
    assert mamdani(1, then="u is not very slope") != mamdani(1, then="u is very not slope")


@pytest.mark.parametrize(
    ("aggregation", "right"),
    [
        ("max", (0 * 0.5 + 1 * 0.5 + 2 * 0.25) / 1.25),
        ("sum", (0 * 0.5 + 1 * 0.75 + 2 * 0.25) / 1.5),
        ("probabilistic_sum", (0 * 0.5 + 1 * 0.625 + 2 * 0.25) / 1.375),
        ("drastic", (0 * 0.5 + 1 * 1.0 + 2 * 0.25) / 1.75),
    ],
)
def test_aggregations(aggregation, right):
    """Two rules say 1/2, 1/2, 0 and 0, 1/4, 1/4."""
    terms = {"left": fz.trapezoidal(0, 0, 1, 2), "right": fz.trapezoidal(0, 1, 2, 2)}
    output = fz.Output.mamdani(fz.Variable("u", (0, 2), terms), aggregation=aggregation, samples=3)
    rules = "if x is on then u is left\nif y is on then u is right"
    system = fz.System(UNIT[:2], output, rules)
    assert system(0.5, 0.25) == pytest.approx(right, rel=1e-15)


def test_each_rule_counts_in_a_sum_and_only_the_strongest_in_a_maximum():
    terms = {"low": fz.triangular(-1, 0, 1), "high": fz.triangular(0, 1, 2)}
    variable = fz.Variable("u", (0, 1), terms)
    rules = "if x is on then u is low\nif x is on then u is low\nif x is on then u is high"
    outputs = {
        name: fz.System(
            UNIT[:1],
            fz.Output.mamdani(variable, aggregation=name, implication="product", samples=2),
            rules,
        )(0.5)
        for name in ("max", "sum")
    }
    assert outputs == {"max": 0.5, "sum": pytest.approx(1 / 3, rel=1e-15)}


def test_height_weighs_the_centres_of_the_terms_by_the_strengths():
    terms = {
        "bump": fz.gaussian(1, 0.3),
        "plain": fz.trapezoidal(1, 2, 4, 8),
        "beyond": fz.triangular(5, 6, 7),
        "half": fz.trapezoidal(3, 4, 7, 8),
    }
    output = fz.Output.mamdani(fz.Variable("u", (0, 5), terms), defuzzifier="height")
    centres = {"bump": 1, "plain": 3, "beyond": 5, "half": 4.5}
    for name, place in centres.items():
        assert fz.System(UNIT[:1], output, f"if x is on then u is {name}")(0.3) == place
    both = "if x is on then u is bump\nif y is on then u is half with 0.5"
    right = (0.25 * 1 + 0.5 * 0.75 * 4.5) / (0.25 + 0.5 * 0.75)
    assert fz.System(UNIT[:2], output, both)(0.25, 0.75) == pytest.approx(right, rel=1e-15)


def sugeno(rules, *x, terms=None, **options):
    inputs = UNIT[: len(x)]
    output = fz.Output.sugeno("u", terms or {"ten": 10, "linear": [2, 3, -1]}, **options)
    return fz.System(inputs, output, rules)(*x)


def test_a_weight_cancels_in_an_average_of_one_rule():
    assert sugeno("if x is on then u is ten with 0.5", 0.3, 0) == 10
    assert sugeno("if x is on then u is ten with 0.5", 0.4, 0, defuzzifier="weighted_sum") == 2


def test_conclusions_of_sugeno():
    rules = "if x is on then u is ten\nif y is on then u is linear"
    linear = 2 * 0.25 + 3 * 0.5 - 1
    assert sugeno(rules, 0.25, 0.5) == pytest.approx((0.25 * 10 + 0.5 * linear) / 0.75, rel=1e-15)
    assert sugeno(rules, 0.25, 0.5, defuzzifier="weighted_sum") == 0.25 * 10 + 0.5 * linear
    formula = "if x is on then u = x^2 - y\nif y is on then u = 4 with 0.5"
    right = (0.25 * (0.0625 - 0.5) + 0.25 * 4) / 0.5
    assert sugeno(formula, 0.25, 0.5) == pytest.approx(right, rel=1e-15)
    terms = {"f": "x^2 - y", "four": "2*2"}
    assert sugeno("if x is on then u is f", 0.25, 0.5, terms=terms) == 0.0625 - 0.5


def test_sugeno_joins_the_strengths_of_a_term():
    rules = "if x is on then u is ten\nif y is on then u is ten\nif x is on then u is zero"
    terms = {"ten": 10, "zero": 0}
    for aggregation, ten in {"sum": 1.25, "max": 0.75, "probabilistic_sum": 0.875}.items():
        came = sugeno(rules, 0.5, 0.75, terms=terms, aggregation=aggregation)
        assert came == pytest.approx(10 * ten / (ten + 0.5), rel=1e-15)


def test_a_rule_that_does_not_fire_concludes_nothing_be_it_infinite():
    rules = "if x is on then u = 1/x\nif y is on then u is ten"
    assert sugeno(rules, 0.0, 0.5, terms={"ten": 10}) == 10


def test_tsukamoto_looks_up_the_strengths():
    terms = {
        "up": fz.MembershipFunction("ramp", [0, 8]),
        "down": fz.MembershipFunction("ramp", [8, 0]),
        "soft": fz.MembershipFunction("sigmoid", [5, 2]),
    }
    variable = fz.Variable("u", (0, 8), terms)
    system = fz.System(
        UNIT[:2],
        fz.Output.tsukamoto(variable),
        "if x is on then u is up\nif y is on then u is down with 0.5",
    )
    assert system(0.25, 0.5) == (0.25 * 2 + 0.25 * 6) / 0.5
    total = fz.Output.tsukamoto(variable, defuzzifier="weighted_sum")
    assert fz.System(UNIT[:1], total, "if x is on then u is up")(0.25) == 0.5
    soft = fz.System(UNIT[:1], total, "if x is on then u is soft")
    assert soft(0.75) == pytest.approx(0.75 * (5 + math.log(3) / 2), rel=1e-15)


def test_a_rule_may_conclude_about_several_outputs():
    power = fz.Output.sugeno("power", {"full": 9}, no_rule_fires=-1)
    valve = fz.Variable("valve", (0, 1), {"open": fz.triangular(0, 1, 2)})
    system = fz.System(
        UNIT[:2],
        [power, valve],
        "if x is on then power is full and valve is open\nif y is on then valve is open",
    )
    assert system(0.5, 0).tolist() == [9, pytest.approx(mean_of_clipped(0.5), rel=1e-14)]
    assert system(0.0, 0.5).tolist() == [-1, pytest.approx(mean_of_clipped(0.5), rel=1e-14)]


def mean_of_clipped(strength):
    y = np.linspace(0, 1, 101)
    return np.average(y, weights=np.minimum(y, strength))
