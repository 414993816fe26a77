"""Outputs over two inputs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from fuzzyrs._fuzzyrs import TSK
from fuzzyrs.errors import from_kind
from fuzzyrs.plot._axes import new_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from fuzzyrs._fuzzyrs import System


def surface(
    system: System | TSK,
    *,
    axes: tuple[int | str, int | str] = (0, 1),
    at: dict[str, float] | None = None,
    output: str | None = None,
    kind: Literal["surface", "heatmap"] = "surface",
    ax: Axes | None = None,
    points: int = 61,
) -> Axes:
    """Draw an output of a system over two of its inputs.

    Parameters
    ----------
    system : System or TSK
        With at least two inputs.
    axes : (int or str, int or str), optional
        Which inputs, by number or name.
    at : dict of str to float, optional
        Where the other inputs are held; in the middle of their universes by default.
    output : str, optional
        Which output; the first by default.
    kind : "surface" or "heatmap", optional
        Three dimensions, or two with colours.
    ax : matplotlib.axes.Axes, optional
        Axes of as many dimensions; new ones by default.
    points : int, optional
        Points along each input.

    Returns
    -------
    matplotlib.axes.Axes
    """
    if kind not in {"surface", "heatmap"}:
        raise from_kind("unknown_name", f"unknown kind {kind!r}; known: surface, heatmap")
    inputs = system.inputs
    first, second = _numbers(system, axes)
    columns: list[Any] = [sum(variable.universe) / 2 for variable in inputs]
    for name, value in (at or {}).items():
        columns[_number(system, name)] = value
    columns[first], columns[second] = np.meshgrid(
        *(np.linspace(*inputs[axis].universe, points) for axis in (first, second))
    )
    index, output = _output(system, output)
    z = system(*columns)
    z = z if z.ndim == 2 else z[..., index]
    draw = _heatmap if kind == "heatmap" else _surface
    ax = draw(columns[first], columns[second], z, output, ax)
    ax.set(xlabel=inputs[first].name, ylabel=inputs[second].name)
    return ax


def _surface(x: Any, y: Any, z: Any, label: str, ax: Axes | None) -> Axes:
    ax = ax if ax is not None else new_axes(projection="3d")
    drawing: Any = ax  # matplotlib's types do not know the third dimension
    drawing.plot_surface(x, y, z, cmap="viridis", linewidth=0)
    drawing.set(zlabel=label)
    return ax


def _heatmap(x: Any, y: Any, z: Any, label: str, ax: Axes | None) -> Axes:
    ax = ax if ax is not None else new_axes()
    colours = ax.pcolormesh(x, y, z, cmap="viridis", shading="gouraud")
    ax.figure.colorbar(colours, ax=ax, label=label)
    return ax


def _numbers(system: System | TSK, axes: tuple[int | str, int | str]) -> tuple[int, int]:
    """Return the numbers of two different inputs."""
    count = len(system.inputs)
    if count < 2:
        message = f"a surface needs two inputs; {system.name!r} has {count}"
        raise from_kind("wrong_shape", message)
    first, second = (_number(system, a) if isinstance(a, str) else a for a in axes)
    if first == second or not all(0 <= axis < count for axis in (first, second)):
        message = f"axes must be two different inputs from 0 to {count - 1}, got {axes}"
        raise from_kind("out_of_range", message)
    return first, second


def _number(system: System | TSK, name: str) -> int:
    names = [variable.name for variable in system.inputs]
    if name not in names:
        message = f"{system.name!r} has no input {name!r}; known: {', '.join(names)}"
        raise from_kind("unknown_name", message)
    return names.index(name)


def _output(system: System | TSK, name: str | None) -> tuple[int, str]:
    """Return the number of an output and its name."""
    if isinstance(system, TSK):
        names = [system.output]
    else:
        names = [output.name for output in system.outputs]
    name = names[0] if name is None else name
    if name not in names:
        message = f"{system.name!r} has no output {name!r}; known: {', '.join(names)}"
        raise from_kind("unknown_name", message)
    return names.index(name), name
