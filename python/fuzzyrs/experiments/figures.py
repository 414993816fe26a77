"""What figures are made of: panels, paths of games, controllers, curves with bands."""

from __future__ import annotations

import string
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fuzzyrs import plot
from fuzzyrs._fuzzyrs import TSK, Trajectory
from fuzzyrs.errors import from_kind
from fuzzyrs.recording import Recording, by_panel

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: The widths of one and of two columns of a journal [in].
SINGLE, DOUBLE = 3.5, 7.2

#: So many intervals between the ticks of a small panel, at most.
FEW = 5

#: How the players of one panel differ, from the last drawn to the first.
STYLES = ("-", "--", ":", "-.")

UNITS = ("angle δ [rad]", "rate dδ/dt [rad/s]")

#: What techniques are called in figures.
NAMES = {
    "pd": "PD",
    "pd_doubled": "PD, doubled gains",
    "anfis": "ANFIS",
    "ga": "GA",
    "ianfis": "IANFIS",
    "igbflc": "IGBFLC",
    "igbflc_thesis_operators": "IGBFLC, printed operators",
    "ianfis_target_expert": "IANFIS, expert as target",
    "q_lambda": "Q(λ)",
    "reward_ga": "reward GA",
    "reward_ga by place": "reward GA by place",
    "qlbgflc": "QLBGFLC",
    "qlbgflc by place": "QLBGFLC by place",
    "qlfis": "QLFIS",
    "dai": "Dai et al.",
    "qlfis with dai's noise": "QLFIS, Dai's noise",
    "dai with qlfis's noise": "Dai et al., QLFIS's noise",
}


def named(name: str) -> str:
    """Return what a technique is called in figures."""
    return NAMES.get(name, name)


def seeds_of(count: int) -> str:
    """Return how many seeds a figure shows."""
    return f"{count} {'seed' if count == 1 else 'seeds'}"


def panels(
    titles: Sequence[str],
    *,
    columns: int = 1,
    height: float = 2.4,
    wide: bool = False,
    **options: Any,
) -> tuple[Figure, list[Axes]]:
    """Return a figure with a panel for each title, lettered where there are several.

    One column of panels is as wide as a journal's column, unless it is to be wide; more are as wide
    as its page. The height is of each row [in]; options go to `Figure.subplots`.
    """
    plot.require_matplotlib()
    from matplotlib.figure import Figure

    rows = -(-len(titles) // columns)
    width = DOUBLE if wide or columns > 1 else SINGLE
    figure = Figure(figsize=(width, height * rows), layout="constrained")
    cells = list(figure.subplots(rows, columns, squeeze=False, **options).ravel())
    for cell in cells[len(titles) :]:
        cell.set_axis_off()
    for letter, cell, title in zip(string.ascii_lowercase, cells, titles, strict=False):
        cell.set_title(f"({letter}) {title}" if len(titles) > 1 else title)
    return figure, cells[: len(titles)]


def head(figure: Figure, title: str) -> None:
    """Put a title above all panels."""
    figure.suptitle(title[:1].upper() + title[1:])


def logarithmic(axes: Axes) -> None:
    """Make an x axis logarithmic, with plain numbers, if the values are far apart."""
    from matplotlib.ticker import LogLocator, NullLocator

    low, high = axes.dataLim.intervalx
    if low > 0 and high >= 5 * low:
        axes.set_xscale("log")
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 3.0)))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_locator(NullLocator())


def legend_below(figure: Figure, *, columns: int = 4) -> None:
    """Put a legend of everything that is labelled below the panels."""
    found: dict[str, Any] = {}
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            found.setdefault(label, handle)
    figure.legend(found.values(), found, loc="outside lower center", ncols=min(columns, len(found)))


def without_legend(axes: Axes) -> None:
    """Remove the legend of some axes, for one outside of all."""
    if legend := axes.get_legend():
        legend.remove()


def drawn_panels(games: Iterable[Recording]) -> dict[str, list[Recording]]:
    """Return the games of each panel, or say that there are none."""
    if shown := by_panel(games):
        return shown
    raise from_kind("format", "there are no recorded games to draw; reproduce it again")


def line_styles(games: Sequence[Recording]) -> list[Any]:
    """Return how the players of a panel differ: the last is drawn solid."""
    return [STYLES[index % len(STYLES)] for index in reversed(range(len(games)))]


def draw_games(
    games: Sequence[Recording], title: str, *, columns: int = 2, height: float = 3.4
) -> Figure:
    """Draw the paths of all robots, a panel for what is played, a line style for who plays.

    A cross marks a capture.
    """
    shown = drawn_panels(games)
    titles = [
        f"{panel}\n" + ", ".join(f"{game.label} {game.outcome(brief=True)}" for game in each)
        for panel, each in shown.items()
    ]
    figure, axes = panels(titles, columns=columns, height=height, wide=True)
    for cell, each in zip(axes, shown.values(), strict=True):
        for game, style in zip(each, line_styles(each), strict=True):
            plot.paths(game, ax=cell, style=style)
            if game.capture_time is not None:
                ends = [r.poses[-1, :2] for r in game.robots if r.role == "evader"]
                cell.plot(*np.transpose(ends), "kx", markersize=5, markeredgewidth=0.8)
        without_legend(cell)
        cell.locator_params(nbins=FEW)
    head(figure, title)
    largest = max(shown.values(), key=lambda each: len(each[0].robots))
    _legend_of_paths(figure, largest)
    return figure


