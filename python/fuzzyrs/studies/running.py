"""Running what a study lacks."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from tqdm import tqdm

from fuzzyrs.studies.backends import Backend
from fuzzyrs.studies.definition import Definition
from fuzzyrs.studies.store import Run, Store, point_key
from fuzzyrs.studies.table import StudyResults
from fuzzyrs.studies.work import Work


class StudyInterrupted(KeyboardInterrupt):
    """A study was stopped by Ctrl-C; its finished runs are in the database.

    Attributes
    ----------
    results : StudyResults
        What was finished.
    """

    def __init__(self, message: str, results: StudyResults) -> None:
        super().__init__(message)
        self.results = results


def run_study(
    definition: Definition,
    work: Work,
    database: Path,
    *,
    backend: Backend,
    progress: bool | Callable[[int, int], object] = False,
) -> StudyResults:
    """Run what is not in the database yet, and return all runs of the definition.

    Raises
    ------
    StudyInterrupted
        On Ctrl-C; its `results` are what was finished.
    """
    total = definition.size()
    with Store(database, definition.name, definition.common()) as store:
        waiting = definition.missing(store.done())
        done = total - len(waiting)
        with tqdm(
            total=total,
            initial=done,
            desc=definition.name,
            unit="run",
            disable=progress is not True,
        ) as bar:

            def finished(some: list[Run]) -> None:
                nonlocal done
                store.add(some)
                done += len(some)
                bar.update(len(some))
                if callable(progress):
                    progress(done, total)

            if callable(progress):
                progress(done, total)
            try:
                backend.work(work, waiting, finished)
            except KeyboardInterrupt as interruption:
                message = f"interrupted after {done} of {total} runs; they are kept in {database}"
                raise StudyInterrupted(message, _results(definition, store)) from interruption
        return _results(definition, store)


def _results(definition: Definition, store: Store) -> StudyResults:
    """Return the finished runs of a definition, in its order."""
    points = {point_key(point): place for place, point in enumerate(definition.points())}
    seeds = {seed: place for place, seed in enumerate(definition.seeds)}
    placed = [(points.get(point_key(run.point)), seeds.get(run.seed), run) for run in store.runs()]
    ours = [(p, s, run) for p, s, run in placed if p is not None and s is not None]
    ours.sort(key=lambda one: one[:2])
    return StudyResults(
        definition.name, store.path, list(definition.grid), [run for *_, run in ours]
    )
