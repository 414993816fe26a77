"""Whether a sample fits an expectation, allowing for chance.

Expectations are about many seeds ("95 % of the seeds", "a mean between"). A sample of twenty may
miss them by chance, so it is rejected only where chance would do so in one of twenty samples.
"""

from __future__ import annotations

import math
import random
import statistics
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

#: How often chance alone may reject what is true.
LEVEL = 0.05

#: Decimal fractions that are equal may differ by this in the computer.
ROUNDING = 1e-9


def at_most(successes: int, trials: int, chance: float) -> float:
    """Return the probability of that many successes or fewer, each having this chance.

    The chance lies between 0 and 1, both excluded. Logarithms keep large samples in range.
    """
    ways = math.lgamma(trials + 1)
    return math.fsum(
        math.exp(
            ways
            - math.lgamma(k + 1)
            - math.lgamma(trials - k + 1)
            + k * math.log(chance)
            + (trials - k) * math.log1p(-chance)
        )
        for k in range(successes + 1)
    )


def share_fits(successes: int, trials: int, *, least: float) -> bool:
    """Tell whether so many successes fit a share of `least` or more."""
    return at_most(successes, trials, least) >= LEVEL


def rarity_fits(events: int, trials: int, *, most: float) -> bool:
    """Tell whether so many events fit a share of `most` or less."""
    return share_fits(trials - events, trials, least=1 - most)


def mean_interval(values: Sequence[float]) -> tuple[float, float]:
    """Return the 95 % interval of a mean: two standard errors to both sides."""
    mean = statistics.fmean(values)
    error = statistics.stdev(values) / math.sqrt(len(values)) if len(values) > 1 else math.inf
    return mean - 2 * error, mean + 2 * error


def median_interval(values: Sequence[float]) -> tuple[float, float]:
    """Return the 95 % interval of a median, between two values of the sample; infinite if few."""
    ordered = sorted(values)
    count = len(ordered)
    outside = 0
    while outside < count // 2 and at_most(outside, count, 0.5) <= LEVEL / 2:
        outside += 1
    if outside == 0:
        return -math.inf, math.inf
    return ordered[outside - 1], ordered[count - outside]


#: How often a sample is drawn anew from itself.
RESAMPLES = 2000


def interquartile_mean(values: Sequence[float]) -> float:
    """Return the mean of the middle half; infinite if an infinite value is part of it.

    A value on the edge of the middle half counts in part, so that every sample has one. With both
    infinities in it there is no mean, but NaN.
    """
    return float(_weighted(_middle_half(np.arange(1, len(values) + 1)[None, :]), values)[0])


def interquartile_mean_interval(values: Sequence[float]) -> tuple[float, float]:
    """Return the 95 % bootstrap interval of the interquartile mean (percentiles of resamples).

    The same resamples are drawn for every sample of a size.
    """
    means = _weighted(_resampled_weights(len(values)), values)
    # Where a resample has no mean, it may lie beyond either end.
    unknown = np.isnan(means)
    low = _quantile(np.where(unknown, -math.inf, means), LEVEL / 2)
    high = _quantile(np.where(unknown, math.inf, means), 1 - LEVEL / 2)
    return low, high


def _quantile(values: np.ndarray[Any, Any], share: float) -> float:
    """Return the least value that has this share of the values up to it; they may be infinite."""
    return float(np.sort(values)[math.ceil(share * len(values)) - 1])


def _weighted(weights: np.ndarray[Any, Any], values: Sequence[float]) -> np.ndarray[Any, Any]:
    """Return the sums of the values in rising order, each with its weight; NaN for inf - inf."""
    ordered = np.sort(np.asarray(values, dtype=float))
    first = int((ordered == -math.inf).sum())
    end = first + int(np.isfinite(ordered).sum())
    sums: np.ndarray[Any, Any] = weights[:, first:end] @ ordered[first:end]
    below, above = weights[:, :first].any(axis=1), weights[:, end:].any(axis=1)
    sums[below], sums[above], sums[below & above] = -math.inf, math.inf, math.nan
    return sums


