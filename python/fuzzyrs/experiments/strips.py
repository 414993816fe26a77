"""Figures of tables: the values of all seeds beside the print."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fuzzyrs import plot
from fuzzyrs.experiments.figures import FEW, head, logarithmic, named, panels
from fuzzyrs.experiments.result import Row

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: How printed values look beside ours.
PRINTED: dict[str, Any] = {
    "color": plot.COLOURS[1],
    "marker": "D",
    "markersize": 4.5,
    "markerfacecolor": "none",
    "linestyle": "",
    "label": "printed",
}


@dataclass(frozen=True)
class Strip:
    """The values of all seeds under one name, and what is printed."""

    name: str
    row: Row
    index: int


@dataclass(frozen=True)
class Strips:
    """A panel of values: what they are, and a strip for each name."""

    title: str
    unit: str
    strips: Sequence[Strip]


def by_columns(rows: Sequence[Row], unit: str = "", titles: Sequence[str] = ()) -> list[Strips]:
    """Return a panel for each column; the rows are what is compared."""
    columns = rows[0].columns
    return [
        Strips(title, unit, [Strip(named(row.name), row, index) for row in rows])
        for index, title in enumerate(titles or columns)
    ]


def by_rows(rows: Sequence[Row], unit: str = "", titles: Sequence[str] = ()) -> list[Strips]:
    """Return a panel for each row; the columns are what is compared."""
    return [
        Strips(
            title,
            unit,
            [Strip(named(column), row, index) for index, column in enumerate(row.columns)],
        )
        for row, title in zip(rows, titles or [row.name for row in rows], strict=True)
    ]


def draw_strips(
    shown: Sequence[Strips],
    title: str,
    *,
    columns: int = 2,
    missing: str = "not caught",
    log: bool = False,
    reference: float | None = None,
) -> Figure:
    """Draw the values of all seeds, their interquartile means with 95 % intervals, and the print.

    `missing` is what it means that a seed has no value; a line is drawn at the reference.
    """
    count = max(len(panel.strips) for panel in shown)
    columns = min(columns, len(shown))
    titles = [panel.title for panel in shown]
    same = len({tuple(strip.name for strip in panel.strips) for panel in shown}) == 1
    figure, axes = panels(
        titles, columns=columns, height=1.05 + 0.23 * count, sharey=same and columns > 1
    )
    for cell, panel in zip(axes, shown, strict=True):
        for place, strip in enumerate(panel.strips):
            _draw_strip(cell, place, strip, missing)
        cell.set_yticks(range(len(panel.strips)), [strip.name for strip in panel.strips])
        cell.set(ylim=(len(panel.strips) - 0.4, -0.6), xlabel=panel.unit)
        cell.tick_params(axis="y", length=0)
        cell.spines["left"].set_visible(False)
        cell.locator_params(axis="x", nbins=FEW)
        if log:
            logarithmic(cell)
        if reference is not None:
            cell.axvline(reference, color="0.5", linewidth=0.8, linestyle="-", zorder=0)
        cell.margins(x=0.08)
    head(figure, title)
    strips = [strip for panel in shown for strip in panel.strips]
    _legend_of_strips(figure, any(s.row.published[s.index] is not None for s in strips))
    return figure


def _draw_strip(cell: Axes, place: int, strip: Strip, missing: str) -> None:
    row, index = strip.row, strip.index
    cell.axhline(place, color="0.9", linewidth=0.5, zorder=0)
    values = [value for seed in row.per_seed if (value := seed[index]) is not None]
    # Golden steps spread points evenly and are the same in every drawing.
    across = place + 0.5 * ((np.arange(len(values)) * 0.618034) % 1.0 - 0.5)
    cell.plot(values, across, "o", color=plot.COLOURS[5], markersize=2, alpha=0.6, zorder=1)
    mean, (low, high) = row.interquartile_mean[index], row.interval[index]
    if mean is not None:
        cell.plot(mean, place, "|", color="k", markersize=8, zorder=3)
        if low is not None and high is not None:
            cell.plot([low, high], [place, place], "-", color="k", linewidth=1.5, zorder=3)
    printed = row.published[index]
    if printed is not None:
        cell.plot(printed, place, zorder=4, **PRINTED)
    if absent := row.missing(index):
        cell.annotate(
            f"{absent} {missing}",
            (1.01, place),
            xycoords=("axes fraction", "data"),
            va="center",
            fontsize=6,
            color="0.3",
        )


def _legend_of_strips(figure: Figure, printed: bool) -> None:
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], color=plot.COLOURS[5], marker="o", linestyle="", label="a seed"),
        Line2D([], [], color="k", marker="|", markersize=7, label="interquartile mean, 95 %"),
    ]
    if printed:
        handles.append(Line2D([], [], **PRINTED))
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
