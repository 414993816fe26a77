"""Figures that other processes draw while the next experiment runs."""

from __future__ import annotations

import multiprocessing
from collections.abc import Iterator
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from fuzzyrs import experiments
from fuzzyrs.experiments.drawing import draw
from fuzzyrs.experiments.saved import load
from fuzzyrs.studies.backends import begin_worker


@dataclass(frozen=True)
class Drawn:
    """What became of an experiment's figures.

    Attributes
    ----------
    id : str
        The experiment's.
    files : list of pathlib.Path
        What was written.
    problem : str
        Why not all of it, if so.
    """

    id: str
    files: list[Path]
    problem: str = ""


class Drawings:
    """Draws saved results. Processes are used because matplotlib holds the GIL.

    What goes wrong with a figure stops nothing else: the numbers are on disk, and the report draws
    what is missing.

    Parameters
    ----------
    folder : pathlib.Path
        Where results are, and where figures go.
    workers : int
        How many processes.
    """

    def __init__(self, folder: Path, workers: int) -> None:
        self._folder = folder
        self._workers = workers
        self._pool = self._processes()
        self._running: dict[Future[Drawn], str] = {}

    def _processes(self) -> ProcessPoolExecutor:
        context = multiprocessing.get_context("spawn")
        return ProcessPoolExecutor(self._workers, context, initializer=begin_worker)

    def add(self, identifier: str) -> None:
        """Draw the saved result of an experiment, some time."""
        try:
            future = self._pool.submit(_draw, self._folder, identifier)
        except (BrokenProcessPool, OSError):
            # A process was killed, as by a system that is out of memory; until the pool has noticed
            # that, its pipes may be closed already.
            self._pool = self._processes()
            future = self._pool.submit(_draw, self._folder, identifier)
        self._running[future] = identifier

    def __len__(self) -> int:
        """Return how many experiments are still to be drawn."""
        return len(self._running)

    def finished(self) -> Iterator[Drawn]:
        """Yield what was drawn since the last call."""
        for future in [future for future in self._running if future.done()]:
            yield self._drawn(future)

    def all(self) -> Iterator[Drawn]:
        """Yield the same until all is drawn."""
        for future in as_completed(list(self._running)):
            yield self._drawn(future)

    def _drawn(self, future: Future[Drawn]) -> Drawn:
        identifier = self._running.pop(future)
        try:
            return future.result()
        except Exception as error:
            return Drawn(identifier, [], str(error) or type(error).__name__)

    def close(self) -> None:
        """Draw nothing more."""
        self._pool.shutdown(cancel_futures=True)


def _draw(folder: Path, identifier: str) -> Drawn:
    experiment = experiments.find(identifier)()
    files: list[Path] = []
    # Without matplotlib there are controllers only, which was said before the work began.
    with suppress(ImportError):
        files.extend(draw(experiment, load(folder, experiment), folder))
    return Drawn(identifier, files)
