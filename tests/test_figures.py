"""Figures of experiments: the same from the same result, of one style; and no table is missing."""

from __future__ import annotations

import json
import re
import shutil

import matplotlib as mpl
import numpy as np
import pytest

import fuzzyrs as fz
from fuzzyrs.experiments import drawing, find, ids, reproduce, saved
from fuzzyrs.experiments.experiment import published
from fuzzyrs.experiments.figures import DOUBLE, SINGLE, draw_games, panels
from fuzzyrs.experiments.result import Row
from fuzzyrs.experiments.strips import by_columns, by_rows, draw_strips
from small import Small

mpl.use("Agg")


def numbered(kind, chapter, numbers):
    return [f"{kind}-{chapter}-{number}" for number in numbers]


#: Every table and figure of the thesis that has content, and what chapter 5 lacks.
SHOWN = [
    *numbered("figure", 2, (2, 3, 8)),
    *numbered("figure", 3, range(6, 15)),
    *numbered("table", 3, range(1, 7)),
    *numbered("figure", 4, (5, 6, 7)),
    *numbered("table", 4, range(1, 8)),
    *numbered("figure", 5, range(1, 5)),
    *numbered("table", 5, range(1, 4)),
    *numbered("figure", 6, range(6, 17)),
    *numbered("table", 6, range(1, 8)),
    *numbered("figure", 7, range(2, 12)),
    *numbered("table", 7, range(1, 7)),
    *numbered("figure", 8, (1, 2, 4, 7, 8, 9, 10)),
    *numbered("table", 8, range(1, 15)),
    "section-8-3",
]


@pytest.mark.parametrize("shown", SHOWN)
def test_every_table_and_figure_has_an_experiment(shown):
    experiment = find(shown)
    assert shown == experiment.id or shown in experiment.includes


@pytest.mark.parametrize("identifier", ids())
def test_every_experiment_tells_where_it_stands_and_what_is_expected(identifier):
    kind = find(identifier)
    ours = kind.source.startswith("ours")
    assert ours or re.fullmatch(r"(about )?pp?\. \d+(-\d+)?", kind.page), kind.page
    assert ours or 15 <= int(re.search(r"\d+", kind.page)[0]) <= 175
    assert kind.expected.endswith(".")
    assert json.loads(json.dumps(kind().config()))


@pytest.fixture(scope="module")
def small_result(tmp_path_factory):
    folder = tmp_path_factory.mktemp("small")
    reproduce(Small(), [1, 2], folder)
    return folder


def test_the_same_saved_result_gives_the_same_bytes(small_result, tmp_path):
    drawn = []
    for name in ("one", "other"):
        folder = tmp_path / name
        folder.mkdir()
        result = saved.load(small_result, Small())
        paths = list(drawing.draw(Small(), result, folder))
        drawn.append({path.name: path.read_bytes() for path in paths})
        # A figure of somebody else's in between changes nothing.
        mpl.rcParams["font.size"] = 20
    mpl.rcdefaults()
    assert drawn[0] == drawn[1]
    assert set(drawn[0]) == {
        "table-6-3-pursuer.json",
        *(f"table-6-3-{what}.{form}" for what in ("paths", "times") for form in ("svg", "png")),
    }
    assert drawn[0]["table-6-3-paths.png"].startswith(b"\x89PNG")
    assert drawn[0]["table-6-3-paths.svg"].startswith(b"<?xml")
    assert b"<text" not in drawn[0]["table-6-3-paths.svg"]


def test_a_result_is_the_same_once_it_was_saved(small_result):
    result = saved.load(small_result, Small())
    settings = Small().settings
    assert [game.panel for game in result.games[::2]] == [
        f"evader from ({x:g}, {y:g}) m" for x, y in settings.starts
    ]
    assert {game.label.split(" (")[0] for game in result.games} == {"classical", "QLBGFLC"}
    times = [game.capture_time for game in result.games if game.label == "classical"]
    assert times == settings.times("classical")
    assert len(json.dumps(result.outcomes[0])) < 10_000


def test_a_result_without_its_games_is_not_drawn(small_result, tmp_path):
    for name in ("table-6-3.json", "runs.sqlite"):
        shutil.copy(small_result / name, tmp_path)
    result = saved.load(tmp_path, Small())
    with pytest.raises(fz.errors.FormatError, match="no recorded games to draw; reproduce"):
        list(drawing.draw(Small(), result, tmp_path))


def rows(printed=(1.0, None)):
    seeds = [[1.0, 2.0], [1.5, None], [2.0, 3.0]]
    return [
        Row("q_lambda", ["a", "b"], list(printed), seeds),
        Row("other", ["a", "b"], [None, None], seeds[::-1]),
    ]


