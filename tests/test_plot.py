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


def mixed():
    """A system with an output of each sort, and a rule for each that says nothing of the other."""
    x = fz.Variable.evenly("x", (0, 10), ["low", "high"], "triangular")
    y = fz.Variable("y", (0, 4), {"one": fz.singleton(1), "rest": fz.triangular(1, 4, 4)})
    tip = fz.Variable.evenly("tip", (0, 30), ["cheap", "generous"], "triangular")
    tip = fz.Output.mamdani(tip, no_rule_fires=0)
    terms = {"none": -1.5, "much": [1, 0, 2], "some": "x^2"}
    joy = fz.Output.sugeno("joy", terms, no_rule_fires=0)
    rules = [
        "if x is not very low and y is rest then tip is cheap",
        "if x is low then joy is none",
        "if x is high then tip is generous and joy is much",
        "if y is one then joy is some with 0.25",
    ]
    return fz.System([x, y], [tip, joy], rules, name="mixed")


def test_corners_and_jumps_are_drawn():
    variable = mixed().inputs[1]
    ax = plot.membership(variable, points=2)
    single, rest = (line.get_data() for line in ax.lines)
    assert single[1].tolist() == [0, 0, 1, 0, 0, 0]
    assert single[0][2] == 1.0
    assert (single[0] > 0.99).sum() == 5
    np.testing.assert_array_equal(rest[1], variable.terms["rest"](rest[0]))


def test_outputs_have_their_functions_and_constants():
    tip, joy = mixed().outputs
    ax = plot.membership(tip)
    assert labels(ax) == ["cheap", "generous"]
    assert ax.get_xlabel() == "tip"
    ax = plot.membership(joy)
    assert labels(ax) == ["none = -1.5", "much: linear", "some: x^2"]
    np.testing.assert_array_equal(ax.lines[0].get_data(), [[-1.5, -1.5], [0, 1]])


def test_a_system_has_a_plot_for_each_variable(steer):
    cells = plot.membership(mixed())
    assert [ax.get_xlabel() for ax in cells] == ["x", "y", "tip", "joy"]
    assert [len(ax.lines) for ax in cells] == [2, 2, 2, 3]
    assert cells[0].figure.get_suptitle() == "mixed"
    assert len(plot.membership(steer)) == 2


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


def test_inputs_are_called_by_name_and_outputs_chosen(surfaces):
    system = mixed()
    ax = plot.surface(system, axes=("y", "x"), output="joy", points=4)
    ((y, x, z),) = surfaces
    np.testing.assert_array_equal(z, system(x, y)[..., 1])
    assert (ax.get_xlabel(), ax.get_ylabel(), ax.get_zlabel()) == ("y", "x", "joy")
    plot.surface(system, points=4)
    np.testing.assert_array_equal(surfaces[1][2], system(*surfaces[1][:2])[..., 0])


def test_a_heatmap_has_the_values_of_the_system(steer):
    ax = plot.surface(steer, kind="heatmap", points=5)
    (mesh,) = ax.collections
    ends = np.linspace(-1, 1, 5)
    np.testing.assert_array_equal(
        np.ravel(mesh.get_array()), steer(*np.meshgrid(ends, ends)).ravel()
    )
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("angle", "rate")
    assert ax.figure.axes[1].get_ylabel() == "steering"


def heads(cells):
    return [[ax.get_title(loc="left") for ax in row] for row in cells]


def verticals(ax):
    """Where lines stand from the bottom to the top."""
    return [line.get_xdata()[0] for line in ax.lines if list(line.get_ydata()) == [0, 1]]


def filled(ax):
    """The greatest height of what is filled."""
    (area,) = ax.collections
    return area.get_paths()[0].vertices[:, 1].max()


def test_the_rule_viewer_has_a_row_for_each_rule():
    system = mixed()
    explanation = system.explain(2, 3)
    cells = plot.rules(system, {"y": 3, "x": 2})
    assert heads(cells) == [
        ["x is not very low", "y is rest", "tip is cheap", ""],
        ["x is low", "", "", "joy is none"],
        ["x is high", "", "tip is generous", "joy is much"],
        ["", "y is one", "", "joy is some"],
        ["", "", "", ""],
    ]
    assert [ax.get_ylabel() for ax in cells[:, 0]] == [
        "rule 1\n0.36",
        "rule 2\n0.8",
        "rule 3\n0.2",
        "rule 4\n0",
        "all",
    ]
    assert verticals(cells[0, 0]) == verticals(cells[4, 0]) == [2]
    assert filled(cells[0, 0]) == pytest.approx(1 - 0.8**2)
    assert filled(cells[0, 2]) == pytest.approx(0.36)
    assert filled(cells[4, 2]) == explanation.sets["tip"][1].max()
    assert verticals(cells[4, 2]) == [explanation.outputs["tip"]]
    stem = cells[2, 3].lines[0].get_data()
    np.testing.assert_allclose(stem, [[4, 4], [0, 0.2]])
    assert cells[4, 0].get_xlabel() == "x = 2"
    assert cells[4, 3].get_xlabel() == f"joy = {explanation.outputs['joy']:.5g}"
    assert cells[0, 0].figure.get_suptitle() == "mixed"


