"""Figures that other processes draw while the next experiment runs."""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Iterator
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from pathlib import Path

from fuzzyrs import experiments
from fuzzyrs.experiments.drawing import draw
from fuzzyrs.experiments.saved import load


class Drawings:
    """Draws saved results. Processes are used because matplotlib holds the GIL.

    Parameters
    ----------
    folder : pathlib.Path
        Where results are, and where figures go.
    workers : int
        How many processes.
    """

    def __init__(self, folder: Path, workers: int) -> None:
        self._folder = folder
        context = multiprocessing.get_context("spawn")
        self._pool = ProcessPoolExecutor(workers, context, initializer=_leave_interrupts)
        self._running: dict[Future[list[Path]], str] = {}

    def add(self, identifier: str) -> None:
        """Draw the saved result of an experiment, some time."""
        self._running[self._pool.submit(_draw, self._folder, identifier)] = identifier

    def finished(self) -> Iterator[tuple[str, list[Path]]]:
        """Yield the experiments whose figures are there, with the files that were written.

        Raises
        ------
        ImportError
            Without matplotlib.
        FileError
            If a file could not be written.
        """
        for future in [future for future in self._running if future.done()]:
            yield self._running.pop(future), future.result()

    def all(self) -> Iterator[tuple[str, list[Path]]]:
        """Yield the same until all is drawn."""
        for future in as_completed(self._running):
            yield self._running.pop(future), future.result()

    def close(self) -> None:
        """Draw nothing more."""
        self._pool.shutdown(cancel_futures=True)


def _leave_interrupts() -> None:
    """Let the main process answer Ctrl-C, which a terminal sends to all."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _draw(folder: Path, identifier: str) -> list[Path]:
    experiment = experiments.find(identifier)()
    return list(draw(experiment, load(folder, experiment), folder))
