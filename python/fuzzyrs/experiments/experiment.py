"""What an experiment is."""

from __future__ import annotations

import json
import os
import statistics
from abc import ABC, abstractmethod
from functools import cache
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from fuzzyrs.errors import from_kind

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from matplotlib.figure import Figure

    from fuzzyrs._fuzzyrs import Control
    from fuzzyrs.experiments.result import Row, Value


class Experiment(ABC):
    """One table or figure of the thesis.

    A subclass says what it is in its class attributes, holds a frozen config, and turns seeds
    into outcomes, outcomes into rows and rows into figures. Outcomes are plain JSON values, so
    that an interrupted run can be taken up again; everything after them is a function of them.

    Attributes
    ----------
    id : str
        The thesis's numbering, such as "table-6-3".
    title, claim, source : str
        What it shows, what the thesis says about it, and where.
    includes : tuple of str
        Other tables and figures that it shows besides; their ids lead here too.
    values, missing : str
        What the numbers are, and what it means that one is missing.
    default_seeds, quick_seeds : int
        How many seeds without and with `--quick`.
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

    @abstractmethod
    def config(self) -> dict[str, Any]:
        """Return everything that the outcomes depend on besides seed and version."""

    @abstractmethod
    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Run one seed. Wall times go into the key "seconds" and nowhere else."""

    @abstractmethod
    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay the outcomes out as rows, with verdicts."""

    def draw(
        self,
        outcomes: Sequence[dict[str, Any]],
        seeds: Sequence[int],
        folder: Path,
    ) -> Iterator[Path]:
        """Write figures and other files into a folder, and yield the path of each."""
        del outcomes, seeds, folder
        yield from ()


def save_figure(figure: Figure, path: Path) -> Path:
    """Write a figure as PNG so that the file is whole or not there, and return its path."""
    part = path.with_name(f"{path.name}.{os.getpid()}.part")
    try:
        figure.savefig(part, dpi=150, format="png")
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        message = f"cannot write {path}: {error.strerror or error}"
        raise from_kind("file", message) from error
    return path


@cache
def published(experiment: str) -> dict[str, Any]:
    """Return what is printed in the thesis for an experiment."""
    source = resources.files("fuzzyrs.experiments.reference").joinpath("published.json")
    numbers: dict[str, Any] = json.loads(source.read_text(encoding="utf-8"))[experiment]
    return numbers


def median_seed(times: Sequence[Sequence[Value]]) -> int:
    """Return the index of the seed in the middle by its sum of times; escapes count as 1000 s."""
    sums = [sum(1000.0 if t is None else t for t in row) for row in times]
    return sums.index(statistics.median_low(sums))
