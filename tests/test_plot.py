"""Plots: what is drawn, and what is said where it cannot be."""

from __future__ import annotations

import subprocess
import sys

import matplotlib as mpl
import numpy as np
import pytest
from mpl_toolkits.mplot3d import Axes3D

import fuzzyrs as fz
from fuzzyrs import plot

mpl.use("Agg")
from matplotlib import pyplot


@pytest.fixture(autouse=True)
def closed_figures():
    yield
    pyplot.close("all")


def labels(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_every_term_has_its_curve(steer):
    variable = steer.inputs[0]
    ax = plot.membership(variable, points=101)
    assert len(ax.lines) == 3
    for line, (name, term) in zip(ax.lines, variable.terms.items(), strict=True):
        x, y = line.get_data()
        assert (line.get_label(), x[0], x[-1], len(x)) == (name, -1.0, 1.0, 101)
        np.testing.assert_array_equal(y, term(x))
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("angle", "degree")
    assert ax.get_xlim() == (-1, 1)
    assert labels(ax) == ["N", "Z", "P"]


def test_more_terms_than_colours_are_drawn():
    terms = [f"t{i}" for i in range(len(plot.COLOURS) + 2)]
    assert len(plot.membership(fz.Variable.evenly("x", (0, 1), terms)).lines) == len(terms)


@pytest.fixture
def surfaces(monkeypatch):
    """The arrays of every surface that is drawn."""
    drawn = []
    draw = Axes3D.plot_surface

    def keep(self, *arrays, **options):
        drawn.append(arrays)
        return draw(self, *arrays, **options)

    monkeypatch.setattr(Axes3D, "plot_surface", keep)
    return drawn


def test_a_surface_has_the_values_of_the_system(steer, surfaces):
    ax = plot.surface(steer, points=7)
    ((x, y, z),) = surfaces
    ends = np.linspace(-1, 1, 7)
    np.testing.assert_array_equal(x[0], ends)
    np.testing.assert_array_equal(y[:, 0], ends)
    np.testing.assert_array_equal(z, steer(x, y))
    assert (ax.get_xlabel(), ax.get_ylabel(), ax.get_zlabel()) == ("angle", "rate", "steering")


def test_further_inputs_are_held(surfaces):
    inputs = [fz.Variable.evenly(name, (0, 4), "ab") for name in "xyz"]
    plane = fz.TSK(inputs, [1.0, 10.0, 100.0, 0.0] * 8, order=1)
    plot.surface(plane, points=2)
    plot.surface(plane, points=2, at={"z": 1})
    ax = plot.surface(plane, points=2, axes=(2, 0), at={"y": 3})
    corners = [z.ravel().round(9).tolist() for *_, z in surfaces]
    assert corners[0] == [200, 204, 240, 244]
    assert corners[1] == [100, 104, 140, 144]
    assert corners[2] == [30, 430, 34, 434]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("z", "x")


def test_paths_start_at_the_dots_and_end_at_the_circle(game):
    trajectory = game.play(evader_start=(2, 4))
    ax = plot.paths(trajectory, label="classical", style="--", capture_radius=0.1)
    pursuer, start, evader, _ = ax.lines
    np.testing.assert_array_equal(np.column_stack(pursuer.get_data()), trajectory.pursuer[:, :2])
    np.testing.assert_array_equal(np.column_stack(evader.get_data()), trajectory.evader[:, :2])
    assert (pursuer.get_linestyle(), start.get_marker()) == ("--", "o")
    assert labels(ax) == ["classical pursuer", "classical evader"]
    (circle,) = ax.patches
    assert circle.center == tuple(trajectory.pursuer[-1, :2])
    assert circle.radius == 0.1
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x [m]", "y [m]")


def test_the_callers_axes_are_used(game, steer):
    for draw, options in [
        (lambda ax: plot.membership(steer.inputs[0], ax=ax), {}),
        (lambda ax: plot.paths(game.play(evader_start=(2, 4)), ax=ax), {}),
        (lambda ax: plot.surface(steer, ax=ax, points=3), {"projection": "3d"}),
    ]:
        ax = pyplot.figure().add_subplot(**options)
        count = len(pyplot.get_fignums())
        assert draw(ax) is ax
        assert len(pyplot.get_fignums()) == count


def test_what_cannot_be_drawn_is_refused_in_words(steer, gap):
    with pytest.raises(fz.errors.ShapeError, match="a surface needs two inputs; 'gap' has 1"):
        plot.surface(gap)
    with pytest.raises(fz.errors.UnknownNameError, match="no input 'ange' to hold; known: angle"):
        plot.surface(steer, at={"ange": 0})
    for axes in [(0, 2), (0, 0), (-1, 0)]:
        with pytest.raises(fz.errors.InvalidValueError, match="two different inputs from 0 to 1"):
            plot.surface(steer, axes=axes)


def test_without_matplotlib_everything_else_works_and_plots_say_what_to_install():
    script = """
import sys
sys.modules["matplotlib"] = None
import fuzzyrs as fz
variable = fz.Variable.evenly("x", (0, 1), "ab")
try:
    fz.plot.membership(variable)
except ImportError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    message = 'plotting needs matplotlib; install it with: pip install "fuzzyrs[plot]"\n'
    assert done.stdout == message, done.stderr
