"""Verdicts: whether what came out supports what was printed.

The expectations come from acceptance bands that were fixed before; a sample is compared with
them allowing for chance.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from fuzzyrs.experiments.result import Row, Value, infinite, total
from fuzzyrs.experiments.statistics import (
    FEWEST_PAIRS,
    ROUNDING,
    mean_interval,
    median_interval,
    overlap,
    paired,
    rarity_fits,
    share_fits,
)

REPRODUCED = "reproduced"
CLOSE = "close"
DIFFERS = "differs"
UNCHECKED = "can't be checked"
#: From best to worst, then none.
VERDICTS = (REPRODUCED, CLOSE, DIFFERS, UNCHECKED)

#: What counts as borne out where techniques are ranked.
RANKED = "smaller on more than half of the seeds, by the 95 % interval of the share"

#: Below this, a run is a first look and gets no verdict on what chance has a hand in.
FEWEST_SEEDS = 10


def judge_exact(row: Row) -> Row:
    """Judge a row without chance: every seed must give the printed values."""
    same = all(times == row.published for times in row.per_seed)
    reason = "equal in every cell" if same else "no chance is involved, so every cell must be equal"
    return replace(row, verdict=REPRODUCED if same else DIFFERS, reason=reason)


def judge_means(row: Row, bands: Sequence[tuple[float, float]], missing: float) -> Row:
    """Judge a row whose expectation is a band for each cell's mean.

    Expected besides: no value in at most a share `missing` of the seeds.
    """
    count = len(row.per_seed)
    fits = []
    for index, (low, high) in enumerate(bands):
        there = [value for value in row.column(index) if not math.isinf(value)]
        rare = rarity_fits(row.missing(index), count, most=missing)
        fits.append(rare and bool(there) and overlap(mean_interval(there), low, high))
    means = " ".join("none" if mean is None else f"{mean:.1f}" for mean in row.mean)
    expected = told(bands)
    escapes = " ".join(str(row.missing(index)) for index in range(len(bands)))
    reason = (
        f"means {means}, expected {expected}; without value {escapes} of {count}, "
        f"expected {missing:.0%} at most"
    )
    return _judged(row, all(fits), reason)


def told(bands: Sequence[tuple[float, float]]) -> str:
    """Return bands in words."""
    return ", ".join(f"{low:g}-{high:g}" for low, high in bands)


def judge_near(
    row: Row,
    reference: Row,
    margin: float,
    medians: Sequence[float],
    within: float,
    better: tuple[Row, float],
) -> Row:
    """Judge a row that is expected near a reference, such as the classical strategy.

    Expected: 95 % of the seeds at most `margin` above the reference in all cells; the median of
    each cell no further than `within` from `medians`; and a smaller sum of the cells than another
    row's on a share of the seeds, `better`.
    """
    count = len(row.per_seed)
    near = sum(
        all(
            t is not None and r is not None and t <= r + margin + ROUNDING
            for t, r in zip(times, reference.median, strict=True)
        )
        for times in row.per_seed
    )
    slack = within + ROUNDING
    usual = all(
        overlap(median_interval(row.column(index)), expected - slack, expected + slack)
        for index, expected in enumerate(medians)
    )
    other, share = better
    faster = sum(
        infinite(total(times)) < infinite(total(others))
        for times, others in zip(row.per_seed, other.per_seed, strict=True)
    )
    shown = ", ".join(f"{m:g}" for m in medians)
    reason = (
        f"{near} of {count} seeds at most {margin:g} above {reference.name} in all cells, expected "
        f"95 %; medians {'fit' if usual else 'do not fit'} {shown} (±{within:g}); "
        f"less than {other.name} in sum for {faster}, expected {share:.0%}"
    )
    fits = usual and share_fits(near, count, least=0.95) and share_fits(faster, count, least=share)
    return _judged(row, fits, reason)


def judge_within(row: Row, expected: Sequence[Value], within: float, *, chance: bool = True) -> Row:
    """Judge a row that is expected no further than `within` from values, cell by cell.

    Expected: 95 % of the seeds have all cells there. Without chance, every seed must, and few
    seeds suffice. Close: as expected, but the print lies outside our range.
    """
    count = len(row.per_seed)
    there = sum(
        all(
            t is not None and e is not None and abs(t - e) <= within + ROUNDING
            for t, e in zip(values, expected, strict=True)
        )
        for values in row.per_seed
    )
    share = "95 %" if chance else "all"
    shown = " ".join("none" if e is None else f"{e:g}" for e in expected)
    reason = f"{there} of {count} seeds within {within:g} of {shown}, expected {share}"
    fits = share_fits(there, count, least=0.95) if chance else there == count
    judged = _judged(row, fits, reason, chance=chance)
    return judged if fits or judged.verdict == UNCHECKED else replace(judged, verdict=DIFFERS)


def judge_mean_within(row: Row, reference: Sequence[float], most: float) -> Row:
    """Judge a row that is expected near values on average over its cells.

    Expected: on 95 % of the seeds no cell is without value, and the mean distance from the values
    is at most `most`. Close: as expected, but the print lies outside our range, or the reverse.
    """
    count = len(row.per_seed)
    there = sum(
        None not in values
        and math.fsum(abs(infinite(v) - r) for v, r in zip(values, reference, strict=True))
        <= most * len(reference) + ROUNDING
        for values in row.per_seed
    )
    shown = " ".join(f"{value:g}" for value in reference)
    reason = f"{there} of {count} seeds within {most:g} of {shown} on average, expected 95 %"
    return _judged(row, share_fits(there, count, least=0.95), reason)


def judge_ratio(row: Row, column: str, to: str, band: tuple[float, float], because: str) -> Row:
    """Judge the ratio of two columns, where the values themselves cannot be compared.

    Reproduced: our medians' ratio and the printed one both lie in the band.
    """
    over, under = row.columns.index(column), row.columns.index(to)
    ratios = []
    for values in [row.published, row.median]:
        dividend, divisor = values[over], values[under]
        if dividend is None or not divisor:
            return unchecked(row, "a value is missing")
        ratios.append(dividend / divisor)
    printed, ours = ratios
    reason = (
        f"{column} is {ours:.1%} of {to}, expected {band[0]:.0%}-{band[1]:.0%}, "
        f"printed {printed:.1%}; {because}"
    )
    if few := _too_few(row):
        return unchecked(row, f"{few}; {reason}")
    held = all(band[0] <= ratio <= band[1] for ratio in ratios)
    return replace(row, verdict=REPRODUCED if held else DIFFERS, reason=reason)


def judge_claim(row: Row, *, held: bool, reason: str, chance: bool = False) -> Row:
    """Judge a row by a claim in words, which it bears out or not.

    Where chance has a hand in the row, it takes some seeds.
    """
    few = _too_few(row) if chance else ""
    if few:
        return unchecked(row, f"{few}; {reason}")
    return replace(row, verdict=REPRODUCED if held else DIFFERS, reason=reason)


def judge_smaller(row: Row, column: str, than: str) -> Row:
    """Judge a row by the claim that one column is smaller than another, seed by seed.

    Reproduced if the 95 % interval of the share of seeds on which it is lies above one half.
    """
    sides = [
        [infinite(seed[index]) for seed in row.per_seed]
        for index in map(row.columns.index, (column, than))
    ]
    comparison = paired(*sides)
    reason = f"{column} against {than}: {comparison}"
    if len(row.per_seed) < FEWEST_PAIRS:
        few = f"{len(row.per_seed)} pairs say too little, {FEWEST_PAIRS} are needed"
        return unchecked(row, f"{few}; {reason}")
    held = comparison.decision == "smaller"
    return replace(row, verdict=REPRODUCED if held else DIFFERS, reason=reason)


def judge_smallest(row: Row, column: str, than: Sequence[str]) -> Row:
    """Judge a row by the claim that one column is smaller than each of some others."""
    judged = [judge_smaller(row, column, other) for other in than]
    failed = [one for one in judged if one.verdict != REPRODUCED]
    worst = (failed or judged)[0]
    return replace(worst, reason="; ".join(one.reason for one in judged))


def unchecked(row: Row, reason: str) -> Row:
    """Return the row without a verdict, and why."""
    return replace(row, verdict=UNCHECKED, reason=reason)


def _too_few(row: Row) -> str:
    """Return why a row has too few seeds for a verdict, or nothing."""
    count = len(row.per_seed)
    enough = count >= FEWEST_SEEDS
    return "" if enough else f"{count} seeds say too little, {FEWEST_SEEDS} are needed"


def _judged(row: Row, fits: bool, reason: str, *, chance: bool = True) -> Row:
    """Return the row with its verdict.

    Reproduced: the sample fits the expectation and the printed values lie in its range; close:
    one of both. Where chance has a hand in it, that takes some seeds.
    """
    few = _too_few(row) if chance else ""
    if few:
        return unchecked(row, f"{few}; {reason}")
    inside = all(
        printed is None or min(values) <= printed <= max(values)
        for printed, values in zip(
            row.published, map(row.column, range(len(row.columns))), strict=True
        )
    )
    where = "print within our range" if inside else "print outside our range"
    verdict = {2: REPRODUCED, 1: CLOSE, 0: DIFFERS}[fits + inside]
    return replace(row, verdict=verdict, reason=f"{reason}; {where}")
