"""Rule systems as files, pickles, copies, and what they tell about themselves."""

from __future__ import annotations

import copy
import json
import pickle
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fuzzyrs as fz
import rule_models as models
from fuzzyrs import errors

X = fz.Variable.evenly("x", (-1, 1 / 3), ["low", "high"])
Y = fz.Variable("y", (0, 1), {"on": fz.MembershipFunction("ramp", [0.1, 0.7])})
SET = fz.Variable("set", (0, 1), {"a": fz.triangular(0, 0.1, 0.3), "b": fz.gaussian(1, 0.2)})
RAMPS = fz.Variable("ramps", (0, 1), {"a": fz.MembershipFunction("sigmoid", [0.3, -7])})
NUMBERS = fz.Output.sugeno(
    "numbers",
    {"one": 1 / 3, "line": [0.1, -1e-300, 2e17], "curve": "x^2 - 0.1*sin(y)", "flat": "2 - 1/3"},
    aggregation="max",
    defuzzifier="weighted_sum",
    no_rule_fires=-0.1,
)
OUTPUTS = [
    fz.Output.mamdani(SET, implication="product", aggregation="sum", samples=7),
    NUMBERS,
    fz.Output.tsukamoto(RAMPS, no_rule_fires="nan"),
]
RULES = """
if x is very low or not (y is on and x is rather high) then set is a and numbers is line with 0.1
if x is high then set is not b, numbers = x/y + 0.3, ramps is a with 0.7
if y is on then numbers is curve and numbers is one
"""
SYSTEM = fz.System(
    [X, Y],
    OUTPUTS,
    RULES,
    conjunction="product",
    disjunction="einstein",
    hedges={"rather": "x^1.5", "very": "x^3"},
    outside="clamp",
    name="a system",
)
TEXT = SYSTEM.to_json()
POINTS = np.random.default_rng(4).uniform(0.2, 1, (50, 2))


@settings(max_examples=80)
@given(models.systems(), st.data())
def test_documents_keep_every_bit(model, data):
    built = models.build(model)
    again = fz.System.from_json(built.to_json())
    assert again == built
    assert again.to_json() == built.to_json()
    assert again.parameters.tobytes() == built.parameters.tobytes()
    assert again.parameter_names == built.parameter_names
    points, before = data.draw(models.points(model)), [0.5] * len(model.outputs)
    try:
        right = built(points, previous=before)
    except fz.FuzzyrsError as error:
        with pytest.raises(type(error), match=re.escape(str(error))):
            again(points, previous=before)
    else:
        assert again(points, previous=before).tobytes() == right.tobytes()


@pytest.mark.parametrize(
    "way",
    [
        copy.copy,
        copy.deepcopy,
        lambda system: fz.System.from_json(system.to_json()),
        *[
            lambda system, protocol=protocol: pickle.loads(pickle.dumps(system, protocol))
            for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1)
        ],
    ],
)
def test_copies_answer_alike(way):
    again = way(SYSTEM)
    assert again == SYSTEM
    assert again.to_json() == TEXT
    assert again(POINTS).tobytes() == SYSTEM(POINTS).tobytes()
    changed = SYSTEM.with_parameters(SYSTEM.parameters * 0.97)
    assert way(changed) == changed != SYSTEM


def test_files_come_back_as_systems(tmp_path):
    SYSTEM.save(tmp_path / "system.json")
    assert (tmp_path / "system.json").read_text(encoding="utf-8") == TEXT
    loaded = fz.load(str(tmp_path / "system.json"))
    assert type(loaded) is fz.System
    assert loaded == SYSTEM


def test_documents_are_readable():
    document = json.loads(TEXT)
    assert document["type"] == "system"
    assert document["rules"][0] == (
        "if x is very low or not (y is on and x is rather high) "
        "then set is a and numbers is line with 0.1"
    )
    assert document["hedges"][0] == {"name": "rather", "formula": "x^1.5"}


def test_many_rules_come_back():
    rules = ["if x is low then numbers is one with 0.1234567890123456"] * 25_000
    many = fz.System([X, Y], NUMBERS, rules)
    assert fz.System.from_json(many.to_json()) == many


# Documents that are none


def test_every_truncated_document_is_refused():
    for end in range(len(TEXT.rstrip())):
        with pytest.raises(errors.FormatError):
            fz.System.from_json(TEXT[:end])


def test_a_byte_that_is_another_breaks_nothing():
    rng = np.random.default_rng(9)
    kept = 0
    for place in rng.permutation(len(TEXT))[:1500]:
        changed = TEXT[:place] + rng.choice(list('{}[]",:0-9eé \\\n')) + TEXT[place + 1 :]
        try:
            kept += fz.System.from_json(changed) == SYSTEM
        except fz.FuzzyrsError:
            continue
    assert kept < 300  # white space and the like


