"""Everything that the constructors and calls of rule systems refuse, in the user's words."""

from __future__ import annotations

import re

import numpy as np
import pytest

import fuzzyrs as fz
from fuzzyrs import errors

X = fz.Variable.evenly("x", (0, 1), ["low", "high"])
Y = fz.Variable.evenly("y", (0, 1), ["low", "high"])
RAMP = fz.Variable("r", (0, 1), {"up": fz.MembershipFunction("ramp", [0, 1])})
EMPTY = fz.Variable("nothing", (0, 1), {})
RULE = "if x is low then y is low"
SYSTEM = fz.System([X, RAMP], Y, RULE, name="two")
LOW, HIGH = X["low"], Y["high"]
NAN, INF = float("nan"), float("inf")


def system(inputs=(X,), outputs=Y, rules=RULE, **options):
    return fz.System(list(inputs), outputs, rules, **options)


def sugeno(terms, rule="if x is low then u is one", **options):
    return fz.System([X], fz.Output.sugeno("u", terms, **options), rule)


ROWS = np.zeros((5, 2))
READ_ONLY = np.zeros(5)
READ_ONLY.flags.writeable = False


VALUES = [
    # Norms and other choices
    (lambda: system(conjunction="prodct"), 'unknown t-norm "prodct"; did you mean "product"?'),
    (lambda: system(conjunction="max"), 'unknown t-norm "max"; known: min, product, lukasiewicz'),
    (lambda: system(disjunction="min"), 'unknown s-norm "min"; known: max, probabilistic_sum'),
    (lambda: system(disjunction="sum"), 'unknown s-norm "sum"'),
    (lambda: system(outside="clip"), 'did you mean "clamp"?'),
    (lambda: fz.Output.mamdani(Y, implication="max"), 'unknown t-norm "max"'),
    (lambda: fz.Output.mamdani(Y, aggregation="summ"), 'did you mean "sum"?'),
    (lambda: fz.Output.mamdani(Y, aggregation="min"), 'unknown aggregation "min"; known: max'),
    (lambda: fz.Output.mamdani(Y, defuzzifier="centroids"), 'did you mean "centroid"?'),
    (lambda: fz.Output.mamdani(Y, defuzzifier="weighted_sum"), 'unknown defuzzifier "weighted_s'),
    (lambda: fz.Output.mamdani(Y, sampling="midpoint"), 'did you mean "midpoints"?'),
    (lambda: fz.Output.sugeno("u", defuzzifier="average"), 'unknown defuzzifier "average"; known'),
    (lambda: fz.Output.sugeno("u", aggregation="min"), 'unknown aggregation "min"'),
    (lambda: fz.Output.tsukamoto(RAMP, defuzzifier="weighted_sums"), 'did you mean "weighted_sum"'),
    (lambda: fz.Output.sugeno("u", no_rule_fires="previos"), 'did you mean "previous"?'),
    # Numbers
    (lambda: fz.Output.mamdani(Y, samples=1), 'samples of "y" must be at least 2, got 1'),
    (lambda: fz.Output.mamdani(Y, samples=10**7), "must be at most 100001, got 10000000"),
    (
        lambda: fz.Output.mamdani(Y, no_rule_fires=INF),
        "the output when no rule fires must be finite",
    ),
    (lambda: fz.Output.tsukamoto(RAMP, no_rule_fires=NAN), "must be finite, got NaN"),
    (lambda: fz.Output.sugeno("u", {"one": NAN}), "u.one[0] must be finite, got NaN"),
    (lambda: fz.Output.sugeno("u", {"one": [1, -INF]}), "u.one[1] must be finite, got -inf"),
    (lambda: sugeno({"one": [1, 2, 3]}), 'coefficients of "one" of "u": expected 2, got 3'),
    (lambda: sugeno({"one": []}), 'coefficients of "one" of "u": expected 2, got 0'),
    (
        lambda: (LOW >> HIGH).weighted(1.01),
        "the weight of a rule must be between 0 and 1, got 1.01",
    ),
    (lambda: (LOW >> HIGH).weighted(-1e-9), "the weight of a rule must be between 0 and 1"),
    (lambda: (LOW >> HIGH).weighted(NAN), "the weight of a rule must be finite, got NaN"),
    # Things that are missing
    (lambda: system(rules=[]), 'rules of "system" must be at least 1, got 0'),
    (lambda: system(rules=""), 'rules of "system" must be at least 1, got 0'),
    (lambda: system(rules="  # if x is low then y is low\n\n"), "must be at least 1, got 0"),
    (lambda: system(rules=[RULE, ""]), 'rule 2, column 1: expected "if", found the end'),
    (lambda: system(inputs=[]), "inputs of a system must be at least 1, got 0"),
    (lambda: system(outputs=[]), "outputs of a system must be at least 1, got 0"),
    (lambda: system(inputs=[], rules=[]), "must be at least 1, got 0"),
    (lambda: fz.Output.mamdani(Y, samples=-1), "a whole number from 0 to 2^64 - 1, got -1"),
    (
        lambda: fz.Output.mamdani(Y, samples=2**70),
        "a whole number from 0 to 2^64 - 1, got 11805916207",
    ),
    (lambda: SYSTEM(0, 0, previous=INF), "previous must be finite, got inf"),
    (lambda: system(hedges={"not": "x"}), 'a hedge called "not" does not fit'),
    (lambda: system(outputs=EMPTY), 'terms of "nothing" must be at least 1, got 0'),
    (lambda: fz.Output.tsukamoto(EMPTY), 'terms of "nothing" must be at least 1, got 0'),
    (lambda: system(outputs=[Y, RAMP]), 'rules about "r" must be at least 1, got 0'),
    (lambda: sugeno(None), 'unknown term "one" of "u"; none is defined'),
    # Things that do not go together
    (
        lambda: fz.Output.tsukamoto(Y),
        'the gaussian term "low" of "y" does not fit: a Tsukamoto out',
    ),
    (lambda: fz.Output.mamdani(Y, sampling="exact"), "exact sampling needs piecewise-linear ones"),
    (
        lambda: fz.Output.mamdani(RAMP, sampling="exact", defuzzifier="bisector"),
        "exact sampling needs min or product as implication, max as aggregation and the centroid",
    ),
    (lambda: fz.Output.mamdani(RAMP, sampling="exact", aggregation="sum"), "exact sampling needs"),
    (lambda: fz.Output.mamdani(RAMP, sampling="exact", implication="einstein"), "sampling needs"),
    (lambda: system(rules="if x is low then y = 2*x"), "only a Sugeno output takes a formula"),
    # Types
    (lambda: system(outputs=None), "outputs must be Output or Variable objects, got"),
    (lambda: system(outputs=[Y, "u"]), "outputs must be Output or Variable objects, got"),
    (lambda: system(outputs=SYSTEM), "outputs must be Output or Variable objects, got"),
    (lambda: system(rules=[RULE, 3]), "rules must be text or Rule objects, got <class 'int'>"),
    (lambda: system(rules=[LOW]), "rules must be text or Rule objects, got <class 'fuzzyrs.Propo"),
    (lambda: system(rules=RULE.encode()), "rules must be text or Rule objects, got"),
    (lambda: fz.Output.sugeno("u", {"one": None}), 'the term "one" must be a number, a sequence'),
    (lambda: fz.Output.sugeno("u", {"one": [1, "x"]}), 'the term "one" must be a number, a sequ'),
    (lambda: fz.Output.sugeno("u", no_rule_fires=[]), '"nan", "previous" or a number'),
    (lambda: LOW >> "y is low", "a rule concludes a proposition or a list of them"),
    (lambda: LOW >> [HIGH, 3], "a rule concludes a proposition or a list of them"),
    (lambda: LOW >> (HIGH & HIGH), 'a rule concludes single propositions, got "y is high and y is'),
    (lambda: LOW >> ~(HIGH | HIGH), "a rule concludes single propositions"),
    # Calls
    (lambda: SYSTEM(1.0), 'x for "two": expected 2 numbers or shape (n, 2), got a single number'),
    (lambda: SYSTEM(), 'arguments of "two": expected 2, or one array, got 0'),
    (lambda: SYSTEM(1, 2, 3), 'arguments of "two": expected 2, or one array, got 3'),
    (lambda: SYSTEM(np.zeros((4, 3))), "expected 2 numbers or shape (n, 2), got shape (4, 3)"),
    (lambda: SYSTEM(np.zeros((2, 2, 2))), "expected 2 numbers or shape (n, 2), got shape (2, 2, 2"),
    (lambda: SYSTEM(np.zeros(3), np.zeros(4)), "the inputs: expected arrays that broadcast"),
    (lambda: SYSTEM([[1, 2], [3]]), "x must be numbers in a regular array"),
    (lambda: SYSTEM("a", "b"), "the inputs must be real numbers, got dtype"),
    (lambda: SYSTEM(None, 0), "the inputs must be real numbers, got dtype object"),
    (lambda: SYSTEM(1j, 0), "the inputs must be real numbers, got dtype complex128"),
    (lambda: SYSTEM(10**400, 0), "the inputs must be real numbers, got dtype object"),
    (lambda: SYSTEM(x=1), 'the input "r" is missing'),
    (lambda: SYSTEM(x=1, rr=1), 'unknown input "rr"; did you mean "r"?'),
    (lambda: SYSTEM(1, 2, r=2), "an input is given both by its place and by its name"),
    (lambda: SYSTEM(ROWS, out=np.zeros(4)), "out must be a contiguous float64 array of shape (5,)"),
    (lambda: SYSTEM(ROWS, out=np.zeros((5, 1))), "out must be a contiguous float64 array of shape"),
    (lambda: SYSTEM(ROWS, out=np.zeros(5, "f4")), "out must be a contiguous float64 array of shap"),
    (lambda: SYSTEM(ROWS, out=ROWS[:, 0]), "out must be a contiguous float64 array of shape (5,)"),
    (lambda: SYSTEM(ROWS, out=[0] * 5), "out must be a contiguous float64 array of shape (5,)"),
    (lambda: SYSTEM(ROWS, out=READ_ONLY), "out cannot be written"),
    (lambda: SYSTEM(0, 0, out=np.zeros(1)), "out: expected inputs of shape (n,)"),
    (lambda: SYSTEM(0, 0, previous=[1, 2]), "previous: expected 1 numbers, one for each output"),
    (lambda: SYSTEM(ROWS, previous="x"), "previous must be real numbers"),
    (lambda: SYSTEM(ROWS, threads=-1), "must be a whole number from 0 to 2^64 - 1, got -1"),
    (lambda: SYSTEM.gradient([1, 2, 3]), 'inputs of "two": expected 2, got 3'),
    (lambda: SYSTEM.gradient(1), 'inputs of "two": expected 2, got 1'),
    (lambda: SYSTEM.gradient([1, 2], wrt="input"), 'did you mean "inputs"?'),
    (lambda: SYSTEM.gradient([1, 2], threads=-1), "must be a whole number"),
    (lambda: SYSTEM.with_parameters([1]), 'parameters of "two": expected 11, got 1'),
    (lambda: SYSTEM.with_parameters([[1]]), "parameters: expected a one-dimensional array"),
    (lambda: SYSTEM.population([[1, 2]], ROWS), "expected an array of shape (n, 11), got shape"),
    (
        lambda: SYSTEM.population([SYSTEM.parameters], [1, 2, 3]),
        'x for "two": expected 2 numbers or shape (n, 2), got shape (3,)',
    ),
    (
        lambda: SYSTEM.population([SYSTEM.parameters], ROWS, out=np.zeros(5)),
        "out must be a contiguous float64 array of shape (1, 5)",
    ),
]


