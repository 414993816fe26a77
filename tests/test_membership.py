"""Membership functions and variables."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fuzzyrs as fz
import oracle
from shapes import AROUND, functions, places

EVEN = [
    "gaussian",
    "gaussian_width",
    "two_sided_gaussian",
    "bell",
    "pi_shape",
    "triangular",
    "trapezoidal",
    "cosine",
    "semi_ellipse",
    "spike",
]
NAMES = {
    "gaussian": ["mean", "sigma"],
    "gaussian_width": ["mean", "width"],
    "two_sided_gaussian": ["left_mean", "left_sigma", "right_mean", "right_sigma"],
    "bell": ["centre", "width", "slope"],
    "sigmoid": ["centre", "slope"],
    "sigmoid_difference": ["left_centre", "left_slope", "right_centre", "right_slope"],
    "sigmoid_product": ["left_centre", "left_slope", "right_centre", "right_slope"],
    "s_shape": ["a", "b"],
    "z_shape": ["a", "b"],
    "pi_shape": ["a", "b", "c", "d"],
    "triangular": ["a", "b", "c"],
    "trapezoidal": ["a", "b", "c", "d"],
    "ramp": ["start", "end"],
    "rectangle": ["a", "b"],
    "singleton": ["x"],
    "step": ["at", "direction"],
    "concave": ["inflection", "end"],
    "cosine": ["centre", "width"],
    "semi_ellipse": ["a", "b"],
    "arc": ["start", "end"],
    "spike": ["centre", "width"],
    "points": ["x0", "y0", "x1", "y1", "x2", "y2"],
}
# What the equation loses to cancellation where the library does not.
CANCELLED = {"cosine": 1e-15, "sigmoid_difference": 1e-15, "points": 1e-15}


def make(shape, parameters):
    """Call the function of the shape's name."""
    if shape == "points":
        return fz.points(np.reshape(parameters, (-1, 2)))
    return getattr(fz, shape)(*parameters)


@settings(max_examples=1000)
@given(functions(), places)
def test_degrees_follow_the_equations(function, x):
    shape, parameters = function
    degree = make(shape, parameters)(x)
    expected = oracle.SHAPES[shape](x, *parameters)
    assert degree == pytest.approx(expected, rel=1e-12, abs=CANCELLED.get(shape, 1e-300))
    assert 0.0 <= degree <= 1.0


