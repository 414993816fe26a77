"""Insight: explanations against what they explain, firing strengths, findings."""

from __future__ import annotations

import numpy as np
import pytest

import fuzzyrs as fz

SERVICE = fz.Variable(
    "service",
    (0, 10),
    {"poor": fz.gaussian(0, 1.5), "good": fz.gaussian(5, 1.5), "excellent": fz.gaussian(10, 1.5)},
)
FOOD = fz.Variable(
    "food",
    (0, 10),
    {"rancid": fz.trapezoidal(0, 0, 1, 3), "delicious": fz.trapezoidal(7, 9, 10, 10)},
)
TIP = fz.Variable(
    "tip",
    (0, 30),
    {
        "cheap": fz.triangular(0, 5, 12),
        "average": fz.triangular(8, 15, 22),
        "generous": fz.triangular(18, 25, 30),
    },
)
RULES = """
    if service is poor or food is rancid then tip is cheap
    if service is good then tip is average with 0.75
    if service is excellent or food is delicious then tip is generous
"""
POINT = {"service": 3.0, "food": 2.5}
POOR, GOOD, EXCELLENT = (float(SERVICE.terms[name](3.0)) for name in SERVICE)
STRENGTHS = [max(POOR, 0.25), 0.75 * GOOD, EXCELLENT]


def tipper(output=TIP, **options):
    return fz.System([SERVICE, FOOD], output, RULES, name="tipper", **options)


def implied(implication):
    y = np.linspace(0, 30, 101)
    terms = TIP.degrees(y).T
    join = {"min": np.minimum, "product": np.multiply}[implication]
    return y, np.array([join(w, term) for w, term in zip(STRENGTHS, terms, strict=True)])


@pytest.mark.parametrize("implication", ["min", "product"])
@pytest.mark.parametrize("aggregation", ["max", "sum", "probabilistic_sum"])
def test_the_area_of_a_set_is_divided_among_the_rules(implication, aggregation):
    system = tipper(fz.Output.mamdani(TIP, implication=implication, aggregation=aggregation))
    y, sets = implied(implication)
    if aggregation == "max":
        whole = sets.max(axis=0)
        claims = (sets == whole) & (whole > 0)
    else:
        whole = sets.sum(axis=0) if aggregation == "sum" else 1 - np.prod(1 - sets, axis=0)
        claims = sets
    with np.errstate(invalid="ignore"):
        mass = np.nan_to_num(whole * claims / claims.sum(axis=0))
    explanation = system.explain(**POINT)
    np.testing.assert_allclose(explanation.shares["tip"], mass.sum(axis=1) / whole.sum())
    np.testing.assert_allclose(explanation.contributions["tip"], mass @ y / whole.sum())
    np.testing.assert_allclose(explanation.sets["tip"], [y, whole], atol=1e-15)
    assert explanation.outputs["tip"] == system(**POINT)
    assert explanation.contributions["tip"].sum() == pytest.approx(system(**POINT), rel=1e-13)


def test_an_explanation_tells_what_happens():
    explanation = tipper().explain(**POINT)
    assert explanation.system == "tipper"
    assert explanation.inputs == POINT
    assert explanation.degrees["service"] == {"poor": POOR, "good": GOOD, "excellent": EXCELLENT}
    assert explanation.degrees["food"] == {"rancid": 0.25, "delicious": 0.0}
    assert explanation.rules[1] == "if service is good then tip is average with 0.75"
    assert explanation.conclusions[1] == {"tip": "tip is average"}
    np.testing.assert_array_equal(explanation.strengths, STRENGTHS)
    assert explanation.fires == {"tip": True}
    assert np.isnan(explanation.concluded["tip"]).all()
    assert explanation.strongest(2) == [0, 1]


def test_a_point_is_given_as_in_a_call():
    system = tipper()
    expected = str(system.explain(3, 2.5))
    for given in [
        system.explain(food=2.5, service=3),
        system.explain(3, food=2.5),
        system.explain([3, 2.5]),
        system.explain(np.array([[3, 2.5]])),
    ]:
        assert str(given) == expected
    for arguments, named, error, message in [
        ((), {"service": 3}, TypeError, 'input "food" is missing'),
        ((), {"service": 3, "fod": 2}, fz.errors.UnknownNameError, 'did you mean "food"'),
        ((3, 2.5), {"service": 3}, TypeError, "both by its place and by its name"),
        (([[1, 2], [3, 4]],), {}, fz.errors.ShapeError, "expected a single one, got 2"),
        ((float("nan"), 1), {}, fz.errors.InvalidValueError, "must be finite"),
    ]:
        with pytest.raises(error, match=message):
            system.explain(*arguments, **named)


