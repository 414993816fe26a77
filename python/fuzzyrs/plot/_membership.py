"""Membership functions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, overload

import numpy as np

from fuzzyrs._fuzzyrs import TSK, Output, System
from fuzzyrs.errors import from_kind
from fuzzyrs.plot._axes import colour, new_axes, new_grid

if TYPE_CHECKING:
    from collections.abc import Iterable

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from fuzzyrs._fuzzyrs import MembershipFunction, Variable

# The most plots of a system beside one another, and names above each.
_COLUMNS, _LEGEND = 3, 4


@overload
def membership(what: Variable | Output, *, ax: Axes | None = None, points: int = 501) -> Axes: ...
@overload
def membership(what: System | TSK, *, ax: None = None, points: int = 501) -> NDArray[Any]: ...
def membership(
    what: Variable | Output | System | TSK, *, ax: Axes | None = None, points: int = 501
) -> Axes | NDArray[Any]:
    """Draw the membership functions of a variable over its universe.

    Of an output that concludes numbers the constants are drawn; functions of the inputs stand in
    the legend.

    Parameters
    ----------
    what : Variable, Output, System or TSK
        What to draw; of a system all inputs and outputs in a new figure. A TSK's output has no
        terms.
    ax : matplotlib.axes.Axes, optional
        Where; new axes by default. Not for a system.
    points : int, optional
        Points of each curve. Corners are added.

    Returns
    -------
    matplotlib.axes.Axes or numpy.ndarray of them
    """
    if isinstance(what, (System, TSK)):
        if ax is not None:
            message = f"the system {what.name!r} is drawn in a figure of its own, without ax"
            raise from_kind("wrong_type", message)
        return _all_of(what, points)
    ax = ax if ax is not None else new_axes()
    _draw(what, ax, points)
    _legend(ax, loc="best")
    return ax


def _all_of(system: System | TSK, points: int) -> NDArray[Any]:
    """Draw the inputs and then the outputs of a system."""
    parts: list[Variable | Output] = list(system.inputs)
    if isinstance(system, System):
        parts.extend(system.outputs)
    columns = min(len(parts), _COLUMNS)
    rows = -(-len(parts) // columns)
    cells = new_grid(rows, columns, figsize=(4.2 * columns, 2.8 * rows)).ravel()
    for part, cell in zip(parts, cells, strict=False):
        _draw(part, cell, points)
        place = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "frameon": False}
        _legend(cell, **place, ncols=_LEGEND, columnspacing=1.0)
    for cell in cells[len(parts) :]:
        cell.set_axis_off()
    cells[0].figure.suptitle(system.name)
    return cells[: len(parts)]


def _legend(ax: Axes, **options: Any) -> None:
    # an input may have no terms, and matplotlib warns of a legend of nothing
    if ax.get_legend_handles_labels()[1]:
        ax.legend(**options, fontsize="small")


def _draw(what: Variable | Output, ax: Axes, points: int) -> None:
    """Draw everything but the legend."""
    ax.set(xlabel=what.name, ylim=(0, 1.05))
    if isinstance(what, Output) and what.variable is None:
        _numbers(what, ax)
    else:
        variable: Any = what.variable if isinstance(what, Output) else what
        _curves(variable, ax, points)
        ax.set_ylabel("degree")


def _curves(variable: Variable, ax: Axes, points: int) -> None:
    x = places(variable.universe, variable.terms.values(), points)
    for index, (name, degrees) in enumerate(
        zip(variable.terms, variable.degrees(x).T, strict=True)
    ):
        ax.plot(x, degrees, label=name, color=colour(index))
    ax.set_xlim(variable.universe)


def _numbers(output: Output, ax: Axes) -> None:
    """Draw the constants that rules may conclude."""
    for index, (name, value) in enumerate(output.terms.items()):
        if isinstance(value, float):
            style: Any = {"marker": "o", "markevery": [1], "color": colour(index)}
            ax.plot([value, value], [0, 1], label=f"{name} = {value:.4g}", **style)
        else:
            said = value if isinstance(value, str) else "linear"
            ax.plot([], [], " ", label=f"{name}: {said}")
    ax.set_yticks([])


def places(
    universe: tuple[float, float], functions: Iterable[MembershipFunction], points: int
) -> NDArray[np.float64]:
    """Return numbers that show every corner and jump of functions over a universe."""
    corners = np.concatenate([[], *(_corners(function) for function in functions)])
    beside = [np.nextafter(corners, end) for end in (-np.inf, np.inf)]
    x = np.unique(np.concatenate([np.linspace(*universe, points), corners, *beside]))
    return x[(universe[0] <= x) & (x <= universe[1])]


def _corners(function: MembershipFunction) -> NDArray[np.float64]:
    if function.vertices is not None:
        return function.vertices[:, 0]
    parameters = list(function.parameters.values())
    return np.array(parameters[:1] if function.shape in {"singleton", "step"} else [])
