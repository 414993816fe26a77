"""`fuzzyrs reproduce`: run experiments, print the published numbers beside ours."""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, closing, suppress
from pathlib import Path
from typing import Any

from fuzzyrs import experiments, plot
from fuzzyrs._fuzzyrs import write_text
from fuzzyrs.cli.arguments import add_folder, natural, positive
from fuzzyrs.cli.drawings import Drawings, Drawn
from fuzzyrs.cli.progress import Watch, watch
from fuzzyrs.cli.tables import summary, table
from fuzzyrs.errors import FileError, FormatError
from fuzzyrs.experiments.claims import judge_all
from fuzzyrs.experiments.drawing import draw
from fuzzyrs.experiments.experiment import Experiment
from fuzzyrs.experiments.result import Result
from fuzzyrs.experiments.saved import load_table, saved_ids
from fuzzyrs.report import NAME as REPORT
from fuzzyrs.report import build
from fuzzyrs.studies.backends import usable_cores


def add_parser(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "reproduce", help="run experiments and print the published numbers beside ours"
    )
    parser.add_argument("ids", nargs="+", metavar="ID", help="such as table-6-3, chapter-6, or all")
    parser.add_argument(
        "--seeds",
        type=positive,
        metavar="N",
        help="how many (default, and most in a chapter or all: see 'fuzzyrs show ID')",
    )
    parser.add_argument("--seed", type=natural, default=0, metavar="S", help="the first (0)")
    parser.add_argument(
        "--threads", type=natural, default=0, metavar="K", help="0 for one on each core (default)"
    )
    add_folder(parser)
    parser.add_argument("--quick", action="store_true", help="few seeds, for a first look")
    parser.add_argument(
        "--resume",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="use the finished seeds of earlier runs of the same config and build (default)",
    )
    parser.add_argument("--json", action="store_true", help="one JSON object a line, for machines")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Reproduce what was asked for, one experiment after the other."""
    plan = [(kind(), _count(kind, options)) for kind in experiments.select(options.ids)]
    cores = options.threads or usable_cores()
    _warn_without_matplotlib()
    with ExitStack() as stack:
        told = stack.enter_context(closing(watch(plan, cores, machine=options.json)))
        told.tell("plan", experiments=[{"id": e.id, "seeds": count} for e, count in plan])
        for experiment, count in plan:
            if count == experiment.most_seeds and (options.seeds or 0) > count:
                told.note(f"{experiment.id} gets {count} seeds; by its own id it gets all")
        if len(plan) == 1:
            [(experiment, count)] = plan
            result = _reproduce(experiment, count, options, told)
            _draw_now(experiment, result, options.out, told)
            if (options.out / REPORT).exists():
                _report([result], options.out, told)
            return 0
        drawings = stack.enter_context(closing(Drawings(options.out, cores)))
        results = []
        for experiment, count in plan:
            results.append(_reproduce(experiment, count, options, told))
            drawings.add(experiment.id)
            _tell_files(drawings.finished(), told)
        if len(drawings):
            told.note(f"figures still to be drawn: of {len(drawings)} of {len(plan)} experiments")
        _tell_files(drawings.all(), told)
        told.say(summary(results, judge_all(results)))
        _report(results, options.out, told)
    return 0


def _count(kind: type[Experiment], options: argparse.Namespace) -> int:
    """Return how many seeds an experiment gets: one where chance has no hand in it."""
    if kind.default_seeds == 1:
        return 1
    default = kind.quick_seeds if options.quick else kind.default_seeds
    count = int(options.seeds or default)
    if kind.most_seeds is None or {kind.id, *kind.includes} & set(options.ids):
        return count
    return min(count, kind.most_seeds)


def _reproduce(
    experiment: Experiment, count: int, options: argparse.Namespace, told: Watch
) -> Result:
    """Run an experiment and print its table."""
    told.begin(experiment)
    result = experiments.reproduce(
        experiment,
        range(options.seed, options.seed + count),
        options.out,
        threads=options.threads,
        resume=options.resume,
        progress=told,
    )
    told.say(table(experiment, result))
    path = options.out / f"{experiment.id}.json"
    told.say(f"wrote {path}")
    told.tell(
        "result",
        id=experiment.id,
        verdicts=Counter(row.verdict for row in result.rows),
        files=[str(path)],
        seconds=result.run["seconds"],
    )
    return result


def _draw_now(experiment: Experiment, result: Result, folder: Path, told: Watch) -> None:
    files: list[Path] = []
    # It was said before the work began that matplotlib is missing.
    with suppress(ImportError):
        files.extend(draw(experiment, result, folder))
    _tell_files([Drawn(experiment.id, files)], told)


def _tell_files(drawn: Iterable[Drawn], told: Watch) -> None:
    """Print which figures were written, and which were not and why."""
    for each in drawn:
        for path in each.files:
            told.say(f"wrote {path}")
        if each.problem:
            told.note(f"{each.id} was not drawn: {each.problem}")
        told.tell("figures", **{**vars(each), "files": list(map(str, each.files))})


def _warn_without_matplotlib() -> None:
    try:
        plot.require_matplotlib()
    except ImportError as error:
        print(f"no figures: {error}", file=sys.stderr)


def _report(results: list[Result], folder: Path, told: Watch) -> None:
    """Write the claims and the report, together with what the folder has of earlier runs."""
    new = {result.id for result in results}
    document = [each.to_dict() for each in judge_all([*results, *_earlier(folder, new)])]
    path = folder / "claims.json"
    write_text(path, json.dumps(document, indent=2, ensure_ascii=False) + "\n")
    told.say(f"wrote {path}")
    told.tell("claims", claims=document, files=[str(path)])
    page = build(folder)
    told.say(f"wrote {page}")
    told.tell("report", files=[str(page)])


def _earlier(folder: Path, new: set[str]) -> Iterator[Result]:
    """Yield the results of other experiments in a folder, as far as they can be used."""
    for identifier in saved_ids(folder, experiments.ids()):
        if identifier not in new:
            with suppress(FormatError, FileError):
                yield load_table(folder, experiments.find(identifier)())