def test_lines_that_are_missing_break_nothing():
    lines, kept = TEXT.splitlines(), 0
    for index in range(len(lines)):
        try:
            changed = fz.System.from_json("\n".join(lines[:index] + lines[index + 1 :]))
        except fz.FuzzyrsError:
            continue
        kept += 1
        assert changed != SYSTEM
    assert kept < 5  # without its first rule it is a system, too


def edited(change):
    document = json.loads(TEXT)
    change(document)
    return json.dumps(document)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda d: d.update(version=2), 'document version "2" is not supported'),
        (lambda d: d.update(version="1"), "version"),
        (lambda d: d.update(type="tsk"), 'document type "tsk" is not supported'),
        (lambda d: d.update(format="numpy"), "numpy"),
        (lambda d: d.update(more=1), "unknown field `more`"),
        (lambda d: d.pop("outside"), "missing field `outside`"),
        (lambda d: d.update(outside="kept"), 'did you mean "keep"?'),
        (lambda d: d.update(conjunction="max"), 'unknown t-norm "max"'),
        (lambda d: d.update(disjunction="maxx"), 'did you mean "max"?'),
        (lambda d: d.update(name=""), "the system name"),
        (lambda d: d.update(inputs=[]), 'unknown name "x"'),
        (lambda d: d.update(outputs=[]), "outputs of a system must be at least 1, got 0"),
        (lambda d: d.update(rules=[]), "must be at least 1, got 0"),
        (lambda d: d.update(rules="if"), "invalid type: string"),
        (lambda d: d["rules"].append("if x is low"), "rule 4, column 12: expected"),
        (lambda d: d["hedges"][0].update(formula="2*x"), 'the hedge "rather" at the degree'),
        (lambda d: d["hedges"].append(d["hedges"][0]), 'hedge "rather" appears twice'),
        (lambda d: d["inputs"][0].update(universe=[1, 0]), "upper end of the universe"),
        (lambda d: d["inputs"][0].update(universe=[1]), "expected an array of length 2"),
        (lambda d: d["inputs"][0]["terms"][0].update(shape="gausian"), 'did you mean "gaussian"?'),
        (lambda d: d["inputs"][0]["terms"][0].update(parameters=[1]), "expected 2, got 1"),
        (lambda d: d["inputs"].append(d["inputs"][0]), 'variable "x" appears twice'),
        (lambda d: d["outputs"][0].update(method="mamdan"), "unknown variant `mamdan`"),
        (lambda d: d["outputs"][0].update(samples=1), 'samples of "set" must be at least 2'),
        (lambda d: d["outputs"][0].update(samples=-1), "invalid value: integer `-1`"),
        (lambda d: d["outputs"][0].pop("samples"), 'samples of "set" must be at least 2'),
        (lambda d: d["outputs"][0].update(sampling="exact"), "exact sampling needs"),
        (lambda d: d["outputs"][0].update(extra=0), "unknown field `extra`"),
        (lambda d: d["outputs"][1]["terms"][0].update(value=None), "not a valid fuzzyrs JSON doc"),
        (lambda d: d["outputs"][1]["terms"][1].update(value=[1, 2]), "expected 3, got 2"),
        (lambda d: d["outputs"][1]["terms"][2].update(value="x^"), "formula, column 3"),
        (lambda d: d["outputs"][1].update(no_rule_fires={"value": "1"}), "invalid type: string"),
        (lambda d: d["outputs"][2].update(variable=d["outputs"][0]["variable"]), "monotone"),
    ],
)
def test_documents_that_say_something_else(change, words):
    with pytest.raises(fz.FuzzyrsError) as caught:
        fz.System.from_json(edited(change))
    assert words in str(caught.value)


@pytest.mark.parametrize(
    "text",
    ["", " ", "null", "3", "[]", '"system"', "{}", "[" * 100_000, '{"a":' * 100_000, "\ufeff{}"],
    ids=ascii,
)
def test_what_is_no_document_is_refused(text):
    with pytest.raises(errors.FormatError, match="not a valid fuzzyrs JSON document"):
        fz.System.from_json(text)


def test_numbers_that_json_has_not_are_refused():
    for number in ["NaN", "Infinity", "1e999", "0x10", "1_000"]:
        with pytest.raises(fz.FuzzyrsError):
            fz.System.from_json(TEXT.replace("0.3333333333333333", number))


# What they are


def test_systems_are_compared_by_everything_they_are():
    inputs, rules = SYSTEM.inputs, SYSTEM.rules
    options = {
        "conjunction": "product",
        "disjunction": "einstein",
        "hedges": SYSTEM.hedges,
        "outside": "clamp",
        "name": "a system",
    }
    outputs = SYSTEM.outputs
    assert fz.System(inputs, outputs, rules, **options) == SYSTEM
    others = [
        fz.System(inputs, outputs, rules, **{**options, **change})
        for change in [
            {"conjunction": "min"},
            {"disjunction": "max"},
            {"hedges": {"rather": "x^1.5", "very": "x^2"}},
            {"outside": "keep"},
            {"name": "other"},
        ]
    ]
    lighter = [rules[0].weighted(0.2), *rules[1:]]
    wider = fz.Output.mamdani(SET, implication="product", aggregation="sum", samples=8)
    others += [
        fz.System(inputs[::-1], fz.Output.mamdani(SET), "if x is low then set is a"),
        fz.System(inputs, outputs, rules[::-1], **options),
        fz.System(inputs, outputs, lighter, **options),
        fz.System(inputs, [wider, *outputs[1:]], rules, **options),
        fz.System(inputs, outputs[::-1], rules, **options),
    ]
    assert all(other != SYSTEM for other in others)
    assert SYSTEM != "a system"
    with pytest.raises(TypeError, match="unhashable"):
        hash(SYSTEM)


