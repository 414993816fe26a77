"""The command line: list the experiments, reproduce them."""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TextIO

from tqdm import tqdm

from fuzzyrs import __version__, experiments
from fuzzyrs.errors import FuzzyrsError
from fuzzyrs.experiments.drawing import draw
from fuzzyrs.experiments.experiment import Experiment
from fuzzyrs.experiments.result import Result, Row, Value

FAILED = 1
BAD_USAGE = 2
INTERRUPTED = 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    options = _parser().parse_args(arguments)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            # A terminal or pipe without Greek letters gets question marks, not a traceback.
            stream.reconfigure(errors="replace")
    try:
        if options.command == "list":
            return _list()
        return _reproduce(options)
    except experiments.Interrupted as interruption:
        print(f"{interruption}; the same command goes on from there", file=sys.stderr)
        return INTERRUPTED
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        # Whoever read our output has gone; nothing more can be said, not even at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
    except FuzzyrsError as error:
        print(f"fuzzyrs: {error}", file=sys.stderr)
        return BAD_USAGE if error.kind in {"unknown_name", "out_of_range"} else FAILED
    except OSError as error:
        print(f"fuzzyrs: {error}", file=sys.stderr)
        return FAILED


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="fuzzyrs", description="Fuzzy controllers that learn: reproduce the thesis's results."
    )
    parser.add_argument("--version", action="version", version=f"fuzzyrs {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    commands.add_parser("list", help="list the experiments")
    reproduce = commands.add_parser(
        "reproduce", help="run experiments and print the published numbers beside ours"
    )
    reproduce.add_argument("ids", nargs="+", metavar="ID", help="such as table-6-3")
    reproduce.add_argument("--seeds", type=_count, metavar="N", help="how many (default 20)")
    reproduce.add_argument("--seed", type=_count0, default=0, metavar="S", help="the first (0)")
    reproduce.add_argument(
        "--threads", type=_count0, default=0, metavar="K", help="0 for one on each core (default)"
    )
    reproduce.add_argument(
        "--out", type=Path, default=Path("results"), metavar="DIR", help="default: results"
    )
    reproduce.add_argument("--quick", action="store_true", help="few seeds, for a first look")
    reproduce.add_argument(
        "--resume",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="use the finished seeds of an interrupted run of the same config (default)",
    )
    return parser


def _count(text: str) -> int:
    count = _count0(text)
    if count == 0:
        raise argparse.ArgumentTypeError("must be at least 1, got 0")
    return count


def _count0(text: str) -> int:
    try:
        count = int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a whole number, got {text!r}") from None
    if count < 0:
        raise argparse.ArgumentTypeError(f"must be zero or more, got {count}")
    return count


def _list() -> int:
    for identifier in experiments.ids():
        experiment = experiments.find(identifier)
        print(f"{identifier:<12} {experiment.title} ({experiment.source})")
    return 0


def _reproduce(options: argparse.Namespace) -> int:
    # One may show several tables and figures.
    kinds = dict.fromkeys(experiments.find(identifier) for identifier in options.ids)
    for experiment in [kind() for kind in kinds]:
        default = experiment.quick_seeds if options.quick else experiment.default_seeds
        count = options.seeds or default
        seeds = range(options.seed, options.seed + count)
        with Report(experiment.id, sys.stderr) as report:
            result = experiments.reproduce(
                experiment,
                seeds,
                options.out,
                threads=options.threads,
                resume=options.resume,
                progress=report,
            )
        print(_table(experiment, result))
        print(f"wrote {options.out / f'{experiment.id}.json'}")
        _draw(experiment, result, options.out)
    return 0


def _draw(experiment: Experiment, result: Result, folder: Path) -> None:
    try:
        for path in draw(experiment, result, folder):
            print(f"wrote {path}")
    except ImportError as error:
        print(f"no figures: {error}", file=sys.stderr)


class Report:
    """Progress of a run: a bar on a terminal, plain lines elsewhere."""

    def __init__(self, name: str, stream: TextIO) -> None:
        self._name = name
        self._stream = stream
        self._bar: tqdm[Any] | None = None

    def __enter__(self) -> Report:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()

    def started(self, total: int, done: int) -> None:
        """Work on that many seeds begins."""
        if self._stream.isatty():
            self._bar = tqdm(total=total, desc=self._name, unit="seed", file=self._stream)

    def finished(self, seeds: Sequence[int], done: int, total: int) -> None:
        """Some more seeds are done."""
        self._say(f"{self._name}: seed {seeds[-1]} done ({done} of {total})")

    def _say(self, line: str) -> None:
        if self._bar is not None:
            self._bar.write(line, file=self._stream)
        else:
            print(line, file=self._stream, flush=True)


def _table(experiment: Experiment, result: Result) -> str:
    """Lay out every row: the print, our median and range, and the verdict."""
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
    ranges = [
        f"{_cell(median, row)} [{_cell(low, row)}, {_cell(high, row)}]"
        for median, low, high in zip(row.median, row.low, row.high, strict=True)
    ]
    table = [
        ["", *row.columns],
        ["  published", *(_cell(value, row) for value in row.published)],
        ["  ours", *ranges],
    ]
    missing = [row.missing(index) for index in range(len(row.columns))]
    if any(missing):
        table.append([f"  {nothing}", *(str(count) for count in missing)])
    widths = [max(len(line[i]) for line in table) for i in range(len(table[0]))]
    table[0][0] = row.name
    widths[0] = max(widths[0], len(row.name))
    lines = [
        "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip()
        for line in table
    ]
    return [*lines, f"  verdict: {row.verdict} ({row.reason})"]


def _cell(value: Value, row: Row) -> str:
    return "-" if value is None else f"{value:.{row.digits}f}"
