"""Running an experiment over seeds: on several threads, to disk as they finish, resumable."""

from __future__ import annotations

import os
import platform
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from fuzzyrs._fuzzyrs import Control
from fuzzyrs.errors import from_kind
from fuzzyrs.experiments.experiment import Experiment
from fuzzyrs.experiments.result import Result
from fuzzyrs.experiments.saved import build, open_runs, save
from fuzzyrs.studies.backends import Threads, usable_cores
from fuzzyrs.studies.store import Run, Store
from fuzzyrs.studies.work import timed

Outcome = dict[str, Any]

#: More seeds than this would not fit into a result that anybody reads.
MOST_SEEDS = 100_000


class Progress(Protocol):
    """Who is told how far a run is."""

    def started(self, total: int, done: int) -> None:
        """Work on that many seeds begins; so many were done already."""

    def finished(self, seeds: Sequence[int], done: int, total: int) -> None:
        """Some more seeds are done, one at least."""


class Interrupted(KeyboardInterrupt):
    """A run was stopped by Ctrl-C; what it finished is on disk."""

    def __init__(self, done: int, total: int, path: Path) -> None:
        super().__init__(f"interrupted after {done} of {total} seeds; they are kept in {path}")


def reproduce(
    experiment: Experiment,
    seeds: Sequence[int],
    folder: Path,
    *,
    threads: int = 0,
    resume: bool = True,
    progress: Progress | None = None,
) -> Result:
    """Run an experiment and write its result as JSON.

    Parameters
    ----------
    experiment : Experiment
        What to run.
    seeds : sequence of int
        One run each; at least one, all different.
    folder : pathlib.Path
        Where the result goes; made if needed. `drawing.draw` makes the figures of it.
    threads : int, optional
        How many seeds at a time; 0 for one on each core. Results do not depend on it.
    resume : bool, optional
        Whether to use the seeds that an interrupted run of the same config left.
    progress : Progress, optional
        Who is told.

    Returns
    -------
    Result

    Raises
    ------
    Interrupted
        On Ctrl-C; the finished seeds are on disk.
    FileError
        If the folder cannot be written.
    """
    seeds = _checked(seeds)
    began = time.perf_counter()
    threads = threads or usable_cores()
    _prepare(folder)
    with open_runs(folder, experiment) as runs:
        outcomes = _outcomes(runs, seeds) if resume else {}
        if progress is not None:
            progress.started(len(seeds), len(outcomes))

        def finished(some: list[Run]) -> None:
            runs.add(some, anew=not resume)
            for run in some:
                outcomes[run.seed] = run.outcome or {}
            if progress is not None:
                progress.finished([run.seed for run in some], len(outcomes), len(seeds))

        waiting = [(_NO_POINT, seed) for seed in seeds if seed not in outcomes]
        try:
            Threads(threads).work(_Seeds(experiment), waiting, finished)
        except KeyboardInterrupt as interruption:
            raise Interrupted(len(outcomes), len(seeds), runs.path) from interruption
        # As they are on disk, so that a run which was taken up again gives the same.
        outcomes = _outcomes(runs, seeds)

    ordered = [outcomes[seed] for seed in seeds]
    result = Result(
        id=experiment.id,
        seeds=list(seeds),
        config=experiment.config(),
        rows=experiment.rows(ordered),
        run={
            "seconds": round(time.perf_counter() - began, 3),
            "seconds_per_seed": [outcome.get("seconds", {}) for outcome in ordered],
            "threads": threads,
            "build": build(),
            "machine": platform.node(),
            "processor": platform.machine(),
            "python": platform.python_version(),
        },
        outcomes=ordered,
        games=list(experiment.games(ordered, seeds)),
    )
    save(folder, result, experiment.title)
    return result


#: Experiments have one point: their config.
_NO_POINT: dict[str, Any] = {}


def _outcomes(runs: Store, seeds: Sequence[int]) -> dict[int, Outcome]:
    """Return the outcomes of those seeds that are finished."""
    wanted = set(seeds)
    return {run.seed: run.outcome or {} for run in runs.runs() if run.seed in wanted}


@dataclass(frozen=True)
class _Seeds:
    """The work of an experiment. It is Rust with the GIL released: threads do as processes do."""

    experiment: Experiment

    def run(self, point: dict[str, Any], seed: int, control: Control | None = None) -> Run:
        """Run one seed."""
        control = control or Control()
        return timed(lambda: self.experiment.run_seed(seed, control), point, seed, record=False)


def _checked(seeds: Sequence[int]) -> list[int]:
    """Return the seeds as plain integers, or say what is wrong with them."""
    if not 1 <= len(seeds) <= MOST_SEEDS:
        message = f"the number of seeds must be from 1 to {MOST_SEEDS}, got {len(seeds)}"
        raise from_kind("out_of_range", message)
    plain = [int(seed) for seed in seeds]
    if len(set(plain)) < len(plain):
        raise from_kind("out_of_range", "the seeds must differ from each other")
    if not all(0 <= seed < 2**63 for seed in plain):
        raise from_kind("out_of_range", "seeds must be whole numbers from 0 to 2^63 - 1")
    return plain


def _prepare(folder: Path) -> None:
    """Make the folder, and find out now rather than after the work whether it can be written."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe = folder / f".{os.getpid()}.probe"
        probe.touch()
        probe.unlink()
    except OSError as error:
        message = f"cannot write results into {folder}: {error.strerror or error}"
        raise from_kind("file", message) from error
