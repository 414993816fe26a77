"""Paths of robots."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fuzzyrs.plot._axes import colour, new_axes
from fuzzyrs.recording import Recording

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from fuzzyrs._fuzzyrs import ManyTrajectory, Trajectory, TwoPursuersTrajectory


def paths(
    trajectory: Trajectory | TwoPursuersTrajectory | ManyTrajectory | Recording,
    *,
    ax: Axes | None = None,
    label: str | None = None,
    style: str = "-",
    capture_radius: float | None = None,
) -> Axes:
    """Draw the paths of robots, each from a dot.

    Parameters
    ----------
    trajectory : Trajectory, TwoPursuersTrajectory, ManyTrajectory or Recording
        What to draw; of a recording also its wall.
    ax : matplotlib.axes.Axes, optional
        Where; new axes by default. Several games may share them.
    label : str, optional
        Put before "pursuer" and "evader" in the legend; a recording's own by default.
    style : str, optional
        The lines' style.
    capture_radius : float, optional
        If given, the circle in which a pursuer captures is drawn at the end of each one's path [m];
        a recording's own by default.

    Returns
    -------
    matplotlib.axes.Axes
    """
    ax = ax if ax is not None else new_axes()
    if isinstance(trajectory, Recording):
        label = trajectory.label if label is None else label
        if capture_radius is None:
            capture_radius = trajectory.capture_radius
        if trajectory.wall is not None:
            ax.plot(*trajectory.wall.T, "-", color="black", linewidth=0.8, label="wall")
    label = label or ""
    pursuers, evaders = _robots(trajectory, "pursuer"), _robots(trajectory, "evader")
    alone = _robots(trajectory, "robot") if isinstance(trajectory, Recording) else []
    # The first pursuer and the first evader look as those of a game of two.
    order = [*pursuers[:1], *evaders[:1], *pursuers[1:], *evaders[1:], *alone]
    colours = {who: colour(index) for index, (who, _) in enumerate(order)}
    for who, path in [*pursuers, *evaders, *alone]:
        ax.plot(path[:, 0], path[:, 1], style, color=colours[who], label=f"{label} {who}".strip())
        ax.plot(*path[0, :2], "o", color=colours[who], markersize=5)
    if capture_radius is not None:
        from matplotlib.patches import Circle

        for who, path in pursuers:
            x, y = path[-1, :2]
            ax.add_patch(Circle((x, y), capture_radius, fill=False, color=colours[who]))
    ax.set(xlabel="x [m]", ylabel="y [m]")
    ax.set_aspect("equal", adjustable="datalim")
    ax.legend(loc="best", fontsize="small")
    return ax


def _robots(trajectory: object, role: str) -> list[tuple[str, NDArray[np.float64]]]:
    """Return the name and the path of each robot that has a role; one alone has no number."""
    if isinstance(trajectory, Recording):
        return [(robot.name, robot.poses) for robot in trajectory.robots if robot.role == role]
    if hasattr(trajectory, role):
        return [(role, getattr(trajectory, role))]
    each = getattr(trajectory, f"{role}s")
    return [(f"{role} {index}", path) for index, path in enumerate(each, start=1)]