def _legend_of_paths(figure: Figure, games: Sequence[Recording]) -> None:
    """Tell the robots by their colours and the players by their line styles."""
    from matplotlib.lines import Line2D

    order = plot.paths(games[0], ax=type(figure)().add_subplot(), label="").get_lines()
    robots = [
        Line2D([], [], color=line.get_color(), marker="o", label=line.get_label())
        for line in order
        if not str(line.get_label()).startswith("_")
    ]
    players = [
        Line2D([], [], color="0.3", linestyle=style, label=game.label)
        for game, style in zip(games, line_styles(games), strict=True)
    ]
    capture = Line2D([], [], color="k", marker="x", linestyle="", markersize=5, label="capture")
    handles = [*robots, *players, capture]
    figure.legend(handles=handles, loc="outside lower center", ncols=min(6, len(handles)))


def draw_distances(games: Sequence[Recording], title: str) -> Figure:
    """Draw how far the robots of each game are from each other over time."""
    shown = drawn_panels(games)
    figure, axes = panels(list(shown), columns=2, height=1.9, sharex=True, sharey=True)
    for cell, each in zip(axes, shown.values(), strict=True):
        for game, style in zip(each, line_styles(each), strict=True):
            cell.plot(times_of(game), distance(game), style, label=game.label)
        if radius := each[0].capture_radius:
            cell.axhline(radius, color="0.6", linewidth=0.8, linestyle="-", label="capture radius")
        cell.set(yscale="log", xlabel="time [s]", ylabel="distance [m]")
        cell.yaxis.set_major_formatter("{x:g}")
        cell.minorticks_off()
        cell.label_outer()
    head(figure, title)
    legend_below(figure)
    return figure


def pursuits(
    play: Callable[[Any, tuple[float, float]], Trajectory],
    players: Mapping[str, Any],
    starts: Iterable[tuple[float, float]],
    capture_radius: float,
) -> Iterator[Recording]:
    """Yield the games of some pursuers, by what they are called, from each start of the evader."""
    for start in starts:
        for label, player in players.items():
            yield Recording.of(
                play(player, start),
                label=label,
                panel=f"evader from ({start[0]:g}, {start[1]:g}) m",
                capture_radius=capture_radius,
            )


def wall_distance(game: Recording) -> np.ndarray[Any, Any]:
    """Return how far the robot is from its wall [m] at every pose."""
    assert game.wall is not None
    start, along = game.wall[:-1], np.diff(game.wall, axis=0)
    position = game.robots[0].poses[:, None, :2]
    share = ((position - start) * along).sum(axis=2) / (along**2).sum(axis=1)
    foot = start + np.clip(share, 0, 1)[..., None] * along
    distances: np.ndarray[Any, Any] = np.hypot(*np.moveaxis(position - foot, 2, 0)).min(axis=1)
    return distances


def distance(game: Recording) -> np.ndarray[Any, Any]:
    """Return how far the first two robots of a game are from each other [m]."""
    one, other = (robot.poses[:, :2] for robot in game.robots[:2])
    distances: np.ndarray[Any, Any] = np.hypot(*(one - other).T)
    return distances


def times_of(game: Recording) -> np.ndarray[Any, Any]:
    """Return the times of the poses of a game [s]."""
    return game.time_step * np.arange(len(game.robots[0].poses))


def draw_controller(system: TSK, title: str) -> Figure:
    """Draw the terms of both inputs and the surface of a robot's controller."""
    figure, axes = panels(["", "", "steering [rad]"], columns=3, height=2.5)
    for cell, variable, unit in zip(axes, system.inputs, UNITS, strict=False):
        plot.membership(variable, ax=cell)
        without_legend(cell)
        cell.set(xlabel=unit, ylabel="degree", ylim=(0, 1.05))
        cell.locator_params(nbins=FEW)
    legend_below(figure, columns=5)
    plot.surface(system, ax=axes[2], kind="heatmap", points=41)
    # Thousands of triangles are better kept as an image.
    axes[2].collections[0].set_rasterized(True)
    axes[2].set(xlabel=UNITS[0], ylabel=UNITS[1])
    axes[2].locator_params(nbins=FEW)
    figure.axes[-1].set_ylabel("")
    head(figure, title)
    return figure


def draw_curve(
    axes: Axes,
    x: Sequence[float],
    middle: Sequence[float],
    low: Sequence[float] | None = None,
    high: Sequence[float] | None = None,
    **options: Any,
) -> None:
    """Draw a curve and, if given, the band about it."""
    (line,) = axes.plot(x, middle, **options)
    if low is not None and high is not None:
        axes.fill_between(x, low, high, color=line.get_color(), alpha=0.15, linewidth=0)
