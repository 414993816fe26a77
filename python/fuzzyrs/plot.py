"""Plots of systems and games. They need matplotlib: ``pip install "fuzzyrs[plot]"``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fuzzyrs.errors import from_kind

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from fuzzyrs._fuzzyrs import TSK, Trajectory, Variable

__all__ = ["membership", "paths", "surface"]

# Okabe and Ito's colours, which colour-blind people can tell apart.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]


def require_matplotlib() -> None:
    """Raise ImportError that says what to install, if matplotlib is missing."""
    try:
        import matplotlib  # noqa: F401
    except ImportError as error:
        raise ImportError(
            'plotting needs matplotlib; install it with: pip install "fuzzyrs[plot]"'
        ) from error


def _new_axes(**options: Any) -> Axes:
    require_matplotlib()
    from matplotlib import pyplot

    axes: Axes = pyplot.figure().add_subplot(**options)
    return axes


def membership(variable: Variable, *, ax: Axes | None = None, points: int = 501) -> Axes:
    """Draw the membership functions of a variable over its universe.

    Parameters
    ----------
    variable : Variable
        What to draw.
    ax : matplotlib.axes.Axes, optional
        Where; new axes by default.
    points : int, optional
        Points of each curve.

    Returns
    -------
    matplotlib.axes.Axes
    """
    ax = ax if ax is not None else _new_axes()
    x = np.linspace(*variable.universe, points)
    for index, (name, degrees) in enumerate(
        zip(variable.terms, variable.degrees(x).T, strict=True)
    ):
        ax.plot(x, degrees, label=name, color=COLOURS[index % len(COLOURS)])
    ax.set(xlabel=variable.name, ylabel="degree", xlim=variable.universe, ylim=(0, 1.05))
    ax.legend(loc="best", fontsize="small")
    return ax


def surface(
    system: TSK,
    *,
    axes: tuple[int, int] = (0, 1),
    at: dict[str, float] | None = None,
    ax: Axes | None = None,
    points: int = 61,
) -> Axes:
    """Draw the output of a system over two of its inputs.

    Parameters
    ----------
    system : TSK
        With at least two inputs.
    axes : (int, int), optional
        Which inputs.
    at : dict of str to float, optional
        Where the other inputs are held; in the middle of their universes by default.
    ax : matplotlib.axes.Axes, optional
        Three-dimensional axes; new ones by default.
    points : int, optional
        Points along each input.

    Returns
    -------
    matplotlib.axes.Axes
    """
    inputs = system.inputs
    held = at or {}
    names = [variable.name for variable in inputs]
    if len(inputs) < 2:
        message = f"a surface needs two inputs; {system.name!r} has {len(inputs)}"
        raise from_kind("wrong_shape", message)
    if len(set(axes)) < 2 or not all(0 <= axis < len(inputs) for axis in axes):
        message = f"axes must be two different inputs from 0 to {len(inputs) - 1}, got {axes}"
        raise from_kind("out_of_range", message)
    if unknown := sorted(set(held) - set(names)):
        message = f"{system.name!r} has no input {unknown[0]!r} to hold; known: {', '.join(names)}"
        raise from_kind("unknown_name", message)
    grids = np.meshgrid(*(np.linspace(*inputs[axis].universe, points) for axis in axes))
    columns: list[Any] = [held.get(v.name, sum(v.universe) / 2) for v in inputs]
    for axis, grid in zip(axes, grids, strict=True):
        columns[axis] = grid
    z = system(*columns)

    ax = ax if ax is not None else _new_axes(projection="3d")
    drawing: Any = ax  # matplotlib's types do not know the third dimension
    drawing.plot_surface(*grids, z, cmap="viridis", linewidth=0)
    drawing.set(xlabel=inputs[axes[0]].name, ylabel=inputs[axes[1]].name, zlabel=system.output)
    return ax


def paths(
    trajectory: Trajectory,
    *,
    ax: Axes | None = None,
    label: str = "",
    style: str = "-",
    capture_radius: float | None = None,
) -> Axes:
    """Draw the paths of a pursuer and an evader.

    Parameters
    ----------
    trajectory : Trajectory
        What to draw.
    ax : matplotlib.axes.Axes, optional
        Where; new axes by default. Several games may share them.
    label : str, optional
        Put before "pursuer" and "evader" in the legend.
    style : str, optional
        The lines' style.
    capture_radius : float, optional
        If given, the circle in which the pursuer captures is drawn at the end [m].

    Returns
    -------
    matplotlib.axes.Axes
    """
    ax = ax if ax is not None else _new_axes()
    robots = [("pursuer", trajectory.pursuer), ("evader", trajectory.evader)]
    for colour, (who, path) in zip(COLOURS, robots, strict=False):
        ax.plot(path[:, 0], path[:, 1], style, color=colour, label=f"{label} {who}".strip())
        ax.plot(*path[0, :2], "o", color=colour, markersize=5)
    if capture_radius is not None:
        from matplotlib.patches import Circle

        x, y = trajectory.pursuer[-1, :2]
        ax.add_patch(Circle((x, y), capture_radius, fill=False, color=COLOURS[0]))
    ax.set(xlabel="x [m]", ylabel="y [m]")
    ax.set_aspect("equal", adjustable="datalim")
    ax.legend(loc="best", fontsize="small")
    return ax