def test_the_rule_viewer_shows_the_strongest_rules(steer):
    cells = plot.rules(steer, [0.3, -0.2], most=4)
    shown = steer.explain(0.3, -0.2).strongest(4)
    rows = [ax.get_ylabel().splitlines()[0] for ax in cells[:-1, 0]]
    assert rows == [f"rule {rule + 1}" for rule in shown]
    assert cells[0, 0].figure.get_suptitle() == "steer: the strongest 4 of 9 rules"
    assert heads(cells)[0] == ["angle is Z", "rate is N", "steering = -0.25"]
    triangles = [fz.Variable.evenly(name, (-1, 1), "NZP", "triangular") for name in "ab"]
    corner = plot.rules(fz.TSK(triangles, np.zeros(9)), [1, 1], most=3)
    assert len(corner) == 2


def test_inputs_without_terms_are_drawn_too():
    x, load = fz.Variable.evenly("x", (0, 1), "ab"), fz.Variable("load", (0, 5), {})
    system = fz.System([x, load], fz.Output.sugeno("u"), "if x is a then u = 2*load")
    cells = plot.rules(system, [0.2, 3])
    assert cells[-1, 1].get_xlabel() == "load = 3"
    assert verticals(cells[-1, 1]) == [3]
    assert len(plot.membership(system)) == 3


def test_where_no_rule_fires_the_viewer_says_so(gap):
    cells = plot.rules(gap, 5)
    assert cells[-1, 1].get_xlabel() == "output = nan (no rule fires)"
    assert verticals(cells[-1, 1]) == []


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


def test_paths_of_two_pursuers_are_numbered_and_each_has_its_circle():
    played = fz.TwoPursuers().play(pursuer_starts=[(-4, 3), (5, -2)])
    ax = plot.paths(played, capture_radius=0.1)
    assert labels(ax) == ["pursuer 1", "pursuer 2", "evader"]
    first, _, second, _, evader, start = ax.lines
    np.testing.assert_array_equal(np.column_stack(second.get_data()), played.pursuers[1, :, :2])
    assert start.get_data() == ([0.0], [0.0])
    assert len({line.get_color() for line in (first, second, evader)}) == 3
    assert [circle.center for circle in ax.patches] == [tuple(p[-1, :2]) for p in played.pursuers]
    assert [c.get_edgecolor()[:3] for c in ax.patches] == [
        pyplot.matplotlib.colors.to_rgb(line.get_color()) for line in (first, second)
    ]


def test_a_recording_has_its_label_and_its_circle(game):
    played = game.play(evader_start=(2, 4))
    recorded = fz.Recording.of(played, label="classical", capture_radius=0.1)
    ax = plot.paths(recorded)
    assert labels(ax) == ["classical pursuer", "classical evader"]
    pursuer, start, *_ = ax.lines
    np.testing.assert_array_equal(
        np.column_stack(pursuer.get_data()), recorded.robots[0].poses[:, :2]
    )
    assert start.get_data() == ([0.0], [0.0])
    assert [circle.radius for circle in ax.patches] == [0.1]
    ax = plot.paths(recorded, label="", capture_radius=0.3)
    assert labels(ax) == ["pursuer", "evader"]
    assert [circle.radius for circle in ax.patches] == [0.3]
    colours = [line.get_color() for line in plot.paths(played).lines]
    assert colours == [line.get_color() for line in ax.lines]


def test_a_recording_along_a_wall_has_the_wall():
    wall = fz.Wall.jog()
    run = fz.WallFollowing(wall).play(fz.PD(1.2, 1.5), duration=3.0)
    ax = plot.paths(fz.Recording.of(run, label="PD", wall=wall.points))
    assert labels(ax) == ["wall", "PD robot"]
    corners, path, _ = ax.lines
    np.testing.assert_allclose(np.column_stack(corners.get_data()), wall.points, atol=1e-4)
    np.testing.assert_allclose(np.column_stack(path.get_data()), run.poses[:, :2], atol=1e-4)
    assert not ax.patches


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
    with pytest.raises(fz.errors.UnknownNameError, match="no input 'ange'; known: angle"):
        plot.surface(steer, at={"ange": 0})
    with pytest.raises(fz.errors.UnknownNameError, match="no input 'rat'; known: angle, rate"):
        plot.surface(steer, axes=("angle", "rat"))
    with pytest.raises(fz.errors.UnknownNameError, match="no output 'tip'; known: steering"):
        plot.surface(steer, output="tip")
    with pytest.raises(fz.errors.UnknownNameError, match="unknown kind 'map'"):
        plot.surface(steer, kind="map")
    with pytest.raises(fz.errors.InvalidTypeError, match="in a figure of its own"):
        plot.membership(steer, ax=pyplot.figure().add_subplot())
    for axes in [(0, 2), (0, 0), (-1, 0), ("rate", 1)]:
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
