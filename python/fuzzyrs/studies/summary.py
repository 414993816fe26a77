"""What came out at each point of a study, over its seeds."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fuzzyrs.experiments.statistics import interquartile_mean, interquartile_mean_interval
from fuzzyrs.studies.store import Point


@dataclass(frozen=True)
class Summary:
    """A measure at a point of the grid, over the seeds.

    Attributes
    ----------
    point : dict
        The place in the grid.
    measure : str
        Which outcome.
    count, missing : int
        How many runs have a number, and how many have none: those count nowhere else.
    median, interquartile_mean : float or None
        Of the numbers; None if there are none, or both infinities are in the middle.
    interval : (float, float) or None
        The 95 % bootstrap interval of the interquartile mean.
    """

    point: Point
    measure: str
    count: int
    missing: int
    median: float | None
    interquartile_mean: float | None
    interval: tuple[float, float] | None

    def to_dict(self) -> dict[str, Any]:
        """Return the summary as plain values."""
        return {
            "point": self.point,
            "measure": self.measure,
            "count": self.count,
            "missing": self.missing,
            "median": self.median,
            "interquartile_mean": self.interquartile_mean,
            "interval": None if self.interval is None else list(self.interval),
        }


def summarise(points: Sequence[Point], columns: dict[str, np.ndarray[Any, Any]]) -> list[Summary]:
    """Return a summary of each column of numbers at each point.

    Parameters
    ----------
    points : sequence of dict
        The point of each run.
    columns : dict of numpy.ndarray
        The outcomes, a value for each run. Columns without any number are left out.
    """
    places: dict[tuple[Any, ...], list[int]] = {}
    for place, point in enumerate(points):
        places.setdefault(tuple(map(repr, point.values())), []).append(place)
    columns_of_numbers = {name: numbers(column) for name, column in columns.items()}
    return [
        _summary(points[runs[0]], name, values[runs])
        for runs in places.values()
        for name, values in columns_of_numbers.items()
        if not np.isnan(values).all()
    ]


def numbers(column: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return a column as floats, NaN where there is no number; True and False are 1 and 0."""
    kinds = (bool, int, float)
    return np.array([x if isinstance(x, kinds) else np.nan for x in column.tolist()], dtype=float)


def _summary(point: Point, measure: str, values: np.ndarray[Any, Any]) -> Summary:
    there = values[~np.isnan(values)].tolist()
    if not there:
        return Summary(point, measure, 0, len(values), None, None, None)
    return Summary(
        point=point,
        measure=measure,
        count=len(there),
        missing=len(values) - len(there),
        median=_defined(statistics.median(there)),
        interquartile_mean=_defined(interquartile_mean(there)),
        interval=interquartile_mean_interval(there),
    )


def _defined(value: float) -> float | None:
    return None if math.isnan(value) else value
