"""Membership functions from any function of the user's."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fuzzyrs._fuzzyrs import MembershipFunction, points
from fuzzyrs.errors import from_kind

__all__ = ["sampled"]

_Floats = NDArray[np.float64]


def sampled(
    function: Callable[[Any], Any], universe: tuple[float, float], samples: int = 1001
) -> MembershipFunction:
    """Make a membership function of any function, by straight lines between samples of it.

    Parameters
    ----------
    function : callable
        Takes an array of numbers, or else a single number, and returns degrees from 0 to 1.
    universe : (float, float)
        The interval to sample; outside, the degrees at its ends hold.
    samples : int, optional
        The number of evenly spaced samples, 2 at least.

    Returns
    -------
    MembershipFunction
        Of the shape "points".

    Examples
    --------
    >>> import fuzzyrs as fz
    >>> near = fz.sampled(lambda x: 1 / (1 + x * x), (-4, 4), samples=9)
    >>> near(1)
    0.5
    """
    if samples < 2:
        raise from_kind("out_of_range", f"samples must be at least 2, got {samples}")
    low, high = (float(end) for end in universe)
    if not (np.isfinite([low, high, high - low]).all() and low < high):
        message = f"the universe must be two finite numbers that increase, got ({low}, {high})"
        raise from_kind("out_of_range", message)
    x = np.linspace(low, high, samples)
    degrees = _degrees(function, x)
    wrong = ~((degrees >= 0) & (degrees <= 1))
    if wrong.any():
        index = int(np.argmax(wrong))
        message = f"degrees must be between 0 and 1, got {degrees[index]} at {x[index]}"
        raise from_kind("out_of_range", message)
    return points(np.column_stack([x, degrees]))


def _degrees(function: Callable[[Any], Any], x: _Floats) -> _Floats:
    """Call a function once with all numbers or, if it does not take an array, with each."""
    try:
        degrees = np.asarray(function(x.copy()))
    except (TypeError, ValueError):
        degrees = None
    if degrees is None or degrees.shape == ():
        results = [function(value) for value in x.tolist()]
        try:
            degrees = np.array(results)
        except ValueError as error:
            raise from_kind("wrong_shape", f"each degree must be a number: {error}") from error
    if degrees.shape != x.shape:
        message = f"degrees: expected shape {x.shape}, got shape {degrees.shape}"
        raise from_kind("wrong_shape", message)
    if degrees.dtype.kind not in "biuf":
        message = f"degrees must be real numbers, got dtype {degrees.dtype}"
        raise from_kind("wrong_type", message)
    return degrees.astype(float)
