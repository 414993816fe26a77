"""What a folder holds of each experiment."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from fuzzyrs.errors import FileError, FormatError, FuzzyrsError, from_kind
from fuzzyrs.experiments.drawing import draw, figures_of
from fuzzyrs.experiments.experiment import Experiment
from fuzzyrs.experiments.result import Result
from fuzzyrs.experiments.saved import DATABASE, build, load, load_shown, load_table, saved_ids


@dataclass(frozen=True)
class Entry:
    """An experiment's part in the report.

    Attributes
    ----------
    experiment : Experiment
        Which one.
    result : Result or None
        What was saved; None if it was not run, or if the files cannot be used.
    problem : str
        Why files cannot be used, or why there are no figures.
    figures : tuple of pathlib.Path
        The figures, without an ending.
    """

    experiment: Experiment
    result: Result | None = None
    problem: str = ""
    figures: tuple[Path, ...] = ()

    @property
    def note(self) -> str:
        """What one should know of the result, if anything."""
        if self.result is None or self.result.run.get("build") == build():
            return ""
        return "Made by another build of fuzzyrs."

    @property
    def id(self) -> str:
        """The experiment's."""
        return self.experiment.id

    @property
    def verdicts(self) -> list[str]:
        """The rows' verdicts."""
        return [] if self.result is None else [row.verdict for row in self.result.rows]


def collect(
    folder: Path,
    experiments: Sequence[Experiment],
    progress: Callable[[str], None] | None = None,
) -> list[Entry]:
    """Read the results of experiments, and draw the figures that are missing.

    Raises
    ------
    FileError
        If there is no result of any of them.
    """
    there = set(saved_ids(folder, [experiment.id for experiment in experiments]))
    if not there:
        message = f"{folder} has no results; make some with: fuzzyrs reproduce all --out {folder}"
        raise from_kind("file", message)
    entries = []
    for experiment in experiments:
        if experiment.id not in there:
            entries.append(Entry(experiment))
            continue
        if progress is not None:
            progress(experiment.id)
        entries.append(_entry(folder, experiment))
    return entries


def _entry(folder: Path, experiment: Experiment) -> Entry:
    result, problem = _readable(folder, experiment)
    if result is None:
        return Entry(experiment, problem=problem)
    figures = figures_of(folder, result)
    if figures is None:
        try:
            for _ in draw(experiment, load(folder, experiment), folder):
                pass
        except (ImportError, FuzzyrsError) as error:
            problem = problem or f"no figures: {error}"
        except (LookupError, TypeError, ValueError, AttributeError) as error:
            problem = (
                f"no figures: its seeds in {DATABASE} are damaged ({error!r}); "
                "reproduce it again with --no-resume"
            )
        figures = figures_of(folder, result)
    return Entry(experiment, result, problem, tuple(figures or ()))


def _readable(folder: Path, experiment: Experiment) -> tuple[Result | None, str]:
    """Return what can be used of a saved result, and what is wrong with the rest."""
    try:
        return load_shown(folder, experiment), ""
    except (FileError, FormatError) as error:
        problem = str(error)
    try:
        return load_table(folder, experiment), problem
    except (FileError, FormatError):
        return None, problem
