"""Calls of rule systems: one point and many to the same bits, every form of input, the edges."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fuzzyrs as fz
import rule_models as models

THREADS = [1, 2, 7]
# More than two blocks of 4096 rows, and a last block that is not full.
ROWS = 2 * 4096 + 13

X, Y = (fz.Variable.evenly(name, (-1, 1), "NZP") for name in "xy")
SHARP = fz.Variable.evenly("v", (0, 10), ["low", "high"], shape="triangular")
SMOOTH = fz.Variable.evenly("v", (0, 10), ["low", "high"])
RAMPS = fz.Variable(
    "v",
    (0, 10),
    {
        "low": fz.MembershipFunction("ramp", [10, 0]),
        "high": fz.MembershipFunction("sigmoid", [5, 1]),
    },
)
RULES = """
if x is N or not y is very P then v is low
if x is somewhat Z and (y is P or x is P) then v is high with 0.7
if x is P and y is N then v is low with 0.2
"""
OUTPUTS = {
    **{
        name: fz.Output.mamdani(SMOOTH, defuzzifier=name, samples=31)
        for name in models.DEFUZZIFIERS
    },
    "larsen": fz.Output.mamdani(SHARP, implication="product", aggregation="sum"),
    "einstein": fz.Output.mamdani(SMOOTH, implication="einstein", aggregation="einstein"),
    "height": fz.Output.mamdani(SMOOTH, defuzzifier="height"),
    "exact": fz.Output.mamdani(SHARP, sampling="exact"),
    "exact larsen": fz.Output.mamdani(SHARP, sampling="exact", implication="product"),
    "sugeno": fz.Output.sugeno("v", {"low": [1, -2, 0.5], "high": 3}),
    "formulas": fz.Output.sugeno("v", {"low": "sin(x)*y", "high": "exp(-x^2)"}),
    "joined": fz.Output.sugeno("v", {"low": 1, "high": 3}, aggregation="einstein"),
    "tsukamoto": fz.Output.tsukamoto(RAMPS),
}
SYSTEMS = {name: fz.System([X, Y], output, RULES) for name, output in OUTPUTS.items()}
each = pytest.mark.parametrize("system", SYSTEMS.values(), ids=SYSTEMS)

TEXT = """
if x is N then v is low and w is one
if x is P and y is P then v is high and w = 2*x
if y is N then w is one with 0.5
"""
TWO = fz.System([X, Y], [SMOOTH, fz.Output.sugeno("w", {"one": 1})], TEXT, name="two")


@each
def test_one_point_and_many_agree_to_the_bit_on_any_number_of_threads(system):
    points = np.random.default_rng(5).uniform(-1.5, 1.5, (ROWS, 2))
    alone = np.array([system(x, y) for x, y in points.tolist()])
    for threads in [*THREADS, 0]:
        assert system(points, threads=threads).tobytes() == alone.tobytes()
    few = points[:100]
    for wrt in ["inputs", "parameters"]:
        gradients = np.array([system.gradient(x, wrt=wrt) for x in few])
        assert system.gradient(few, wrt=wrt).tobytes() == gradients.tobytes()


@each
def test_gradients_are_the_same_on_any_number_of_threads(system):
    points = np.random.default_rng(6).uniform(-1.5, 1.5, (4096 + 13, 2))
    for wrt in ["inputs", "parameters"]:
        every = [system.gradient(points, wrt=wrt, threads=n).tobytes() for n in THREADS]
        assert len(set(every)) == 1


def test_several_outputs_agree_to_the_bit_too():
    points = np.random.default_rng(7).uniform(-1, 1, (ROWS, 2))
    alone = np.array([TWO(x, y) for x, y in points.tolist()])
    assert {TWO(points, threads=n).tobytes() for n in THREADS} == {alone.tobytes()}
    gradients = {TWO.gradient(points[:5000], threads=n).tobytes() for n in THREADS}
    assert gradients == {np.array([TWO.gradient(x) for x in points[:5000]]).tobytes()}


@settings(max_examples=80)
@given(models.systems(), st.data())
def test_any_system_answers_alike_alone_and_among_many(model, data):
    points = data.draw(models.points(model))
    system = models.build(model)
    try:
        together = system(points, previous=[0.5] * len(model.outputs))
    except fz.FuzzyrsError:
        return
    before, alone = [0.5] * len(model.outputs), []
    for point in points:
        before = system(*point, previous=before)
        alone.append(before)
    assert together.tobytes() == np.array(alone).tobytes()


# Forms of input

A, B = 0.25, -0.5
POINTS = np.tile([A, B], (6, 1))


@pytest.mark.parametrize(
    ("inputs", "shape"),
    [
        ((A, B), ()),
        ((np.float64(A), np.float32(B)), ()),
        ((np.array(A), B), ()),
        (([A, B],), ()),
        ((np.array([A, B]),), ()),
        (([[A, B]] * 3,), (3,)),
        (([A] * 3, B), (3,)),
        ((A, np.full((2, 1), B)), (2, 1)),
        ((np.full((4, 1), A), np.full((1, 5), B)), (4, 5)),
        ((np.asfortranarray(POINTS),), (6,)),
        ((POINTS[::-2],), (3,)),
        ((POINTS.astype("float32"),), (6,)),
        ((POINTS.astype(">f8"),), (6,)),
        ((np.empty((0, 2)),), (0,)),
        ((np.empty((3, 0)), B), (3, 0)),
    ],
)
def test_every_form_of_input_gives_the_same(inputs, shape):
    system = SYSTEMS["centroid"]
    one = system(*inputs)
    assert type(one) is (np.ndarray if shape else float)
    assert np.shape(one) == shape
    assert (np.asarray(one) == system(A, B)).all()
    several = TWO(*inputs)
    assert type(several) is np.ndarray
    assert several.shape == (*shape, 2)
    assert (several == TWO(A, B)).all()


def test_integers_and_booleans_are_numbers():
    assert TWO(True, 0).tolist() == TWO(1.0, 0.0).tolist()
    assert TWO([[1, 0]])[0].tolist() == TWO(1.0, 0.0).tolist()


def test_a_single_input_takes_vectors_and_columns():
    system = fz.System([X], SMOOTH, "if x is N then v is low\nif x is P then v is high")
    assert system([A, B]).shape == system([[A], [B]]).shape == (2,)
    assert type(system(A)) is type(system(np.array(A))) is float
    assert system([A, B])[1] == system(B)


def test_inputs_by_name():
    right = TWO(A, B).tolist()
    assert TWO(x=A, y=B).tolist() == TWO(y=B, x=A).tolist() == TWO(A, y=B).tolist() == right
    column, row = np.full((4, 1), A), np.full(5, B)
    assert TWO(y=row, x=column).shape == (4, 5, 2)
    assert (TWO(y=row, x=column) == right).all()
    out = np.empty((6, 2))
    assert TWO(y=np.full(6, B), x=A, out=out, threads=2) is out
    assert (out == right).all()
    odd = fz.Variable.evenly("room temperature", (0, 1), "ab")
    system = fz.System([odd], SMOOTH, 'if "room temperature" is a then v is low')
    assert system(**{"room temperature": 0.5}) == system(0.5)


def test_results_are_written_into_out():
    points = np.random.default_rng(0).uniform(-1, 1, (50, 2))
    for system, shape in [(SYSTEMS["centroid"], (50,)), (TWO, (50, 2))]:
        out = np.full(shape, np.nan)
        assert system(points, out=out) is out
        assert out.tobytes() == system(points).tobytes()
        spread = np.empty((5, 10, *shape[1:]))
        x, y = points.T.reshape(2, 5, 10)
        assert system(x, y, out=spread) is spread
        assert spread.tobytes() == out.tobytes()


@each
def test_a_population_is_one_system_after_the_other(system):
    rng = np.random.default_rng(8)
    points = rng.uniform(-1, 1, (37, 2))
    vectors = np.clip(system.parameters * rng.uniform(0.95, 1, (5, len(system.parameters))), -9, 9)
    vectors[0] = system.parameters
    right = np.array([system.with_parameters(vector)(points) for vector in vectors])
    for threads in THREADS:
        assert system.population(vectors, points, threads=threads).tobytes() == right.tobytes()
    out = np.empty((5, 37))
    assert system.population(vectors, points, out=out) is out
    assert out.tobytes() == right.tobytes()
    assert system(points).tobytes() == right[0].tobytes()
    picks_samples = ("bisector", "smallest_of_maximum", "largest_of_maximum", "mean_of_maximum")
    assert len(set(right[:, 0])) > 1 or system.outputs[0].defuzzifier in picks_samples


def test_populations_of_several_outputs():
    vectors = np.tile(TWO.parameters, (3, 1))
    vectors[:, -1] = [0.25, 0.5, 1]
    came = TWO.population(vectors, POINTS)
    assert came.shape == (3, 6, 2)
    for vector, values in zip(vectors, came, strict=True):
        assert values.tobytes() == TWO.with_parameters(vector)(POINTS).tobytes()
    assert TWO.population(vectors, np.empty((0, 2))).shape == (3, 0, 2)
    assert TWO.population(np.empty((0, len(vectors[0]))), POINTS).shape == (0, 6, 2)


@settings(max_examples=40)
@given(models.systems(), st.data())
def test_populations_of_any_system(model, data):
    points = data.draw(models.points(model))
    system = models.build(model)
    vectors = np.tile(system.parameters, (2, 1))
    vectors[1, -len(model.rules) :] *= 0.9  # the rules' weights
    try:
        right = [system.with_parameters(vector)(points) for vector in vectors]
    except fz.FuzzyrsError:
        with pytest.raises(fz.FuzzyrsError):
            system.population(vectors, points)
        return
    assert system.population(vectors, points, threads=2).tobytes() == np.array(right).tobytes()


# The edges: no rule fires, or an input is outside its universe

LOW = fz.Variable("x", (0, 4), {"low": fz.triangular(-1, 0, 1)})
GAP = [4, 0.5, 3, 2, 0.25, 4, 4, 4, 4, 4, 0.75, 4]


def gap(*answers):
    """Build a system whose outputs are the input below 1; above no rule fires."""
    outputs = [fz.Output.sugeno(f"u{i}", no_rule_fires=a) for i, a in enumerate(answers)]
    said = " and ".join(f"u{i} = x" for i in range(len(answers)))
    return fz.System([LOW], outputs, f"if x is low then {said}", name="gap")


def test_no_rule_fires():
    with pytest.raises(fz.errors.NoRuleFiresError, match=r'no rule of "gap" fires at \[3.0\]'):
        gap("error")(3)
    with pytest.raises(fz.errors.NoRuleFiresError, match=r"at point 2 \[3.0\]"):
        gap("error")([0.5, 0.25, 3])
    about = r'no rule of "gap" about "u1" fires at point 1 \[3.0\]'
    with pytest.raises(fz.errors.NoRuleFiresError, match=about):
        gap("nan", "error")([0.5, 3])
    assert np.isnan(gap("nan")(3))
    assert gap(-7)(3) == -7.0
    np.testing.assert_array_equal(gap("nan", 2)([0.5, 3]), [[0.5, 0.5], [np.nan, 2]])


def test_what_was_before_is_kept_along_a_batch():
    kept = gap("previous")
    right = [9, 0.5, 0.5, 0.5, 0.25, 0.25, 0.25, 0.25, 0.25, 0.25, 0.75, 0.75]
    assert kept(GAP, previous=9).tolist() == right
    long = kept(np.tile(GAP, 1000), previous=9, threads=3)
    assert long.tolist() == right + 999 * [0.75, *right[1:]]
    out = np.full(len(GAP), 5.0)
    assert kept(GAP, previous=[9], out=out).tolist() == right
    with pytest.raises(fz.errors.NoRuleFiresError, match=r"at point 0 \[4.0\]"):
        kept(GAP)
    # What stood in out is no output before.
    with pytest.raises(fz.errors.NoRuleFiresError):
        kept(GAP, out=np.full(len(GAP), 5.0))
    assert kept(GAP[1:]).tolist() == right[1:]
    assert kept(3, previous=2.5) == 2.5
    assert kept(0.5, previous=2.5) == 0.5
    with pytest.raises(fz.errors.NoRuleFiresError, match=r"fires at \[3.0\]"):
        kept(3)
    with pytest.raises(fz.errors.NoRuleFiresError):
        kept.population([kept.parameters], [[3.0]])


def test_each_output_keeps_its_own():
    mixed = gap("previous", -1, "previous")
    came = mixed([3, 0.5, 3, 3], previous=[1, 2, 3])
    right = [[1, -1, 3], [0.5, 0.5, 0.5], [0.5, -1, 0.5], [0.5, -1, 0.5]]
    assert came.tolist() == right
    assert mixed(3, previous=[1, 2, 3]).tolist() == right[0]


def test_a_rule_of_weight_zero_never_fires():
    output = fz.Output.sugeno("u", {"one": 1}, no_rule_fires="nan")
    assert np.isnan(fz.System([LOW], output, "if x is low then u is one with 0")(0.0))


def test_inputs_outside_their_universe():
    inputs = [LOW, fz.Variable("y", (-1, 1), {"any": fz.gaussian(0, 5)})]
    rule = "if y is any then u = x + 10*y"
    built = {
        name: fz.System(inputs, fz.Output.sugeno("u"), rule, outside=name)
        for name in ["keep", "clamp", "error"]
    }
    assert built["keep"](5, -2) == -15
    assert built["clamp"](5, -2) == 4 - 10
    assert built["clamp"]([[5, -2], [-1, 0.5]]).tolist() == [-6, 5]
    match = 'input "y" must be from -1 to 1, got -2'
    with pytest.raises(fz.errors.InvalidValueError, match=match):
        built["error"](4, -2)
    match = 'input "x" of point 1 must be from 0 to 4, got 5'
    with pytest.raises(fz.errors.InvalidValueError, match=match):
        built["error"]([[4, 1], [5, 0]])
    assert built["error"](4, -1) == built["clamp"](4, -1) == built["keep"](4, -1)
    # Beyond the end nothing changes any more.
    assert built["clamp"].gradient([5, 0.5], wrt="inputs").tolist() == [0, 10]


@pytest.mark.parametrize("outside", ["keep", "clamp", "error"])
def test_numbers_that_are_none_are_refused(outside):
    system = fz.System([X, Y], SMOOTH, "if x is N then v is low", outside=outside)
    for bad in [np.nan, np.inf, -np.inf]:
        with pytest.raises(fz.errors.InvalidValueError, match='input "y" must be finite'):
            system(0, bad)
        with pytest.raises(fz.errors.InvalidValueError, match='input "x" of point 70 must be fini'):
            system(np.vstack([np.zeros((70, 2)), [[bad, 0]]]))
        for wrt in ["inputs", "parameters"]:
            with pytest.raises(fz.errors.InvalidValueError, match="must be finite"):
                system.gradient([bad, 0], wrt=wrt)
        with pytest.raises(fz.errors.InvalidValueError, match="must be finite"):
            system.population([system.parameters], [[0, bad]])
        with pytest.raises(fz.errors.InvalidValueError, match="must be finite"):
            system.population([[*system.parameters[:-1], bad]], [[0, 0]])
