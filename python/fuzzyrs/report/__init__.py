"""The report: what saved results say, as one page that needs nothing beside it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from fuzzyrs._fuzzyrs import __version__, write_text
from fuzzyrs._html import asset, document, element
from fuzzyrs.animation import player
from fuzzyrs.experiments import find, ids
from fuzzyrs.experiments.claims import all_claims, judge
from fuzzyrs.experiments.experiment import Experiment
from fuzzyrs.report.entries import collect
from fuzzyrs.report.overview import header, navigation, overview
from fuzzyrs.report.sections import chapters

__all__ = ["build"]

NAME = "report.html"


def build(
    folder: Path,
    *,
    experiments: Sequence[Experiment] | None = None,
    progress: Callable[[str], None] | None = None,
) -> Path:
    """Write `report.html` from the results in a folder, and return its path.

    Figures that are missing, or of another result, are drawn first. The same results give
    the same page, but for times and machines.

    Parameters
    ----------
    folder : pathlib.Path
        With what `reproduce` saved.
    experiments : sequence of Experiment, optional
        Which ones the report is about; all by default.
    progress : callable, optional
        Called with the id of each experiment before it is read.

    Raises
    ------
    FileError
        If the folder has no result of any of them, or cannot be written.
    """
    if experiments is None:
        experiments = [find(identifier)() for identifier in ids()]
    entries = collect(folder, experiments, progress)
    results = {entry.id: entry.result for entry in entries if entry.result is not None}
    claims = [judge(claim, results) for claim in all_claims()]
    page = document(
        "fuzzyrs: the thesis reproduced",
        [
            header(),
            navigation(entries),
            element("main", *overview(entries, claims), *chapters(entries)),
        ],
        styles=[asset(__name__, "assets/report.css"), player.styles()],
        scripts=[player.scripts(), asset(__name__, "assets/report.js")],
        about={"generator": f"fuzzyrs {__version__}"},
    )
    path = folder / NAME
    write_text(path, page)
    return path