@pytest.mark.parametrize(("call", "words"), VALUES, ids=[words[:50] for _, words in VALUES])
def test_what_does_not_fit_is_refused_in_the_users_words(call, words):
    with pytest.raises(errors.FuzzyrsError, match=re.escape(words)):
        call()


# What Python refuses itself, since the types are declared.
TYPES = [
    lambda: fz.System(None, Y, RULE),
    lambda: fz.System("x", Y, RULE),
    lambda: fz.System([X, Y["low"]], Y, RULE),
    lambda: fz.System([fz.Output.mamdani(X)], Y, RULE),
    lambda: system(rules=None),
    lambda: system(rules=3),
    lambda: system(conjunction=min),
    lambda: system(hedges=["very"]),
    lambda: system(hedges={"own": 2}),
    lambda: system(hedges={"own": lambda x: x}),
    lambda: system(name=3),
    lambda: system(nmae="system"),
    lambda: fz.Output(),
    lambda: fz.Rule(RULE),
    lambda: fz.Proposition("x is low"),
    lambda: fz.Output.mamdani("y"),
    lambda: fz.Output.mamdani(Y, samples=10.5),
    lambda: fz.Output.mamdani(Y, "min"),
    lambda: fz.Output.sugeno(3),
    lambda: fz.Output.sugeno("u", [1, 2]),
    lambda: fz.Output.sugeno("u", {1: 2}),
    lambda: fz.Output.tsukamoto(fz.Output.mamdani(RAMP)),
    lambda: LOW & "y is low",
    lambda: LOW | 1,
    lambda: 1 & LOW,
    lambda: LOW & LOW >> HIGH,
    lambda: LOW.hedge(2),
    lambda: "x is low" >> HIGH,
    lambda: (LOW >> HIGH).weighted("much"),
    lambda: SYSTEM(ROWS, threads=1.5),
    lambda: SYSTEM(ROWS, threads="2"),
    lambda: SYSTEM.gradient([1, 2], wrt=0),
    lambda: fz.System.from_json(3),
    lambda: fz.System.from_json(b"{}"),
]


