"""What a study runs: something that makes a finished run of a point and a seed."""

from __future__ import annotations

import inspect
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from fuzzyrs._fuzzyrs import Control
from fuzzyrs.studies.definition import outcome_of
from fuzzyrs.studies.store import Point, Run

#: A point of the grid and a seed.
Job = tuple[Point, int]


class Work(Protocol):
    """What is run at points with seeds. The backends of processes and of Ray pickle it."""

    def run(self, point: Point, seed: int, control: Control | None = None) -> Run:
        """Run once. The backend of threads cancels the control on Ctrl-C; others have none."""


@dataclass(frozen=True)
class FunctionWork:
    """A function of the user's.

    Attributes
    ----------
    function : callable
        Takes the seed and the parameters by name, and a `control` if it names one.
    record : bool
        Whether an exception is the outcome of its run or ends the study.
    """

    function: Callable[..., Any]
    record: bool = False

    def run(self, point: Point, seed: int, control: Control | None = None) -> Run:
        """Call the function once, and see whether it gave plain values."""
        extra = {"control": control or Control()} if self._takes_control() else {}
        return timed(
            lambda: outcome_of(self.function(seed=seed, **point, **extra)),
            point,
            seed,
            record=self.record,
        )

    def _takes_control(self) -> bool:
        try:
            return "control" in inspect.signature(self.function).parameters
        except (TypeError, ValueError):
            return False


def timed(work: Callable[[], Any], point: Point, seed: int, *, record: bool) -> Run:
    """Return the run that a piece of work makes; an exception names it, or is its outcome."""
    began = time.perf_counter()
    outcome, failure = None, None
    try:
        outcome = work()
    except Exception as error:
        if not record:
            if hasattr(error, "add_note"):  # Python 3.11
                error.add_note(f"in the run of a study at {point} with seed {seed}")
            raise
        failure = f"{type(error).__name__}: {error}"
    return Run(point, seed, outcome, failure, time.perf_counter() - began)