def test_a_system_tells_what_it_is():
    assert repr(SYSTEM) == (
        '<System "a system": x [low high], y [on] -> set, numbers, ramps, 3 rules>'
    )
    assert (SYSTEM.name, SYSTEM.conjunction, SYSTEM.disjunction, SYSTEM.outside) == (
        "a system",
        "product",
        "einstein",
        "clamp",
    )
    assert SYSTEM.hedges == {"rather": "x^1.5", "very": "x^3"}
    assert SYSTEM.inputs == [X, Y]
    assert [output.name for output in SYSTEM.outputs] == ["set", "numbers", "ramps"]
    assert [rule.weight for rule in SYSTEM.rules] == [0.1, 0.7, 1.0]
    assert SYSTEM.rules[0].antecedent == SYSTEM.rules[0].antecedent != SYSTEM.rules[1].antecedent


def test_outputs_tell_what_they_are():
    sets, numbers, ramps = SYSTEM.outputs
    assert repr(sets) == '<Output "set": mamdani, centroid [a b]>'
    assert (sets.method, sets.defuzzifier, sets.no_rule_fires) == ("mamdani", "centroid", "error")
    assert sets.variable == SET
    assert sets.terms == SET.terms
    assert repr(ramps) == '<Output "ramps": tsukamoto, weighted_average [a]>'
    assert (ramps.variable, ramps.no_rule_fires) == (RAMPS, "nan")
    assert (numbers.method, numbers.defuzzifier) == ("sugeno", "weighted_sum")
    assert (numbers.variable, numbers.no_rule_fires) == (None, -0.1)
    assert numbers.terms == {
        "one": 1 / 3,
        "line": [0.1, -1e-300, 2e17],
        "curve": "x^2 - 0.1*sin(y)",
        "flat": 2 - 1 / 3,
        "rule2": "x/y + 0.3",
    }
    assert NUMBERS.terms["flat"] == "2 - 1/3"  # not read yet
    assert sets == OUTPUTS[0]
    assert ramps == OUTPUTS[2] != fz.Output.tsukamoto(RAMPS)
    with pytest.raises(TypeError, match="unhashable"):
        hash(sets)


def test_parameters_have_names_and_bounds():
    names, parameters, bounds = SYSTEM.parameter_names, SYSTEM.parameters, SYSTEM.bounds
    assert names == [
        *["x.low.mean", "x.low.sigma", "x.high.mean", "x.high.sigma", "y.on.start", "y.on.end"],
        *["set.a.a", "set.a.b", "set.a.c", "set.b.mean", "set.b.sigma"],
        "numbers.one.constant",
        *["numbers.line.x", "numbers.line.y", "numbers.line.constant"],
        "numbers.flat.constant",
        *["ramps.a.centre", "ramps.a.slope"],
        *["rule.1.weight", "rule.2.weight", "rule.3.weight"],
    ]
    assert parameters[names.index("numbers.line.constant")] == 2e17
    assert parameters[-3:].tolist() == [0.1, 0.7, 1.0]
    assert bounds.shape == (len(names), 2)
    assert bounds[-3:].tolist() == [[0, 1]] * 3
    assert bounds[names.index("x.low.mean")].tolist() == [-1, 1 / 3]
    assert np.isinf(bounds[11:16]).all()
    assert (bounds[:, 0] < bounds[:, 1]).all()


def test_other_parameters_make_another_system():
    before = SYSTEM.parameters
    moved = before.copy()
    moved[[0, 6, 11, -1]] = [-0.8, -0.1, 7, 0.25]
    other = SYSTEM.with_parameters(moved)
    np.testing.assert_array_equal(other.parameters, moved)
    np.testing.assert_array_equal(SYSTEM.parameters, before)
    assert other.inputs[0].terms["low"].parameters["mean"] == -0.8
    assert other.outputs[0].terms["a"].parameters["a"] == -0.1
    assert other.outputs[1].terms["one"] == 7
    assert other.rules[2].weight == 0.25
    assert other != SYSTEM == other.with_parameters(before)
    assert (other.hedges, other.outside, other.name) == (SYSTEM.hedges, "clamp", "a system")
    for array in [SYSTEM.parameters, SYSTEM.bounds]:
        array[...] = 99
    assert 99 not in SYSTEM.parameters
    assert 99 not in SYSTEM.bounds
