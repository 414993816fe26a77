"""`fuzzyrs study`: run what a study file says, and print what came out at each point."""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
import time
from collections.abc import Sequence
from contextlib import closing
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, TextIO

from tqdm import tqdm

from fuzzyrs.cli.arguments import natural, positive
from fuzzyrs.cli.progress import BETWEEN_LINES, duration
from fuzzyrs.errors import from_kind
from fuzzyrs.studies.backends import BACKENDS, backend_of
from fuzzyrs.studies.file import read_study
from fuzzyrs.studies.running import run_study
from fuzzyrs.studies.summary import Summary
from fuzzyrs.studies.table import StudyResults

#: So many failed runs are printed.
SHOWN_FAILURES = 5


def add_parser(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser("study", help="run a study file: a grid of settings and seeds")
    parser.add_argument("file", type=Path, metavar="FILE.toml", help="see docs/studies.md")
    parser.add_argument(
        "--seeds", type=positive, metavar="N", help="how many (default: the file's)"
    )
    parser.add_argument("--backend", choices=list(BACKENDS), help="where runs are worked on")
    parser.add_argument(
        "--workers", type=natural, metavar="K", help="runs at a time; 0 for one on each core"
    )
    parser.add_argument(
        "--database", type=Path, metavar="DB", help="where finished runs go (default: FILE.db)"
    )
    parser.add_argument("--csv", type=Path, metavar="CSV", help="write all runs to this file")
    parser.add_argument(
        "--measure",
        action="append",
        metavar="NAME",
        help="print these outcomes only; * stands for anything, and it may be given again",
    )
    parser.add_argument("--json", action="store_true", help="one JSON object a line, for machines")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Run the study of a file."""
    study = read_study(options.file, seeds=options.seeds)
    workers = study.workers if options.workers is None else options.workers
    database = options.database or study.database
    if options.csv is not None:
        check_writable(options.csv)
    with closing(Watch(study.definition.name, sys.stderr, machine=options.json)) as watch:
        try:
            results = run_study(
                study.definition,
                study.work,
                database,
                backend=backend_of(options.backend or study.backend, workers),
                progress=watch,
            )
        except Exception:
            if watch.done:
                print(f"{watch.done} finished runs are kept in {database}", file=sys.stderr)
            raise
    if options.csv is not None:
        results.to_csv(options.csv)
    summary = chosen(results.summary(), options.measure)
    print(as_json(results, summary) if options.json else as_text(results, summary))
    return 0


def check_writable(path: Path) -> None:
    """Raise an error if a file can't be written, so that it is told before the work."""
    if not path.parent.is_dir():
        problem = f"there is no folder {path.parent}; make it first"
    elif path.is_dir():
        problem = "it is a folder; name a file"
    elif not os.access(path.parent, os.W_OK):
        problem = f"the folder {path.parent} cannot be written; change its permissions"
    else:
        return
    raise from_kind("file", f"cannot write {path}: {problem}")


class Watch:
    """How far a study is: a bar on a terminal, lines elsewhere, or JSON for machines."""

    def __init__(self, name: str, stream: TextIO, *, machine: bool) -> None:
        self._name = name
        self._stream = stream
        self._machine = machine
        self._bar: tqdm[Any] | None = None
        self._began = time.monotonic()
        self._told = -math.inf
        #: Runs that were there before.
        self._before: int | None = None
        self.done = 0

    def __call__(self, done: int, total: int) -> None:
        """Take note of the numbers of finished and of all runs."""
        self.done = done
        if self._before is None:
            self._start(done, total)
        elif self._bar is not None:
            self._bar.update(done - self._bar.n)
        else:
            self._tell(done, total)

    def close(self) -> None:
        """The study has ended, or was stopped."""
        if self._bar is not None:
            self._bar.close()

    def _start(self, done: int, total: int) -> None:
        self._before = done
        if self._machine:
            self._event("started", name=self._name, total=total, done=done)
        elif self._stream.isatty():
            self._bar = tqdm(
                total=total, initial=done, desc=self._name, unit="run", file=self._stream
            )
        elif done:
            self._line(f"going on with {done} of {total} runs that are done already")

    def _tell(self, done: int, total: int) -> None:
        """Tell how far it is, but not too often."""
        now = time.monotonic()
        if done < total and now - self._told < BETWEEN_LINES:
            return
        self._told = now
        elapsed = now - self._began
        remaining = elapsed / (done - (self._before or 0)) * (total - done)
        if self._machine:
            times = {"elapsed": round(elapsed, 3), "remaining": round(remaining, 3)}
            self._event("runs", done=done, total=total, **times)
        else:
            left = f", about {duration(remaining)} left" if done < total else ""
            self._line(f"{done} of {total} runs in {duration(elapsed)}{left}")

    def _line(self, text: str) -> None:
        print(f"{self._name}: {text}", file=self._stream, flush=True)

    def _event(self, event: str, **values: Any) -> None:
        print(json.dumps({"event": event, **values}, ensure_ascii=False), flush=True)


def chosen(summary: Sequence[Summary], patterns: Sequence[str] | None) -> list[Summary]:
    """Return what is said about the outcomes with these names, one outcome after the other."""
    names = list(dict.fromkeys(one.measure for one in summary))
    if patterns:
        names = [n for n in names if any(fnmatchcase(n, pattern) for pattern in patterns)]
    return [one for name in names for one in summary if one.measure == name]


def as_json(results: StudyResults, summary: Sequence[Summary]) -> str:
    """Return the results of a study as an event."""
    event = {
        "event": "summary",
        "name": results.name,
        "database": str(results.database),
        "runs": len(results.runs),
        "failed": len(results.failures()),
        "summary": [one.to_dict() for one in summary],
    }
    return json.dumps(_finite(event), ensure_ascii=False, allow_nan=False)


def _finite(value: Any) -> Any:
    """Return plain values without infinite numbers and NaN, which JSON doesn't have."""
    if isinstance(value, dict):
        return {key: _finite(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [_finite(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def as_text(results: StudyResults, summary: Sequence[Summary]) -> str:
    """Lay out a table for each outcome, with a line for each point."""
    lines = []
    for measure in dict.fromkeys(one.measure for one in summary):
        lines += [
            measure,
            *_table(results.parameters, [o for o in summary if o.measure == measure]),
        ]
        lines.append("")
    lines.append(f"runs of {results.name} in {results.database}: {len(results.runs)}")
    if any(one.missing for one in summary):
        lines.append("n: runs that have a number; the others count nowhere")
    failures = results.failures()
    lines += [f"failed: {f.point}, seed {f.seed}: {f.error}" for f in failures[:SHOWN_FAILURES]]
    if len(failures) > SHOWN_FAILURES:
        lines.append(f"failed: {len(failures) - SHOWN_FAILURES} more")
    return "\n".join(lines)


def _table(parameters: Sequence[str], summary: Sequence[Summary]) -> list[str]:
    rows = [[*parameters, "n", "median", "middle half", "95 % interval"]]
    for one in summary:
        place = [_cell(one.point[parameter]) for parameter in parameters]
        count = f"{one.count} of {one.count + one.missing}" if one.missing else str(one.count)
        interval = "-" if one.interval is None else " to ".join(map(_cell, one.interval))
        rows.append([*place, count, _cell(one.median), _cell(one.interquartile_mean), interval])
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  "
        + "  ".join(part.ljust(width) for part, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]


def _cell(value: Any) -> str:
    if value is None:
        return "-"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