def _middle_half(counted: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return what each value weighs in the mean of the middle half.

    Row by row, `counted` is how many values a sample has up to each place in their order.
    """
    size = counted.shape[1]
    inside = np.clip(counted, size / 4, 3 * size / 4)
    shares: np.ndarray[Any, Any] = np.diff(inside, axis=1, prepend=size / 4) / (size / 2)
    return shares


@lru_cache(maxsize=8)
def _resampled_weights(size: int) -> np.ndarray[Any, Any]:
    """Return what the values of a sample weigh in the middle half of each resample.

    A resample is known by how often it has the value of each rank, so the weights are the same
    for all samples of a size.
    """
    # Python promises that these numbers stay the same; NumPy's generators may change.
    drawn = random.Random(size).choices(range(size), k=RESAMPLES * size)
    places = np.repeat(np.arange(RESAMPLES), size) * size + np.array(drawn)
    often = np.bincount(places, minlength=RESAMPLES * size).reshape(RESAMPLES, size)
    return _middle_half(np.cumsum(often, axis=1))


def overlap(interval: tuple[float, float], low: float, high: float) -> bool:
    """Tell whether an interval has a value from `low` to `high`."""
    return interval[0] <= high and interval[1] >= low


def share_interval(successes: int, trials: int) -> tuple[float, float]:
    """Return the exact 95 % interval of a share (Clopper and Pearson)."""
    low = _chance(successes - 1, trials, 1 - LEVEL / 2) if successes else 0.0
    high = _chance(successes, trials, LEVEL / 2) if successes < trials else 1.0
    return low, high


def _chance(successes: int, trials: int, probability: float) -> float:
    """Return the chance with which `at_most` is this probability; it falls as the chance rises."""
    low, high = 0.0, 1.0
    for _ in range(50):
        middle = (low + high) / 2
        if at_most(successes, trials, middle) > probability:
            low = middle
        else:
            high = middle
    return (low + high) / 2


#: A ranking between techniques takes at least this many seeds.
FEWEST_PAIRS = 20


@dataclass(frozen=True)
class Paired:
    """Two techniques on the same seeds: whose value is smaller.

    Attributes
    ----------
    smaller, larger, equal : int
        On how many seeds the first one's value is smaller, larger, and the same.
    share : (float, float)
        The 95 % interval of the share of `smaller` among the pairs that differ.
    difference : float
        The median of first minus second; infinite where the usual pair has an infinite value.
    interval : (float, float)
        Its 95 % interval.
    """

    smaller: int
    larger: int
    equal: int
    share: tuple[float, float]
    difference: float
    interval: tuple[float, float]

    @property
    def count(self) -> int:
        """How many seeds were compared."""
        return self.smaller + self.larger + self.equal

    @property
    def decision(self) -> str:
        """Return "smaller" or "larger" if the share's interval leaves out one half.

        It is "undecided" otherwise, and on fewer than 20 seeds.
        """
        if self.count >= FEWEST_PAIRS:
            if self.share[0] > 0.5:
                return "smaller"
            if self.share[1] < 0.5:
                return "larger"
        return "undecided"

    def __str__(self) -> str:
        ties = f", {self.equal} ties" if self.equal else ""
        low, high = self.interval
        return (
            f"less on {self.smaller}, more on {self.larger} seeds{ties} (share of less "
            f"{self.share[0]:.0%}-{self.share[1]:.0%}); differ by {self.difference:+.2f} "
            f"[{low:+.2f}, {high:+.2f}] in the median"
        )


def paired(first: Sequence[float], second: Sequence[float]) -> Paired:
    """Compare two techniques by their values on the same seeds; an escape is infinite.

    Two infinite values of the same sign are equal. Ranks decide, not sizes: one bad seed doesn't.
    """
    differences = [
        0.0 if a == b else a - b  # of equal infinities, too
        for a, b in zip(first, second, strict=True)
    ]
    smaller = sum(d < -ROUNDING for d in differences)
    larger = sum(d > ROUNDING for d in differences)
    low, high = median_interval(differences)
    return Paired(
        smaller=smaller,
        larger=larger,
        equal=len(differences) - smaller - larger,
        share=share_interval(smaller, smaller + larger),
        difference=_middle(differences),
        interval=(low, high),
    )


def _middle(values: Sequence[float]) -> float:
    """Return the median; of an even number the finite one in the middle if the other is not."""
    low, high = statistics.median_low(values), statistics.median_high(values)
    if math.isinf(low) and math.isinf(high):
        return low if low == high else math.nan
    return low if math.isinf(high) else high if math.isinf(low) else (low + high) / 2
