"""Study files: TOML that says what is run, over which grid, with which seeds.

The file has three tables::

    [study]
    train = "q_lambda"            # or: experiment = "table-6-3", or: function = "module:name"
    seeds = 20                    # or a list, or {first = 100, count = 20}

    [settings]                    # what all points share
    starts = [[2, 4], [-6, 7]]

    [grid]                        # what differs
    learner.episodes = [50, 100, 200]
    game.time_step = {from = 0.05, to = 0.2, step = 0.05}

Besides, `[study]` may have a name (by default the file's), a database (by default a file beside
it), backend, workers, and record_errors, as `fuzzyrs.study` takes them.
"""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fuzzyrs.errors import FuzzyrsError, from_kind
from fuzzyrs.studies.backends import backend_of
from fuzzyrs.studies.definition import (
    MOST_RUNS,
    Definition,
    Scalar,
    axis,
    check_name,
    define,
    seed_list,
)
from fuzzyrs.studies.document import Document, Keys
from fuzzyrs.studies.settings import described
from fuzzyrs.studies.subjects import ExperimentSubject, FunctionSubject, Subject, TechniqueSubject
from fuzzyrs.studies.work import Work

Grid = dict[str, tuple[Scalar, ...]]

#: At so many points it is tried beforehand whether the settings fit.
TRIED_POINTS = 200

#: What `[study]` may have, with an example of each.
_STUDY: dict[str, Any] = {
    "name": "learning games",
    "experiment": "table-6-3",
    "train": "q_lambda",
    "function": "module:function",
    "seeds": 20,
    "database": "study.db",
    "backend": "threads",
    "workers": 2,
    "record_errors": True,
}


@dataclass(frozen=True)
class StudyFile:
    """What a study file says.

    Attributes
    ----------
    definition : Definition
        Name, grid, seeds and settings.
    work : Work
        What is run.
    database : pathlib.Path
        Where the runs go.
    backend : str
        Where they are worked on.
    workers : int
        How many at a time; 0 for one on each core.
    """

    definition: Definition
    work: Work
    database: Path
    backend: str
    workers: int


def read_study(path: Path, *, seeds: int | None = None) -> StudyFile:
    """Read a study file, and see whether all of it fits.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    seeds : int, optional
        So many seeds instead of the file's number, from the file's first on.

    Raises
    ------
    FileError
        If it cannot be read.
    FormatError
        If it is no study; it names the line, and the nearest key that there is.
    """
    document = Document(path)
    document.check_keys((), ["study", "settings", "grid"])
    study = _checked_study(document)
    subject = _subject(document, study)
    named = _named(document)
    settings = {name: value for name, (keys, value) in named.items() if keys[0] == "settings"}
    grid = _grid(document, named)
    try:
        _try_points(subject, settings, grid)
    except FuzzyrsError as error:
        blamed = _misfit(subject, settings, grid)
        keys = ("grid",) if blamed is None else named[blamed][0]
        raise document.error(keys, str(error)) from error
    with document.naming(("study", "seeds")):
        chosen = _seeds(document, study.get("seeds", 20), seeds)
    with document.naming(("study",)):
        definition = define(study.get("name", path.stem), subject.name, grid, chosen, settings)
    return StudyFile(
        definition,
        subject.work(settings, study.get("record_errors", False)),
        path.parent / study.get("database", f"{path.stem}.db"),
        study.get("backend", "threads"),
        study.get("workers", 0),
    )


def _checked_study(document: Document) -> dict[str, Any]:
    """Return the table of the study, whose values are of the right types."""
    study = document.table("study")
    document.check_keys(("study",), _STUDY)
    for key, value in study.items():
        example = _STUDY[key]
        if key != "seeds" and type(value) is not type(example):
            message = f"{key!r} must be {described(example)} such as {example!r}, got {value!r}"
            raise document.error(("study", key), message)
    with document.naming(("study", "name")):
        check_name(study.get("name", document.path.stem))
    with document.naming(("study", "backend")):
        backend_of(study.get("backend", "threads"), 0)
    with document.naming(("study", "workers")):
        backend_of("threads", study.get("workers", 0))
    return study


def _subject(document: Document, study: Mapping[str, Any]) -> Subject:
    """Return what is studied, which must be one thing."""
    folders = (document.path.absolute().parent, Path.cwd())
    kinds: dict[str, Callable[[str], Subject]] = {
        "experiment": ExperimentSubject,
        "train": TechniqueSubject,
        "function": lambda place: FunctionSubject(place, folders),
    }
    given = [kind for kind in kinds if kind in study]
    if len(given) != 1:
        message = f"[study] must have one of 'experiment', 'train' and 'function', got {len(given)}"
        raise document.error(("study", *given[1:2]), message)
    [kind] = given
    subject = kinds[kind](study[kind])
    with document.naming(("study", kind)):
        subject.exists()
    return subject