def test_formulas_and_several_outputs_are_explained():
    rules = [
        "if service is good then tip = service + food/2 and smile is yes",
        "if service is not good then tip = 2 and smile is no with 0.5",
    ]
    smile = fz.Output.sugeno("smile", {"yes": 1, "no": 0}, defuzzifier="weighted_sum")
    system = fz.System([SERVICE, FOOD], [fz.Output.sugeno("tip"), smile], rules)
    explanation = system.explain(**POINT)
    w = np.array([GOOD, 0.5 * (1 - GOOD)])
    assert explanation.rules[0] == (
        "if service is good then tip = service + 0.5*food and smile is yes"
    )
    assert explanation.conclusions[1] == {"tip": "tip = 2", "smile": "smile is no"}
    assert explanation.concluded["tip"].tolist() == [4.25, 2.0]
    np.testing.assert_allclose(explanation.shares["tip"], w / w.sum())
    np.testing.assert_allclose(explanation.contributions["tip"], w * [4.25, 2] / w.sum())
    np.testing.assert_allclose(explanation.shares["smile"], w / w.sum())
    np.testing.assert_allclose(explanation.contributions["smile"], [w[0], 0])
    assert list(explanation.outputs.values()) == system(**POINT).tolist()
    assert explanation.sets == {}


def test_a_grid_is_explained(steer):
    explanation = steer.explain(angle=0.3, rate=-0.2)
    assert explanation.rules[1] == "if angle is N and rate is Z then steering = -0.25"
    degrees = [list(terms.values()) for terms in explanation.degrees.values()]
    strengths = np.outer(*degrees).ravel()
    np.testing.assert_allclose(explanation.strengths, strengths, rtol=1e-15)
    np.testing.assert_array_equal(explanation.concluded["steering"], steer.consequents.ravel())
    np.testing.assert_allclose(explanation.shares["steering"], strengths / strengths.sum())
    assert explanation.outputs == {"steering": steer(0.3, -0.2)}
    total = explanation.contributions["steering"].sum()
    assert total == pytest.approx(steer(0.3, -0.2), abs=1e-15)


def test_where_no_rule_fires_nothing_is_raised(gap):
    explanation = gap.explain(5)
    assert explanation.fires == {"output": False}
    assert np.isnan(explanation.outputs["output"])
    assert explanation.shares["output"].tolist() == [0.0]
    assert "no rule fires; evaluation raises an error" in str(explanation)
    seven = fz.TSK(gap.inputs, [3], no_rule_fires=7).explain(5)
    assert seven.outputs == {"output": 7.0}
    assert seven.contributions["output"].tolist() == [0.0]


def test_inputs_that_are_brought_into_the_universe_are_shown_both_ways():
    explanation = tipper(outside="clamp").explain(12, -1)
    assert explanation.given == {"service": 12, "food": -1}
    assert explanation.inputs == {"service": 10, "food": 0}
    assert explanation.degrees["service"]["excellent"] == 1.0


def test_an_explanation_is_a_table_for_terminals_and_notebooks():
    explanation = tipper().explain(**POINT)
    assert repr(explanation) == str(explanation)
    lines = str(explanation).splitlines()
    assert lines[0] == "tipper"
    assert lines[2].split() == ["input", "value", "degrees"]
    assert lines[6].split() == ["rule", "strength", "share", "adds"]
    assert lines[-1].split() == ["tip", f"{explanation.outputs['tip']:.5g}"]
    html = explanation._repr_html_()
    assert html == explanation.to_html()
    assert html.count("<table>") == 3
    sneaky = fz.Variable("<script>", (0, 1), {"a": fz.gaussian(0, 1)})
    assert "<script>" not in fz.TSK([sneaky], [1]).explain(0).to_html()


