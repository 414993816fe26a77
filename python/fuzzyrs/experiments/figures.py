"""Figures that several experiments draw alike."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from fuzzyrs import plot
from fuzzyrs._fuzzyrs import TSK, Trajectory
from fuzzyrs.experiments.experiment import save_figure

UNITS = ("angle δ [rad]", "rate dδ/dt [rad/s]")


def draw_controller(system: TSK, title: str, path: Path) -> Path:
    """Save the terms of both inputs and the surface of a robot's controller."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11, 3.6), layout="constrained")
    for index, (variable, unit) in enumerate(zip(system.inputs, UNITS, strict=True)):
        terms = plot.membership(variable, ax=figure.add_subplot(1, 3, index + 1))
        terms.set_xlabel(unit)
    surface: Any = plot.surface(system, ax=figure.add_subplot(1, 3, 3, projection="3d"))
    surface.set(xlabel="angle [rad]", ylabel="rate [rad/s]", zlabel="steering [rad]")
    surface.set_box_aspect(None, zoom=0.8)
    figure.suptitle(title)
    return save_figure(figure, path)


def draw_pursuits(
    players: Mapping[str, Callable[[tuple[float, float]], Trajectory]],
    starts: Sequence[tuple[float, float]],
    radius: float,
    title: str,
    path: Path,
) -> Path:
    """Save the paths of two players from four starts of the evader, dashed and solid.

    A player is what plays a game from a start; the circle has the capture radius.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 8), layout="constrained")
    for index, start in enumerate(starts):
        axes = figure.add_subplot(2, 2, index + 1)
        for (label, play), style in zip(players.items(), ["--", "-"], strict=True):
            played = play(start)
            plot.paths(played, ax=axes, label=label, style=style, capture_radius=radius)
            end = "not caught" if played.capture_time is None else f"{played.capture_time:.1f} s"
            axes.plot([], [], " ", label=f"{label}: {end}")
        axes.legend(loc="best", fontsize="x-small")
        axes.set_title(f"evader from ({start[0]:g}, {start[1]:g}) m")
    figure.suptitle(title)
    return save_figure(figure, path)
