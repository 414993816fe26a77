"""The command `fuzzyrs study`: run what a study file says, and print what came out."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

from tqdm import tqdm

from fuzzyrs.studies.backends import backend_of
from fuzzyrs.studies.file import read_study
from fuzzyrs.studies.running import StudyInterrupted, run_study
from fuzzyrs.studies.summary import Summary
from fuzzyrs.studies.table import StudyResults

if TYPE_CHECKING:
    Commands = argparse._SubParsersAction[argparse.ArgumentParser]

INTERRUPTED = 130
#: Seconds between two lines of progress where there is no terminal.
QUIET = 5.0


def add_parser(commands: Commands) -> None:
    """Add the command to those of a command line."""
    parser = commands.add_parser("study", help="run a study file: a grid of settings and seeds")
    parser.add_argument("file", type=Path, metavar="FILE.toml")
    parser.add_argument("--seeds", type=_count, metavar="N", help="how many (default: the file's)")
    parser.add_argument(
        "--workers", type=int, metavar="K", help="runs at a time, 0 for one on each core"
    )
    parser.add_argument("--backend", choices=["threads", "processes", "ray"])
    parser.add_argument(
        "--database", type=Path, metavar="DB", help="where finished runs go (default: FILE.db)"
    )
    parser.add_argument("--csv", type=Path, metavar="CSV", help="write all runs to this file")
    parser.add_argument("--json", action="store_true", help="print the summary as JSON")


def _count(text: str) -> int:
    try:
        count = int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a whole number, got {text!r}") from None
    if count < 1:
        raise argparse.ArgumentTypeError(f"must be at least 1, got {count}")
    return count


def run(options: argparse.Namespace) -> int:
    """Run the study of a file and return the exit code."""
    study = read_study(options.file, seeds=options.seeds)
    workers = study.workers if options.workers is None else options.workers
    try:
        with Progress(study.definition.name, sys.stderr) as progress:
            results = run_study(
                study.definition,
                study.work,
                options.database or study.database,
                backend=backend_of(options.backend or study.backend, workers),
                progress=progress,
            )
    except StudyInterrupted as interruption:
        print(f"{interruption}; the same command goes on from there", file=sys.stderr)
        return INTERRUPTED
    if options.csv is not None:
        results.to_csv(options.csv)
        print(f"wrote {options.csv}", file=sys.stderr)
    summary = results.summary()
    print(_json(results, summary) if options.json else _text(results, summary))
    return 0


class Progress:
    """How far a study is: a bar on a terminal, a line now and then elsewhere."""

    def __init__(
        self, name: str, stream: TextIO, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._name = name
        self._stream = stream
        self._clock = clock
        self._bar: tqdm[Any] | None = None
        self._began = self._told = clock()
        self._known: int | None = None

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()

    def __call__(self, done: int, total: int) -> None:
        """Take note of the numbers of finished and of all runs; some may have been there."""
        if self._known is None:
            self._known = done
            if self._stream.isatty():
                self._bar = tqdm(
                    total=total, initial=done, desc=self._name, unit="run", file=self._stream
                )
            elif done:
                self._say(f"going on with {done} of {total} runs that are done already")
        elif self._bar is not None:
            self._bar.update(done - self._bar.n)
        elif done == total or self._clock() - self._told >= QUIET:
            self._told = self._clock()
            elapsed = self._told - self._began
            remaining = elapsed / (done - self._known) * (total - done)
            left = f", about {duration(remaining)} left" if done < total else ""
            self._say(f"{done} of {total} runs after {duration(elapsed)}{left}")

    def _say(self, text: str) -> None:
        print(f"{self._name}: {text}", file=self._stream, flush=True)


def duration(seconds: float) -> str:
    """Return a time as people say it: 8 s, 3 min 5 s, 2 h 10 min."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"


def _json(results: StudyResults, summary: list[Summary]) -> str:
    document = {
        "name": results.name,
        "database": str(results.database),
        "parameters": results.parameters,
        "runs": len(results.runs),
        "failed": len(results.failures()),
        "summary": [one.to_dict() for one in summary],
    }
    return json.dumps(_finite(document), indent=2, ensure_ascii=False, allow_nan=False)


def _finite(value: Any) -> Any:
    """Return plain values without infinite numbers, which JSON doesn't have."""
    if isinstance(value, dict):
        return {key: _finite(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [_finite(inner) for inner in value]
    return None if value in (float("inf"), float("-inf")) else value


def _text(results: StudyResults, summary: list[Summary]) -> str:
    """Lay the summary out as a table: a line for each point and measure."""
    header = [*results.parameters, "measure", "n", "median", "IQM", "95 % interval"]
    gaps = any(one.missing for one in summary)
    if gaps:
        header.append("missing")
    rows = [header]
    for one in summary:
        interval = "-" if one.interval is None else " to ".join(map(_cell, one.interval))
        values = [_cell(one.median), _cell(one.interquartile_mean), interval]
        place = [_cell(one.point[parameter]) for parameter in results.parameters]
        counts = [str(one.missing)] if gaps else []
        rows.append([*place, one.measure, str(one.count), *values, *counts])
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]
    lines += ["", f"{len(results.runs)} runs of {results.name} in {results.database}"]
    if gaps:
        lines.append("missing: runs without a number, such as games without a capture")
    for failure in results.failures()[:5]:
        lines.append(f"failed: {failure.point}, seed {failure.seed}: {failure.error}")
    if len(results.failures()) > 5:
        lines.append(f"failed: {len(results.failures()) - 5} more")
    return "\n".join(lines)


def _cell(value: Any) -> str:
    if value is None:
        return "-"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