def _named(document: Document) -> dict[str, tuple[Keys, Any]]:
    """Return the values of settings and grid by dotted names, and the way to each."""
    named: dict[str, tuple[Keys, Any]] = {}
    for table in ("settings", "grid"):
        for keys, value in _leaves(document, (table,)):
            name = ".".join(keys[1:])
            if name in named:
                message = f"{name!r} is in [{named[name][0][0]}] already; it can't be twice"
                raise document.error(keys, message)
            if table == "settings" and not _is_plain(value):
                raise document.error(keys, f"{name!r} can't have dates and times in it")
            named[name] = keys, value
    return named


def _is_plain(value: Any) -> bool:
    """Tell whether the database can keep a value."""
    try:
        json.dumps(value)
    except TypeError:
        return False
    return True


def _leaves(document: Document, table: Keys) -> Iterator[tuple[Keys, Any]]:
    """Yield the values in a table and in the tables in it, and the way to each."""
    for key, value in document.table(*table).items():
        if isinstance(value, dict) and "from" not in value and "to" not in value:
            yield from _leaves(document, (*table, key))
        else:
            yield (*table, key), value


def _grid(document: Document, named: Mapping[str, tuple[Keys, Any]]) -> Grid:
    """Return the values of each parameter."""
    grid: Grid = {}
    for name, (keys, values) in named.items():
        if keys[0] == "grid":
            with document.naming(keys):
                if isinstance(values, dict):
                    document.check_keys(keys, ["from", "to", "step", "count"])
                    grid[name] = axis(name, _range(name, values))
                else:
                    grid[name] = axis(name, values)
    if not grid:
        message = 'the grid is empty; say what varies in [grid], such as "learner.steps = [1, 2]"'
        raise document.error(("grid",), message)
    return grid


def _range(name: str, ends: Mapping[str, Any]) -> list[int | float]:
    """Return evenly spaced values, the last of which is not beyond the end."""
    numbers = {key: value for key, value in ends.items() if type(value) in (int, float)}
    if len(numbers) < 3 or len(ends) > 3 or not {"from", "to"} <= set(ends):
        message = f"the range of {name!r} must have numbers 'from', 'to', and 'step' or 'count'"
        raise from_kind("wrong_type", message)
    first, last = numbers["from"], numbers["to"]
    if "count" in numbers:
        count = numbers["count"]
        if type(count) is not int or not 2 <= count <= MOST_RUNS:
            raise from_kind("out_of_range", f"'count' must be 2 at least, got {count}")
        step = (last - first) / (count - 1)
    else:
        step = numbers["step"]
        # The last value may miss the end by rounding.
        steps = (last - first) / step + 1e-9 if step else math.inf
        if not 0 <= steps < MOST_RUNS:
            raise from_kind(
                "out_of_range", f"{step} does not lead from {first} to {last} in a sensible way"
            )
        count = int(steps) + 1
    # As they are written in decimals: 0.3, not 0.30000000000000004.
    values = [first + index * step for index in range(count)]
    return values if type(values[-1]) is int else [float(f"{value:.12g}") for value in values]


def _seeds(document: Document, given: Any, wanted: int | None) -> Iterable[int]:
    """Return the seeds that a file gives, or as many of them as are wanted."""
    if isinstance(given, list):
        if wanted is not None and wanted > len(given):
            raise from_kind("out_of_range", f"the file lists {len(given)} seeds, not {wanted}")
        return seed_list(given[:wanted])
    if isinstance(given, dict):
        document.check_keys(("study", "seeds"), ["first", "count"])
    first, count = (
        (given.get("first", 0), given.get("count", 20)) if isinstance(given, dict) else (0, given)
    )
    if type(first) is not int or type(count) is not int:
        message = f"seeds must be a number, a list, or {{first = 0, count = 20}}, got {given!r}"
        raise from_kind("wrong_type", message)
    return seed_list(range(first, first + (count if wanted is None else wanted)))


def _try_points(subject: Subject, settings: Mapping[str, Any], grid: Grid) -> None:
    """See at the first points whether their settings fit together."""
    for values in itertools.islice(itertools.product(*grid.values()), TRIED_POINTS):
        subject.check({**settings, **dict(zip(grid, values, strict=True))})


def _misfit(subject: Subject, settings: Mapping[str, Any], grid: Grid) -> str | None:
    """Return the first name with a value that doesn't fit even alone."""
    alone = {name: (value,) for name, value in settings.items()} | grid
    for name, values in alone.items():
        if not all(_fits(subject, {name: value}) for value in values[:TRIED_POINTS]):
            return name
    return None


def _fits(subject: Subject, changes: Mapping[str, Any]) -> bool:
    try:
        subject.check(changes)
    except FuzzyrsError:
        return False
    return True