@given(functions(), st.data())
def test_degrees_follow_the_equations_at_the_parameters(function, data):
    shape, parameters = function
    x = data.draw(st.sampled_from(parameters))
    expected = oracle.SHAPES[shape](x, *parameters)
    assert make(shape, parameters)(x) == pytest.approx(expected, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize("shape", ["gaussian", "gaussian_width"])
def test_gaussians_are_accurate_to_a_few_units_in_the_last_place(shape):
    x = np.linspace(-6, 6, 10_001)
    expected = oracle.SHAPES[shape](x, 0.25, 0.7)
    np.testing.assert_allclose(make(shape, [0.25, 0.7])(x), expected, rtol=1e-13)


@pytest.mark.parametrize("shape", NAMES)
def test_derivatives_follow_the_equations(shape):
    # Random points keep away from kinks, where a derivative has two values.
    points = np.random.default_rng(5).uniform(-2, 2.5, 200)
    parameters = AROUND[shape](0.3, 0.9)
    function = make(shape, parameters)
    step = 1e-100j
    for index, column in enumerate(function.gradient(points).T):
        moved = [p + step * (k == index) for k, p in enumerate(parameters)]
        exact = [np.imag(oracle.SHAPES[shape](x, *moved)) / 1e-100 for x in points]
        np.testing.assert_allclose(column, exact, rtol=1e-10, atol=1e-12)
    h = 1e-6
    differences = (function(points + h) - function(points - h)) / (2 * h)
    np.testing.assert_allclose(function.slope(points), differences, rtol=1e-6, atol=1e-6)


def test_derivatives_have_the_shape_of_their_points():
    bell = fz.bell(0, 1, 2)
    x = np.linspace(-2, 2, 6).reshape(2, 3)
    assert bell.gradient(x).shape == (2, 3, 3)
    assert bell.gradient(0.5).shape == (3,)
    assert bell.gradient([]).shape == (0, 3)
    assert bell.slope(x).shape == (2, 3)
    assert type(bell.slope(0.5)) is float
    np.testing.assert_array_equal(bell.gradient(x)[1, 2], bell.gradient(x[1, 2]))
    assert np.isnan(bell.gradient(np.nan)).all()
    assert np.isnan(bell.slope(np.nan))


@given(functions(), st.tuples(places, st.floats(0.5, 200)))
def test_support_and_core_are_what_sampling_finds(function, place):
    shape, parameters = function
    universe = (place[0], place[0] + place[1])
    function = make(shape, parameters)
    x = np.unique([*np.linspace(*universe, 401), *np.clip(parameters, *universe)])
    degrees = function(x)
    support, core = function.support(universe), function.core(universe)
    inside = np.zeros(x.shape, bool) if support is None else (support[0] <= x) & (x <= support[1])
    assert not degrees[~inside].any()
    if core is not None:
        assert support[0] <= core[0] <= core[1] <= support[1]
        assert function(core) == pytest.approx([1, 1], rel=1e-15)
        assert function.centre(universe) == pytest.approx((core[0] + core[1]) / 2, rel=1e-12)
    assert universe[0] <= function.centre(universe) <= universe[1]


def test_support_core_and_centre_by_hand():
    universe = (-10, 10)
    trapezoid = fz.trapezoidal(0, 1, 3, 5)
    assert trapezoid.support(universe) == (0, 5)
    assert trapezoid.core(universe) == (1, 3)
    assert trapezoid.centre(universe) == 2
    assert trapezoid.core((2, 10)) == (2, 3)
    assert trapezoid.support((5, 6)) is trapezoid.core((4, 6)) is None
    assert trapezoid.centre((4, 6)) == 4
    ramp = fz.ramp(4, 0)
    assert (ramp.support(universe), ramp.core(universe)) == ((-10, 4), (-10, 0))
    assert ramp.centre(universe) == -5
    rising = fz.sigmoid(1, 2)
    assert (rising.support(universe), rising.core(universe)) == (universe, None)
    assert (rising.centre(universe), fz.sigmoid(1, -2).centre(universe)) == (10, -10)
    assert fz.sigmoid_product(-1, 5, 3, -5).centre(universe) == 1
    crossed = fz.two_sided_gaussian(2, 1, 0, 2)
    assert crossed.core(universe) is None
    assert crossed.slope(crossed.centre(universe)) == pytest.approx(0, abs=1e-15)
    peaks = fz.points([(0, 0), (1, 0.5), (2, 0), (3, 0), (4, 0.5), (6, 0)])
    assert peaks.support(universe) == (0, 6)
    assert peaks.support((2, 3)) is peaks.core(universe) is None
    assert peaks.centre(universe) == 2.5
    assert fz.sigmoid_difference(1, 2, 1, 2).support(universe) is None


def test_vertices_are_the_corners():
    assert fz.triangular(0, 0, 2).vertices.tolist() == [[0, 0], [0, 1], [2, 0]]
    assert fz.ramp(4, 0).vertices.tolist() == [[0, 1], [4, 0]]
    assert fz.rectangle(1, 2).vertices.tolist() == [[1, 0], [1, 1], [2, 1], [2, 0]]
    pairs = [[0, 0.25], [1, 1], [3, 0.5]]
    assert fz.points(pairs).vertices.tolist() == pairs
    trapezoid = fz.trapezoidal(0, 1, 3, 5)
    x = np.linspace(-1, 6, 101)
    np.testing.assert_allclose(trapezoid(x), fz.points(trapezoid.vertices)(x), atol=1e-15)
    assert fz.gaussian(0, 1).vertices is None


@pytest.mark.parametrize(
    "function",
    [
        lambda x: np.exp(-np.abs(x)),
        lambda x: math.exp(-abs(x)),
        lambda x: math.exp(x) if x < 0 else math.exp(-x),
        lambda x: [math.exp(-abs(value)) for value in x],
    ],
    ids=["array", "number", "branches", "list"],
)
def test_any_function_can_be_sampled(function):
    peak = fz.sampled(function, (-2, 4), samples=61)
    assert peak.shape == "points"
    x = np.linspace(-2, 4, 61)
    np.testing.assert_allclose(peak(x), np.exp(-np.abs(x)), rtol=1e-12)
    assert peak(0.05) == pytest.approx((1 + math.exp(-0.1)) / 2)
    assert peak([-100, 100]).tolist() == peak([-2, 4]).tolist()
    assert fz.sampled(lambda x: 0.5, (0, 1))([-1, 0.3]).tolist() == [0.5, 0.5]  # noqa: ARG005


def test_what_a_sampled_function_raises_is_not_hidden():
    def broken(x):
        raise ValueError(f"my own words about {x}")

    with pytest.raises(ValueError, match=r"my own words about 0\.0"):
        fz.sampled(broken, (0, 1))


@given(functions(), st.lists(places | st.just(math.nan), max_size=30))
def test_arrays_and_single_numbers_agree_to_the_bit(function, points):
    degree = make(*function)
    assert degree(points).tobytes() == np.array([degree(x) for x in points]).tobytes()
    slopes = np.array([degree.slope(x) for x in points])
    assert degree.slope(points).tobytes() == slopes.tobytes()


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


@pytest.mark.parametrize(("shape", "names"), NAMES.items())
def test_what_a_function_is_made_of_can_be_read(shape, names):
    parameters = AROUND[shape](0.25, 0.5)
    function = make(shape, parameters)
    assert function.shape == shape
    assert function.parameters == dict(zip(names, parameters, strict=True))
    assert list(function.parameters) == names
    assert function == fz.MembershipFunction(shape, parameters)
    assert function != make(shape, AROUND[shape](0.75, 0.5))
    assert eval(repr(function), vars(fz)) == function


def test_every_shape_has_its_oracle():
    with pytest.raises(fz.errors.UnknownNameError) as caught:
        fz.MembershipFunction("?", [])
    known = str(caught.value).split("known: ")[1].split(", ")
    assert set(known) == set(NAMES) == set(oracle.SHAPES)


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


@given(st.sampled_from(EVEN), st.integers(2, 7), places, st.floats(0.1, 100))
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
