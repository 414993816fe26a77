"""The results of a study as columns."""

from __future__ import annotations

import csv
import importlib
import io
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fuzzyrs._fuzzyrs import write_text
from fuzzyrs.studies.settings import unknown
from fuzzyrs.studies.store import Outcome, Run

if TYPE_CHECKING:
    import pandas
    import polars

    from fuzzyrs.experiments.statistics import Paired
    from fuzzyrs.studies.summary import Summary


@dataclass(frozen=True)
class StudyResults:
    """The finished runs of a study, point by point and seed by seed.

    Attributes
    ----------
    name : str
        The study's name in its database.
    database : pathlib.Path
        The database.
    parameters : list of str
        What the grid is of.
    runs : list of Run
        In the order of the grid and of the seeds.
    """

    name: str
    database: Path
    parameters: list[str]
    runs: list[Run]

    def __repr__(self) -> str:
        failed = len(self.failures())
        also = f", {failed} of them failed" if failed else ""
        return f"<StudyResults {self.name!r}: {len(self.runs)} runs{also}>"

    def failures(self) -> list[Run]:
        """Return the runs that raised an exception, which `columns` leaves out."""
        return [run for run in self.runs if run.error is not None]

    def columns(self) -> dict[str, np.ndarray[Any, Any]]:
        """Return the runs as arrays of one length: parameters, seed, outcomes and seconds.

        A number that a run doesn't have is NaN. Columns of texts, of True and False, or of None are
        arrays of what they are. What is nested has names like "times.ours[2]".
        """
        runs = self._successes()
        columns: dict[str, list[Any]] = {
            parameter: [run.point[parameter] for run in runs] for parameter in self.parameters
        }
        columns["seed"] = [run.seed for run in runs]
        for name, values in self._outcomes().items():
            # A parameter of the same name stays what it is.
            key = f"outcome: {name}" if name in columns or name == "seconds" else name
            columns[key] = values
        columns["seconds"] = [run.seconds for run in runs]
        return {name: _array(values) for name, values in columns.items()}

    def summary(self) -> list[Summary]:
        """Return median, interquartile mean and its 95 % interval, over the seeds of each point.

        Outcomes that are no numbers in any run are left out; True and False count as 1 and 0.
        """
        # It needs the experiments' statistics, which need the studies' database.
        from fuzzyrs.studies.summary import summarise

        points = [run.point for run in self._successes()]
        columns = {name: _array(values) for name, values in self._outcomes().items()}
        return summarise(points, columns)

    def compare(
        self, measure: str, first_point: Mapping[str, Any], second_point: Mapping[str, Any]
    ) -> Paired:
        """Compare an outcome at two points of the grid, on the same seeds.

        Parameters
        ----------
        measure : str
            The outcome, called as in `summary`.
        first_point, second_point : dict
            Values of the parameters that tell each point from all others.

        Returns
        -------
        fuzzyrs.experiments.Paired
            On how many seeds the first point's value is smaller, and by how much, with intervals.
            Only seeds that have a number at both points are counted; there are `count` of them.

        Raises
        ------
        UnknownNameError
            If there is no such outcome, parameter or point.
        InvalidValueError
            If the values fit several points, or no seed has a number at both.
        """
        # It needs the experiments' statistics, which need the studies' database.
        from fuzzyrs.studies.comparison import compare
        from fuzzyrs.studies.summary import numbers

        outcomes = self._outcomes()
        if measure not in outcomes:
            raise unknown("outcome", measure, outcomes)
        runs = self._successes()
        values = numbers(_array(outcomes[measure])).tolist()
        seeds = [run.seed for run in runs]
        return compare([run.point for run in runs], seeds, values, first_point, second_point)

    def _successes(self) -> list[Run]:
        return [run for run in self.runs if run.error is None]

    def _outcomes(self) -> dict[str, list[Any]]:
        """Return the plain values in all outcomes by name, None where a run has none."""
        outcomes = [dict(_leaves("", run.outcome)) for run in self._successes()]
        names = dict.fromkeys(name for outcome in outcomes for name in outcome)
        columns = {name: [outcome.get(name) for outcome in outcomes] for name in names}
        # What no run has was to be a number.
        nothing = {
            name: [np.nan] * len(outcomes)
            for name, values in columns.items()
            if all(value is None for value in values)
        }
        return columns | nothing

    def to_csv(self, path: str | Path | None = None) -> str | None:
        """Write the columns to a file as a whole, or return them as text."""
        columns = self.columns()
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*(column.tolist() for column in columns.values()), strict=True))
        if path is None:
            return text.getvalue()
        write_text(Path(path), text.getvalue())
        return None

    def to_pandas(self) -> pandas.DataFrame:
        """Return the columns as a data frame of pandas, which must be installed."""
        frame: pandas.DataFrame = _library("pandas").DataFrame(self.columns())
        return frame

    def to_polars(self) -> polars.DataFrame:
        """Return the columns as a data frame of polars, which must be installed."""
        columns = {name: column.tolist() for name, column in self.columns().items()}
        frame: polars.DataFrame = _library("polars").DataFrame(columns)
        return frame


def _library(name: str) -> Any:
    """Import a library of data frames, or say what to install."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        message = f"a data frame of {name} needs {name}; install it with: pip install {name}"
        raise ImportError(message) from error


def _leaves(name: str, outcome: Outcome) -> Iterator[tuple[str, Any]]:
    """Yield the plain values of an outcome and where they stand."""
    if isinstance(outcome, dict):
        for key, value in outcome.items():
            yield from _leaves(f"{name}.{key}" if name else key, value)
    elif isinstance(outcome, list):
        for index, value in enumerate(outcome):
            yield from _leaves(f"{name}[{index}]", value)
    else:
        yield name or "value", outcome


def _array(values: Sequence[Any]) -> np.ndarray[Any, Any]:
    """Return values as an array of their kind; missing numbers become NaN."""
    kinds = {type(value) for value in values}
    if kinds <= {int, float, type(None)} and kinds != {type(None)}:
        if kinds == {int}:
            return np.array(values)
        return np.array([np.nan if value is None else value for value in values], dtype=float)
    return np.array(values) if len(kinds) <= 1 else np.array(values, dtype=object)