@pytest.mark.parametrize("call", TYPES)
def test_what_has_another_type_is_a_type_error(call):
    with pytest.raises(TypeError) as caught:
        call()
    assert len(str(caught.value)) > 5


def test_nothing_is_changed_by_a_call_that_fails():
    text = SYSTEM.to_json()
    out = np.full(5, 7.0)
    with pytest.raises(errors.InvalidValueError):
        SYSTEM(np.full((5, 2), NAN), out=out)
    assert SYSTEM.to_json() == text
    assert SYSTEM(ROWS, out=out).tolist() == [SYSTEM(0, 0)] * 5


def test_outputs_that_are_no_numbers_are_refused():
    """A formula may leave the numbers; so may a sum of large ones."""
    root = sugeno({}, "if x is low then u = sqrt(x - 0.5)", no_rule_fires=0.0)
    match = r'output "u" of "system" at \[0.25\] must be finite, got NaN'
    with pytest.raises(errors.InvalidValueError, match=match):
        root(0.25)
    match = r'output "u" of "system" at point 1 \[0.25\] must be finite, got NaN'
    with pytest.raises(errors.InvalidValueError, match=match):
        root([0.75, 0.25])
    huge = sugeno({"one": [1e308, 1e308]}, defuzzifier="weighted_sum")
    with pytest.raises(errors.InvalidValueError, match="must be finite, got inf"):
        huge(1.0)


