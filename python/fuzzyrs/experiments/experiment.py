"""What an experiment is."""

from __future__ import annotations

import json
import statistics
from abc import ABC, abstractmethod
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from matplotlib.figure import Figure

    from fuzzyrs._fuzzyrs import Control, FuzzyController
    from fuzzyrs.experiments.result import Result, Row, Value
    from fuzzyrs.recording import Recording


class Experiment(ABC):
    """One table or figure of the thesis.

    A subclass says what it is in its class attributes, holds a frozen config, and turns seeds
    into outcomes, outcomes into rows and a few games worth watching, and all of that into figures.
    Outcomes are plain JSON values and games are recordings; both are on disk before anything is
    drawn, so that figures never need a run.

    Attributes
    ----------
    id : str
        The thesis's numbering, such as "table-6-3".
    title, claim, source : str
        What it shows, what the thesis says about it, and where.
    page : str
        Printed page or pages of the thesis; "about" where the scan leaves it open.
    expected : str
        What counts as reproduced, in a sentence.
    includes : tuple of str
        Other tables and figures that it shows besides; their ids lead here too.
    values, missing : str
        What the numbers are, and what it means that one is missing.
    default_seeds, quick_seeds : int
        How many seeds without and with `--quick`; one by default where chance has no hand in it.
    most_seeds : int or None
        How many at most in a chapter or in all, where a seed takes seconds; by its own id an
        experiment gets as many as are asked for.
    cost : float
        How long a seed keeps a core busy [s], about, where experiments before it in the list have
        learned what they share; from it the time that is left is estimated.
    """

    id: ClassVar[str]
    title: ClassVar[str]
    claim: ClassVar[str]
    source: ClassVar[str]
    includes: ClassVar[tuple[str, ...]] = ()
    values: ClassVar[str] = "times in seconds"
    missing: ClassVar[str] = "not caught"
    default_seeds: ClassVar[int] = 20
    quick_seeds: ClassVar[int] = 3
    most_seeds: ClassVar[int | None] = None
    cost: ClassVar[float]
    page: ClassVar[str] = ""
    expected: ClassVar[str] = ""

    @classmethod
    def chapter(cls) -> int:
        """Return the chapter that the id names."""
        return int(next(part for part in cls.id.split("-") if part.isdigit()))

    @abstractmethod
    def config(self) -> dict[str, Any]:
        """Return everything that the outcomes depend on besides seed and version."""

    @abstractmethod
    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Run one seed. Wall times go into the key "seconds" and nowhere else."""

    @abstractmethod
    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay the outcomes out as rows, with verdicts."""

    def games(
        self, outcomes: Sequence[dict[str, Any]], seeds: Sequence[int]
    ) -> Iterator[Recording]:
        """Play the games that are worth watching, once all seeds are done."""
        del outcomes, seeds
        yield from ()

    def controllers(self, result: Result) -> Iterator[tuple[str, FuzzyController]]:
        """Yield controllers that are worth keeping, each with what its file is called."""
        del result
        yield from ()

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw a saved result; yield each figure with what its file is called."""
        del result
        yield from ()


def published(experiment: str) -> dict[str, Any]:
    """Return what is printed in the thesis for an experiment; nothing where it has no numbers."""
    return _all_published().get(experiment, {})


@cache
def _all_published() -> dict[str, dict[str, Any]]:
    source = resources.files("fuzzyrs.experiments.reference").joinpath("published.json")
    numbers: dict[str, dict[str, Any]] = json.loads(source.read_text(encoding="utf-8"))
    return numbers


def median_seed(times: Sequence[Sequence[Value]]) -> int:
    """Return the index of the seed in the middle by its sum of times; escapes count as 1000 s."""
    sums = [sum(1000.0 if t is None else t for t in row) for row in times]
    return sums.index(statistics.median_low(sums))
