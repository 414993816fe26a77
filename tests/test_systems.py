"""TSK systems: their values against the oracle, every form of input, copies and files."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fuzzyrs as fz
import oracle
from shapes import AROUND

small = st.floats(-2, 2)


@st.composite
def terms(draw):
    """Draw a term so wide that the product of three degrees between -3 and 3 is no underflow."""
    shape = draw(st.sampled_from(sorted(oracle.SHAPES)))
    return fz.MembershipFunction(shape, AROUND[shape](draw(small), draw(st.floats(0.6, 2))))


@st.composite
def systems(draw):
    """Draw a system of up to three inputs and order 0 or 1."""
    inputs = []
    for name in "xyz"[: draw(st.integers(1, 3))]:
        functions = draw(st.lists(terms(), min_size=1, max_size=3))
        named = {f"t{index}": function for index, function in enumerate(functions)}
        inputs.append(fz.Variable(name, (-3, 3), named))
    order = draw(st.sampled_from([0, 1]))
    rules = int(np.prod([len(v.terms) for v in inputs]))
    size = 1 if order == 0 else len(inputs) + 1
    consequents = draw(st.lists(small, min_size=rules * size, max_size=rules * size))
    return fz.TSK(inputs, consequents, order=order, no_rule_fires="nan")


def shapes_of(system):
    return [[term.shape for term in variable.terms.values()] for variable in system.inputs]


def expected(system, points):
    return [oracle.tsk(shapes_of(system), system.order, system.parameters, x) for x in points]


@given(systems(), st.data())
def test_outputs_follow_the_equations(system, data):
    count = len(system.inputs)
    points = data.draw(st.lists(st.tuples(*[st.floats(-3, 3)] * count), min_size=1, max_size=9))
    outputs = system(np.array(points))
    np.testing.assert_allclose(outputs, expected(system, points), rtol=1e-10, atol=1e-10)


@settings(max_examples=50)
@given(systems(), st.integers(0, 1000))
def test_gradients_follow_the_equations(system, seed):
    # Random points keep away from kinks, where a derivative has two values.
    points = np.random.default_rng(seed).uniform(-3, 3, (5, len(system.inputs)))
    with np.errstate(invalid="ignore"):
        fires = ~np.isnan(expected(system, points))
    gradient = system.gradient(points)
    assert gradient.shape == (5, len(system.parameters))
    for x, row in zip(points[fires], gradient[fires], strict=True):
        exact = oracle.tsk_gradient(shapes_of(system), system.order, system.parameters, x)
        np.testing.assert_allclose(row, exact, rtol=1e-9, atol=1e-9)
        np.testing.assert_array_equal(system.gradient(x), row)
    assert not gradient[~fires].any()


def test_a_hundred_terms_and_nine_inputs_are_no_special_case():
    rng = np.random.default_rng(3)
    wide = fz.TSK(
        [fz.Variable.evenly("x", (-1, 1), [str(i) for i in range(100)])], rng.normal(size=100)
    )
    points = rng.uniform(-1, 1, (20, 1))
    np.testing.assert_allclose(wide(points), expected(wide, points), rtol=1e-12)
    inputs = [fz.Variable.evenly(name, (-1, 1), "NP") for name in "abcdefghi"]
    deep = fz.TSK(inputs, rng.normal(size=(2,) * 9))
    points = rng.uniform(-1, 1, (5, 9))
    np.testing.assert_allclose(deep(points), expected(deep, points), rtol=1e-10, atol=1e-12)
    assert [deep(*x) for x in points.tolist()] == deep(points).tolist()


A, B = 0.5, 1.0
ROWS = np.tile([A, B], (6, 1))


@pytest.mark.parametrize(
    ("inputs", "shape"),
    [
        ((A, B), ()),
        ((np.float64(A), int(B)), ()),
        ((np.float32(A), np.int64(B)), ()),
        ((np.array(A), B), ()),
        (([A, B],), ()),
        ((np.array([A, B]),), ()),
        (([[A, B]] * 3,), (3,)),
        (([A] * 3, B), (3,)),
        ((A, np.full((2, 1), B)), (2, 1)),
        ((np.full((4, 1), A), np.full((1, 5), B)), (4, 5)),
        ((np.asfortranarray(ROWS),), (6,)),
        ((np.tile([A, 9, B, 9], (6, 1))[::2, ::2],), (3,)),
        ((ROWS[::-1],), (6,)),
        ((ROWS.astype("float32"),), (6,)),
        ((ROWS.astype(">f8"),), (6,)),
        ((np.empty((0, 2)),), (0,)),
        (([], B), (0,)),
    ],
)
def test_every_form_of_input_gives_the_same(steer, inputs, shape):
    outputs = steer(*inputs)
    assert np.shape(outputs) == shape
    assert type(outputs) is (np.ndarray if shape else float)
    assert (np.asarray(outputs) == steer(A, B)).all()


def test_integers_and_booleans_are_numbers(steer):
    assert steer(True, 0) == steer(1.0, 0.0)
    points = np.array([[0, 1], [1, -1]])
    np.testing.assert_array_equal(steer(points), steer(points.astype(float)))
    np.testing.assert_array_equal(steer(points > 0), steer((points > 0).astype(float)))


def test_one_input_takes_vectors_and_columns():
    system = fz.TSK([fz.Variable.evenly("x", (0, 1), "ab")], [0, 1])
    assert system([0.5]).shape == system([[0.5]]).shape == (1,)
    assert type(system(0.5)) is float
    assert type(system(np.array(0.5))) is float


def test_results_are_written_into_out(steer):
    points = np.random.default_rng(0).uniform(-1, 1, (50, 2))
    out = np.full(50, np.nan)
    assert steer(points, out=out) is out
    np.testing.assert_array_equal(out, steer(points))
    other = np.empty(50)
    steer(points[:, 0], points[:, 1], out=other)
    np.testing.assert_array_equal(other, out)


def test_consequents_may_be_a_grid_or_flat():
    inputs = [fz.Variable.evenly("x", (0, 1), "ab"), fz.Variable.evenly("y", (0, 1), "cde")]
    grid = np.arange(6.0).reshape(2, 3)
    assert fz.TSK(inputs, grid) == fz.TSK(inputs, grid.ravel().tolist())
    np.testing.assert_array_equal(fz.TSK(inputs, grid).consequents, grid)
    planes = np.arange(18.0).reshape(2, 3, 3)
    np.testing.assert_array_equal(fz.TSK(inputs, planes, order=1).consequents, planes)


def test_parameters_have_names_and_bounds(steer):
    names, bounds = steer.parameter_names, steer.bounds
    assert len(names) == len(set(names)) == len(steer.parameters) == 21
    assert names[:3] == ["angle.N.mean", "angle.N.sigma", "angle.Z.mean"]
    assert names[12:14] == ["rule.N.N.constant", "rule.N.Z.constant"]
    assert bounds.shape == (21, 2)
    assert bounds[:2].tolist() == [[-1.0, 1.0], [0.02, 2.0]]
    assert np.isinf(bounds[12:]).all()


def test_other_parameters_make_another_system(steer):
    before = steer.parameters
    moved = before.copy()
    moved[[0, 20]] = [-0.8, 0.7]
    other = steer.with_parameters(moved)
    np.testing.assert_array_equal(other.parameters, moved)
    np.testing.assert_array_equal(steer.parameters, before)
    assert other.inputs[0].terms["N"].parameters["mean"] == -0.8
    assert other.consequents[2, 2] == 0.7
    assert (other.name, other.output) == ("steer", "steering")
    assert other != steer == other.with_parameters(before)


def test_what_is_handed_out_is_a_copy(steer):
    for array in [steer.parameters, steer.consequents, steer.bounds]:
        array[...] = 99.0
    assert 99.0 not in steer.parameters
    assert 99.0 not in steer.bounds


def test_where_no_rule_fires_the_choice_decides(gap):
    text = gap.to_json()
    assert gap.no_rule_fires == "error"
    with pytest.raises(fz.errors.NoRuleFiresError, match=r'no rule of "gap" fires at \[5.0\]'):
        gap(5.0)
    with pytest.raises(fz.errors.NoRuleFiresError, match=r"at point 2 \[4.0\]"):
        gap([1.0, 1.5, 4.0])
    with pytest.raises(fz.errors.NoRuleFiresError):
        gap.gradient([5.0])
    nan = fz.TSK(gap.inputs, [3], no_rule_fires="nan")
    assert np.isnan(nan(5.0))
    assert nan([1.0, 5.0])[0] == 3.0
    seven = fz.TSK(gap.inputs, [3], no_rule_fires=7)
    assert (seven.no_rule_fires, seven(5.0)) == (7.0, 7.0)
    assert not seven.gradient([5.0]).any()
    assert gap.to_json() == text


def test_the_representation_tells_what_it_is(steer):
    assert repr(steer) == (
        '<TSK "steer": angle [N Z P], rate [N Z P] -> steering, 9 rules of order 0>'
    )


def test_systems_are_compared_by_everything_they_are(steer):
    inputs, consequents = steer.inputs, steer.consequents
    same = fz.TSK(inputs, consequents, name="steer", output="steering")
    assert same == steer
    assert steer != "steer"
    for other in [
        fz.TSK(inputs, consequents, name="other", output="steering"),
        fz.TSK(inputs, consequents, name="steer", output="other"),
        fz.TSK(inputs, consequents + 1, name="steer", output="steering"),
        fz.TSK(inputs, consequents, name="steer", output="steering", no_rule_fires="nan"),
    ]:
        assert other != steer


@settings(max_examples=30)
@given(systems())
def test_json_keeps_every_bit(system):
    again = fz.TSK.from_json(system.to_json())
    assert again == system
    assert again.parameters.tobytes() == system.parameters.tobytes()
    assert again.to_json() == system.to_json()


def test_a_saved_system_is_loaded_again(tmp_path, steer, gap):
    for system, path in itertools.product([steer, gap], [tmp_path / "s.json", str(tmp_path / "t")]):
        system.save(path)
        assert fz.load(path) == system
    assert sorted(path.name for path in tmp_path.iterdir()) == ["s.json", "t"]