def test_all_values_and_the_print_are_in_a_strip():
    figure = draw_strips(by_columns(rows(), "time [s]"), "title")
    first, second = figure.axes
    assert [first.get_title(), second.get_title()] == ["(a) a", "(b) b"]
    assert [text.get_text() for text in first.get_yticklabels()] == ["Q(λ)", "other"]
    (seeds,) = (line for line in first.lines if line.get_marker() == "o")
    places = np.round(seeds.get_ydata()).astype(int)
    for place in (0, 1):
        assert sorted(np.asarray(seeds.get_xdata())[places == place]) == [1.0, 1.5, 2.0]
    (means,) = (line for line in first.lines if line.get_marker() == "|")
    assert list(means.get_xdata()) == [row.interquartile_mean[0] for row in rows()]
    assert list(means.get_ydata()) == [0, 1]
    (printed,) = (line for line in first.lines if line.get_marker() == "D")
    assert list(printed.get_xdata()) == [1.0]
    assert [text.get_text() for text in second.texts] == ["1 not caught"] * 2
    assert not [line for line in second.lines if line.get_marker() == "D"]


def test_rows_may_be_panels():
    figure = draw_strips(by_rows(rows(), "time [s]"), "title", reference=1.0)
    assert [axes.get_title() for axes in figure.axes] == ["(a) q_lambda", "(b) other"]
    assert figure.axes[0].get_xlabel() == "time [s]"


def test_axes_are_logarithmic_where_values_are_far_apart():
    wide = [Row("far", ["a", "b"], [None, None], [[1.0, 1.0], [100.0, 2.0]])]
    figure = draw_strips(by_columns(wide), "title", log=True)
    assert [axes.get_xscale() for axes in figure.axes] == ["log", "linear"]


def test_panels_have_a_journals_widths_and_letters():
    figure, (axes,) = panels(["alone"])
    assert (figure.get_figwidth(), axes.get_title()) == (SINGLE, "alone")
    figure, cells = panels(["one", "two", "three"], columns=2)
    assert figure.get_figwidth() == DOUBLE
    assert [cell.get_title() for cell in cells] == ["(a) one", "(b) two", "(c) three"]


def test_games_of_one_panel_are_drawn_over_each_other(game):
    recordings = [
        fz.Recording.of(
            game.play(player, evader_start=start, max_time=6.0),
            label=label,
            panel=f"from {start}",
            capture_radius=0.1,
        )
        for start in [(2, 4), (-6, 7)]
        for label, player in [("PD", fz.PD(0.0, 0.0)), ("classical", "classical")]
    ]
    figure = draw_games(recordings, "paths")
    near, far = figure.axes
    assert near.get_title() == "(a) from (2, 4)\nPD escaped, classical 4.5 s"
    assert far.get_title() == "(b) from (-6, 7)\nPD escaped, classical escaped"
    styles = [line.get_linestyle() for line in near.lines if len(line.get_xdata()) > 1]
    assert styles == ["--", "--", "-", "-"]
    (cross,) = (line for line in near.lines if line.get_marker() == "x")
    end = recordings[1].robots[1].poses[-1, :2]
    np.testing.assert_array_equal(np.ravel(cross.get_data()), end)
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [
        "pursuer",
        "evader",
        "PD",
        "classical",
        "capture",
    ]


BASICS = ("figure-2-2", "figure-2-3", "figure-2-8", "table-4-1", "table-4-2", "table-4-3")


@pytest.mark.parametrize("name", BASICS)
def test_what_has_no_chance_is_as_printed(name, tmp_path, drawn):
    experiment = find(name)()
    result = reproduce(experiment, [0], tmp_path)
    verdicts = {row.verdict for row in result.rows}
    assert "reproduced" in verdicts
    assert "differs" not in verdicts
    paths = drawn(experiment, tmp_path)
    assert [path.name for path in paths] == (
        [] if name in {"table-4-1", "table-4-3"} else [f"{name}.svg"]
    )


def test_a_wrong_membership_function_or_trace_differs():
    trapezoid = find("figure-2-2")()
    outcome = trapezoid.run_seed(0, fz.Control())
    outcome["degrees"][2] = 0.6
    assert trapezoid.rows([outcome])[0].verdict == "differs"
    gaussian = find("figure-2-3")()
    outcome = gaussian.run_seed(0, fz.Control())
    outcome["exp(-(x-m)²/s²)"]["degrees"][0] = 0.5
    assert [row.verdict for row in gaussian.rows([outcome])] == ["reproduced", "differs"]
    trace = find("figure-2-8")()
    outcome = trace.run_seed(0, fz.Control())
    outcome["replacing"] = outcome["accumulating"]
    assert trace.rows([outcome])[0].verdict == "differs"


def test_the_printed_numbers_are_all_there():
    assert published("table-3-2")["values"][2] == [-0.4211, -0.1129, 0.135, 0.3521]
    assert published("table-3-5")["values"] == [1.2858, 1.6465, 1.6206]
    assert published("table-4-2")["values"][4] == [0.0, 0.2, 0.4, 0.6, 0.8]
    assert published("table-4-3")["crossover"] == 0.4
    config = find("figure-3-7")().config()
    tried = {key: list(config[key]) for key in ("iterations", "populations")}
    assert tried == published("figure-3-7")["tried"]
    for shown in SHOWN:
        document = published(shown)
        assert document == {} or set(document) - {"notes"} or document["notes"]
