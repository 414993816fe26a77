"""Two points of a study, compared seed by seed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from fuzzyrs.errors import from_kind
from fuzzyrs.experiments.statistics import Paired, paired
from fuzzyrs.studies.definition import scalar
from fuzzyrs.studies.settings import unknown
from fuzzyrs.studies.store import Point, point_key

#: So many points are named where there is none that was asked for.
SHOWN_POINTS = 5


def compare(
    points: Sequence[Point],
    seeds: Sequence[int],
    values: Sequence[float],
    first: Mapping[str, Any],
    second: Mapping[str, Any],
) -> Paired:
    """Compare the values of the seeds that have a number at both points.

    Parameters
    ----------
    points, seeds, values : sequence
        Where each run is in the grid, its seed, and what came out: NaN if no number.
    first, second : dict
        What tells each of the two points from all others.
    """
    one, other = (_found(points, wanted) for wanted in (first, second))
    if one == other:
        message = f"{dict(first)} and {dict(second)} are the same point; name two"
        raise from_kind("unsuitable", message)
    sides: dict[str, dict[int, float]] = {one: {}, other: {}}
    for point, seed, value in zip(points, seeds, values, strict=True):
        if (key := point_key(point)) in sides and not math.isnan(value):
            sides[key][seed] = value
    common = [seed for seed in sides[one] if seed in sides[other]]
    if not common:
        message = (
            f"no seed has a number at both points: {len(sides[one])} have one at {dict(first)}, "
            f"{len(sides[other])} others at {dict(second)}"
        )
        raise from_kind("unsuitable", message)
    return paired(*([side[seed] for seed in common] for side in sides.values()))


def _found(points: Sequence[Point], wanted: Mapping[str, Any]) -> str:
    """Return the key of the one point that has these values."""
    if not isinstance(wanted, Mapping):
        message = f"a point must be a dictionary of parameters, got {wanted!r}"
        raise from_kind("wrong_type", message)
    plain = {name: scalar(f"the point's {name!r}", value) for name, value in wanted.items()}
    there = {point_key(point): point for point in points}
    parameters = list(next(iter(there.values()), {}))
    for name in plain:
        if name not in parameters:
            raise unknown("parameter", name, parameters)
    fitting = [
        key
        for key, point in there.items()
        if all(_same(point[name], value) for name, value in plain.items())
    ]
    if not fitting:
        some = [str(point) for point in there.values()]
        more = ["..."] if len(some) > SHOWN_POINTS else []
        known = ", ".join(some[:SHOWN_POINTS] + more) or "none"
        raise from_kind("unknown_name", f"no run is at {plain}; there are runs at {known}")
    if len(fitting) > 1:
        left_out = ", ".join(repr(name) for name in parameters if name not in plain)
        message = f"{plain} is not one point but {len(fitting)}; name {left_out or 'another'} too"
        raise from_kind("unsuitable", message)
    return fitting[0]


def _same(value: Any, wanted: Any) -> bool:
    """Tell whether values are equal: 1 and 1.0 are, 1 and True are not, and NaN is NaN."""
    booleans = isinstance(value, bool) + isinstance(wanted, bool)
    return repr(value) == repr(wanted) or (booleans != 1 and bool(value == wanted))
