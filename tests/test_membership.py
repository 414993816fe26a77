"""Membership functions and variables."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import fuzzyrs as fz
import oracle

MAKERS = {
    "gaussian": fz.gaussian,
    "gaussian_width": fz.gaussian_width,
    "triangular": fz.triangular,
    "trapezoidal": fz.trapezoidal,
}
numbers = st.floats(-100, 100)


@st.composite
def functions(draw):
    """Draw a shape and valid parameters; sides are vertical or have a slope below 10^6."""
    shape = draw(st.sampled_from(sorted(MAKERS)))
    first = draw(numbers)
    if shape.startswith("gaussian"):
        return shape, [first, draw(st.floats(1e-3, 100))]
    sides = st.just(0.0) | st.floats(1e-6, 50)
    gaps = draw(st.lists(sides, min_size=2, max_size=3))
    gaps = gaps if any(gaps) else [1.0, *gaps[1:]]
    vertices = [first, *(first + np.cumsum(gaps)).tolist()]
    return ("triangular" if len(vertices) == 3 else "trapezoidal"), vertices


@given(functions(), numbers)
def test_degrees_follow_the_equations(function, x):
    shape, parameters = function
    degree = MAKERS[shape](*parameters)(x)
    assert degree == pytest.approx(oracle.SHAPES[shape](x, *parameters), rel=1e-12, abs=1e-300)
    assert 0.0 <= degree <= 1.0


@pytest.mark.parametrize("shape", ["gaussian", "gaussian_width"])
def test_gaussians_are_accurate_to_a_few_units_in_the_last_place(shape):
    x = np.linspace(-6, 6, 10_001)
    expected = oracle.SHAPES[shape](x, 0.25, 0.7)
    np.testing.assert_allclose(MAKERS[shape](0.25, 0.7)(x), expected, rtol=1e-13)


@given(functions(), st.lists(numbers, max_size=30))
def test_arrays_and_single_numbers_agree_to_the_bit(function, points):
    shape, parameters = function
    degree = MAKERS[shape](*parameters)
    assert degree(points).tolist() == [degree(x) for x in points]


@pytest.mark.parametrize("number", [17.5, np.float64(17.5), np.float32(17.5), np.array(17.5)])
def test_a_single_number_gave_an_array_of_one(number):
    warm = fz.triangular(15, 20, 25)
    assert warm(number) == 0.5
    assert type(warm(number)) is float
    assert warm([17.5]).shape == (1,)
    assert fz.Variable("t", (0, 30), {"warm": warm}).degrees(number).shape == (1,)


def test_vertical_sides_belong_to_the_support():
    assert fz.triangular(0, 0, 1)([-1e-9, 0, 0.25, 1]).tolist() == [0, 1, 0.75, 0]
    assert fz.trapezoidal(0, 0, 2, 2)([-0.1, 0, 1, 2, 2.1]).tolist() == [0, 1, 1, 1, 0]


@pytest.mark.parametrize(("shape", "maker"), MAKERS.items())
def test_what_a_function_is_made_of_can_be_read(shape, maker):
    names = {
        "gaussian": ["mean", "sigma"],
        "gaussian_width": ["mean", "width"],
        "triangular": ["a", "b", "c"],
        "trapezoidal": ["a", "b", "c", "d"],
    }[shape]
    parameters = [float(i) for i in range(1, len(names) + 1)]
    function = maker(*parameters)
    assert function.shape == shape
    assert function.parameters == dict(zip(names, parameters, strict=True))
    assert list(function.parameters) == names
    assert function == fz.MembershipFunction(shape, parameters)
    assert function != maker(*[p + 1 for p in parameters])
    assert eval(repr(function), vars(fz)) == function


def test_a_not_a_number_has_no_degree():
    for function in [fz.gaussian(0, 1), fz.triangular(0, 1, 2)]:
        assert np.isnan(function(np.nan))
        assert function([-np.inf, np.inf]).tolist() == [0.0, 0.0]


def test_degrees_have_the_terms_as_their_last_axis():
    variable = fz.Variable.evenly("x", (0, 1), ["low", "high"], shape="triangular")
    assert variable.degrees(0.25).tolist() == [0.75, 0.25]
    degrees = variable.degrees([[0.0, 0.5, 1.0], [0.25, 0.75, 2.0]])
    assert degrees.shape == (2, 3, 2)
    assert degrees[1].tolist() == [[0.75, 0.25], [0.25, 0.75], [0.0, 0.0]]
    assert variable.degrees([]).shape == (0, 2)


@given(st.sampled_from(sorted(MAKERS)), st.integers(2, 7), numbers, st.floats(0.1, 100))
def test_even_partitions_cross_at_one_half(shape, count, low, size):
    names = [f"t{i}" for i in range(count)]
    variable = fz.Variable.evenly("x", (low, low + size), names, shape=shape)
    peaks = np.linspace(low, low + size, count)
    between = (peaks[1:] + peaks[:-1]) / 2
    degrees = variable.degrees(between)
    for index in range(count - 1):
        np.testing.assert_allclose(degrees[index, index : index + 2], 0.5, rtol=1e-9)
    np.testing.assert_allclose(np.diag(variable.degrees(peaks)), 1.0, rtol=1e-9)


def test_variables_know_their_terms_in_order():
    terms = {"z": fz.gaussian(0, 1), "a": fz.triangular(0, 1, 2)}
    variable = fz.Variable("x", [-1, 1], terms)
    assert (variable.name, variable.universe) == ("x", (-1.0, 1.0))
    assert list(variable.terms) == ["z", "a"]
    assert variable.terms["a"] == terms["a"]
    assert variable == fz.Variable("x", (-1, 1), terms)
    assert variable != fz.Variable("x", (-1, 1), dict(reversed(terms.items())))
    assert repr(variable).startswith('Variable("x", (-1.0, 1.0), {"z": gaussian(0.0, 1.0), "a"')