@pytest.mark.parametrize("defuzzifier", ["centroid", "bisector", "mean_of_maximum"])
@pytest.mark.parametrize("answer", ["error", "nan", "previous", 0.25])
def test_a_set_between_the_samples_concludes_nothing(defuzzifier, answer):
    narrow = fz.Variable("y", (0, 1), {"low": fz.triangular(0.501, 0.502, 0.503)})
    output = fz.Output.mamdani(narrow, defuzzifier=defuzzifier, no_rule_fires=answer)
    empty = system(outputs=output)
    if answer == "error":
        with pytest.raises(errors.NoRuleFiresError):
            empty(0.0)
    else:
        came = empty(0.0, previous=0.5)
        np.testing.assert_equal(came, {"previous": 0.5, "nan": NAN, 0.25: 0.25}[answer])


@pytest.mark.parametrize(
    "expression",
    [lambda: LOW and HIGH, lambda: LOW or HIGH, lambda: not LOW],
    ids=["and", "or", "not"],
)
def test_pythons_own_words_are_no_operators(expression):
    with pytest.raises(errors.InvalidTypeError, match="neither true nor false"):
        expression()


def test_one_thing_needs_no_list():
    rule = LOW >> Y["low"]
    assert fz.System(X, Y, rule) == fz.System([X], [Y], [rule]) == fz.System([X], Y, RULE)
    assert fz.System((X,), (Y,), (RULE,)) == fz.System(iter([X]), iter([Y]), iter([RULE]))


def test_an_input_that_only_formulas_ask_for_needs_no_terms():
    output = fz.Output.sugeno("u")
    built = fz.System([X, EMPTY], output, "if x is low then u = 2*nothing")
    assert built(0.3, 0.25) == 0.5
    assert fz.System.from_json(built.to_json()) == built
