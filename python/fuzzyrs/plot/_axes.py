"""What every plot needs: axes and colours."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

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


def new_axes(**options: Any) -> Axes:
    """Return the axes of a new figure."""
    require_matplotlib()
    from matplotlib import pyplot

    axes: Axes = pyplot.figure().add_subplot(**options)
    return axes


def new_grid(rows: int, columns: int, **options: Any) -> NDArray[Any]:
    """Return the axes of a new figure, one for each cell of a grid."""
    require_matplotlib()
    from matplotlib import pyplot

    grid: Any = pyplot.subplots(rows, columns, squeeze=False, layout="constrained", **options)
    cells: NDArray[Any] = grid[1]
    return cells


def colour(index: int) -> str:
    """Return the colour of the curve with this number."""
    return COLOURS[index % len(COLOURS)]
