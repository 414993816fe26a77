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
    from numpy.typing import NDArray

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
        _draw_values(cell, panel.strips)
        _draw_means(cell, panel.strips)
        _tell_missing(cell, panel.strips, missing)
        cell.set_yticks(range(len(panel.strips)), [strip.name for strip in panel.strips])
        cell.set(ylim=(len(panel.strips) - 0.4, -0.6), xlabel=panel.unit)
        cell.tick_params(axis="y", length=0)
        cell.grid(axis="y", color="0.9", linewidth=0.5)
        cell.set_axisbelow(True)
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


def _draw_values(cell: Axes, strips: Sequence[Strip]) -> None:
    """Draw the values of all seeds, and the print."""
    shown: list[tuple[float, float]] = []
    printed: list[tuple[float, float]] = []
    for place, strip in enumerate(strips):
        values = [v for seed in strip.row.per_seed if (v := seed[strip.index]) is not None]
        # Golden steps spread points evenly and are the same in every drawing.
        across = place + 0.5 * ((np.arange(len(values)) * 0.618034) % 1.0 - 0.5)
        shown += zip(values, across.tolist(), strict=True)
        if (value := strip.row.published[strip.index]) is not None:
            printed.append((value, place))
    cell.plot(*_columns(shown), "o", color=plot.COLOURS[5], markersize=2, alpha=0.6, zorder=1)
    if printed:
        cell.plot(*_columns(printed), zorder=4, **PRINTED)


def _draw_means(cell: Axes, strips: Sequence[Strip]) -> None:
    """Draw the interquartile means, and their intervals where both ends are numbers."""
    means, intervals = [], []
    for place, strip in enumerate(strips):
        mean = strip.row.interquartile_mean[strip.index]
        if mean is None:
            continue
        means.append((mean, place))
        low, high = strip.row.interval[strip.index]
        if low is not None and high is not None:
            intervals.append((place, low, high))
    cell.plot(*_columns(means), "|", color="k", markersize=8, zorder=3)
    if intervals:
        places, lows, highs = zip(*intervals, strict=True)
        cell.hlines(places, lows, highs, colors="k", linewidth=1.5, zorder=3)


def _tell_missing(cell: Axes, strips: Sequence[Strip], missing: str) -> None:
    """Tell beside a strip how many seeds have no value."""
    for place, strip in enumerate(strips):
        if absent := strip.row.missing(strip.index):
            cell.annotate(
                f"{absent} {missing}",
                (1.01, place),
                xycoords=("axes fraction", "data"),
                va="center",
                fontsize=6,
                color="0.3",
            )


def _columns(points: Sequence[tuple[float, float]]) -> NDArray[np.float64]:
    """Return the coordinates of some points, x first."""
    columns: NDArray[np.float64] = np.array(points, dtype=float).reshape(-1, 2).T
    return columns


def _legend_of_strips(figure: Figure, printed: bool) -> None:
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], color=plot.COLOURS[5], marker="o", linestyle="", label="a seed"),
        Line2D([], [], color="k", marker="|", markersize=7, label="interquartile mean, 95 %"),
    ]
    if printed:
        handles.append(Line2D([], [], **PRINTED))
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
