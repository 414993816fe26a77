"""Whether a sample fits an expectation, allowing for chance.

Expectations are about many seeds ("95 % of the seeds", "a mean between"). A sample of twenty may
miss them by chance, so it is rejected only where chance would do so in one of twenty samples.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence

#: How often chance alone may reject what is true.
LEVEL = 0.05


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


def overlap(interval: tuple[float, float], low: float, high: float) -> bool:
    """Tell whether an interval has a value from `low` to `high`."""
    return interval[0] <= high and interval[1] >= low
