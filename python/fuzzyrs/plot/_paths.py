"""Paths of robots."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fuzzyrs.plot._axes import COLOURS, new_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from fuzzyrs._fuzzyrs import Trajectory


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
    ax = ax if ax is not None else new_axes()
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