def test_firing_strengths_of_one_point_and_of_many(steer):
    points = np.random.default_rng(0).uniform(-1, 1, (5000, 2))
    strengths = steer.strengths(points)
    assert strengths.shape == (5000, 9)
    np.testing.assert_array_equal(strengths, steer.strengths(points, threads=2))
    np.testing.assert_array_equal(strengths[7], steer.strengths(points[7]))
    np.testing.assert_array_equal(strengths[7], steer.explain(points[7]).strengths)
    output = strengths @ steer.consequents.ravel() / strengths.sum(axis=1)
    np.testing.assert_allclose(output, steer(points), rtol=1e-12, atol=1e-15)
    np.testing.assert_array_equal(tipper().strengths(list(POINT.values())), STRENGTHS)
    assert tipper().strengths(np.empty((0, 2))).shape == (0, 3)
    with pytest.raises(fz.errors.ShapeError, match=r"shape \(n, 2\)"):
        steer.strengths(np.zeros((4, 3)))


def test_premises_are_what_a_rule_asks_for():
    either = "very (food is rancid or food is delicious)"
    rule = f"if service is not very good and {either} then tip is cheap"
    system = fz.System([SERVICE, FOOD], TIP, rule)
    points = np.random.default_rng(0).uniform(0, 10, (6, 2))
    (first, asked, degrees), *others = system.premises(0, points)
    assert (first, asked) == ("service", "not very good")
    np.testing.assert_allclose(degrees, 1 - SERVICE.terms["good"](points[:, 0]) ** 2)
    assert [premise[:2] for premise in others] == [("food", "rancid"), ("food", "delicious")]
    np.testing.assert_array_equal(others[1][2], FOOD.terms["delicious"](points[:, 1]))
    with pytest.raises(fz.errors.InvalidValueError, match="less than 1"):
        system.premises(1, points)
    with pytest.raises(fz.errors.InvalidValueError, match="whole number"):
        system.premises(-1, points)


def test_the_set_that_a_rule_implies():
    y, sets = implied("min")
    for rule, strength in enumerate(STRENGTHS):
        found = tipper().implied_set(rule, "tip", strength)
        np.testing.assert_allclose(found, [y, sets[rule]], rtol=1e-12, atol=1e-12)
    height = fz.Output.mamdani(TIP, defuzzifier="height")
    assert tipper(height).implied_set(0, "tip", 1) is None
    with pytest.raises(fz.errors.UnknownNameError, match='unknown output "tap"'):
        tipper().implied_set(0, "tap", 1)
    with pytest.raises(fz.errors.InvalidValueError, match="between 0 and 1"):
        tipper().implied_set(0, "tip", 1.5)


def kinds(system):
    return sorted({finding.kind for finding in system.validate()})


def test_there_is_nothing_odd_about_a_sound_system(steer):
    for system in [tipper(), steer]:
        assert system.validate() == []


def test_what_is_odd_is_told(gap):
    far = fz.Variable(
        "x", (0, 10), {"low": fz.triangular(0, 0, 4), "huge": fz.triangular(20, 30, 40)}
    )
    rules = [
        "if x is low and food is rancid then tip is cheap",
        "if food is rancid and x is low then tip is average",
        "if x is low and food is rancid then tip is cheap with 0.5",
        "if x is huge then tip is generous",
        "if x is not low then tip is cheap with 0",
    ]
    system = fz.System([far, FOOD, SERVICE], TIP, rules)
    assert kinds(system) == [
        "contradiction",
        "duplicate_rule",
        "gap",
        "never_fires",
        "no_rule_fires",
        "outside_universe",
        "unreachable_term",
        "unused_input",
        "unused_term",
        "zero_weight",
    ]
    assert kinds(gap) == ["gap", "no_rule_fires"]
    point = fz.Variable("tip", (0, 1), {"all": fz.triangular(-1, 0, 2), "odd": fz.singleton(0.123)})
    unseen = fz.System([SERVICE], point, ["if service is good then tip is all"])
    assert "unseen_term" in kinds(unseen)


def test_findings_are_plain_things():
    (first, *_) = fz.System([SERVICE, FOOD], TIP, "if food is rancid then tip is cheap").validate()
    assert first.kind == "unused_input"
    assert (
        str(first)
        == first.message
        == ('no rule asks for the input "service"; delete it, or use it')
    )
    assert eval(repr(first), vars(fz)) == first
    assert first != fz.Finding("gap", first.message)
