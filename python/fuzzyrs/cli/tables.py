"""Results as text."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from fuzzyrs.experiments.claims import Judged
from fuzzyrs.experiments.experiment import Experiment
from fuzzyrs.experiments.result import Result, Row, Value
from fuzzyrs.experiments.verdict import VERDICTS


def table(experiment: Experiment, result: Result) -> str:
    """Lay out every row: the print, our median, range and middle, and the verdict."""
    count, first = len(result.seeds), result.seeds[0]
    lines = [
        f"{experiment.id}: {experiment.title}",
        f"claim: {experiment.claim}",
        f"{count} {'seed' if count == 1 else 'seeds'} from {first}; {experiment.values}; "
        "median [smallest, largest], - where there is no value",
    ]
    for row in result.rows:
        lines += ["", *_row(row, experiment.missing)]
    return "\n".join(lines) + "\n"


def _row(row: Row, nothing: str) -> list[str]:
    lines = [
        ["", *row.columns],
        ["  published", *(cell(value, row) for value in row.published)],
        ["  ours", *_with_interval(row.median, zip(row.low, row.high, strict=True), row)],
    ]
    if len({tuple(values) for values in row.per_seed}) > 1:
        middle = _with_interval(row.interquartile_mean, row.interval, row)
        lines.append(["  middle half", *middle])
    missing = [row.missing(index) for index in range(len(row.columns))]
    if any(missing):
        lines.append([f"  {nothing}", *(str(count) for count in missing)])
    widths = [max(len(line[i]) for line in lines) for i in range(len(lines[0]))]
    lines[0][0] = row.name
    widths[0] = max(widths[0], len(row.name))
    text = [
        "  ".join(part.ljust(width) for part, width in zip(line, widths, strict=True)).rstrip()
        for line in lines
    ]
    return [*text, f"  verdict: {row.verdict} ({row.reason})"]


def _with_interval(
    values: Iterable[Value], intervals: Iterable[tuple[Value, Value]], row: Row
) -> list[str]:
    return [
        f"{cell(value, row)} [{cell(low, row)}, {cell(high, row)}]"
        for value, (low, high) in zip(values, intervals, strict=True)
    ]


def cell(value: Value, row: Row) -> str:
    """Return a value of a row with as many digits as are worth printing."""
    return "-" if value is None else f"{value:.{row.digits}f}"


def summary(results: Sequence[Result], claims: Sequence[Judged]) -> str:
    """Lay out how many rows have which verdict, and the claims in words."""
    width = max(len(result.id) for result in results)
    lines = [f"{'rows by verdict':<{width}}  {'  '.join(VERDICTS)}"]
    for name, rows in [
        *((result.id, result.rows) for result in results),
        ("all", [row for result in results for row in result.rows]),
    ]:
        counts = Counter(row.verdict for row in rows)
        numbers = (str(counts[verdict] or "-").rjust(len(verdict)) for verdict in VERDICTS)
        lines.append(f"{name:<{width}}  {'  '.join(numbers)}")
    lines += ["", "what the thesis claims in words"]
    for judged in claims:
        claim = judged.claim
        lines.append(f"{claim.number:>3}. {claim.text} ({claim.source})")
        decisive = "; ".join(str(finding) for finding in judged.findings if finding.decides)
        lines.append(f"     {judged.verdict} ({decisive})")
        if claim.remark:
            lines.append(f"     with 100 seeds: {claim.remark}")
    return "\n".join(lines) + "\n"
