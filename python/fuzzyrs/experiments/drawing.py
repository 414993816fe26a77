"""Figures of saved results, as vector graphics and as PNG."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fuzzyrs import plot
from fuzzyrs.errors import from_kind
from fuzzyrs.experiments.experiment import Experiment
from fuzzyrs.experiments.result import Result

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: In which forms a figure is saved, and how.
FORMS: dict[str, dict[str, Any]] = {
    # Without a date the same figure is the same file.
    "svg": {"metadata": {"Date": None}},
    "png": {"dpi": 150},
}

#: How all figures look: 8 pt, thin lines, curves that differ in colour and in their dashes.
STYLE: Any = {
    # With it the same figure is the same file; as paths letters need no font.
    "svg.hashsalt": "fuzzyrs",
    "svg.fonttype": "path",
    "font.family": "DejaVu Sans",
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.titlelocation": "left",
    # Nothing stands above the panels; looking for it takes long.
    "axes.titley": 1.0,
    "axes.labelsize": 8,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "legend.fontsize": 8,
    "figure.titlesize": 9,
    "figure.constrained_layout.w_pad": 0.06,
    "figure.constrained_layout.h_pad": 0.05,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
    "lines.linewidth": 1.2,
    "lines.markersize": 3,
    "legend.frameon": False,
    "legend.handlelength": 2.6,
    "axes.prop_cycle": (
        f"cycler(color={plot.COLOURS}, "
        "linestyle=['-', '--', '-.', ':', (0, (5, 1)), (0, (3, 1, 1, 1)), (0, (1, 1))])"
    ),
}


def draw(experiment: Experiment, result: Result, folder: Path) -> Iterator[Path]:
    """Write the figures and the controllers of a result into a folder, and yield their paths.

    Raises
    ------
    ImportError
        Without matplotlib, once the controllers are written.
    FileError
        If the folder cannot be written.
    """
    for name, controller in experiment.controllers(result):
        path = folder / f"{name}.json"
        controller.save(path)
        yield path
    plot.require_matplotlib()
    import matplotlib

    with matplotlib.rc_context(STYLE):
        for name, figure in experiment.figures(result):
            # The layout is the same in all forms and need not be found for each.
            if (layout := figure.get_layout_engine()) is not None:
                layout.execute(figure)
                figure.set_layout_engine(None)
            for form, options in FORMS.items():
                yield _save(figure, folder / f"{name}.{form}", form, options)


def _save(figure: Figure, path: Path, form: str, options: dict[str, Any]) -> Path:
    """Write a figure so that the file is whole or not there, and return its path."""
    part = path.with_name(f"{path.name}.{os.getpid()}.part")
    try:
        figure.savefig(part, format=form, **options)
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        message = f"cannot write {path}: {error.strerror or error}"
        raise from_kind("file", message) from error
    return path
