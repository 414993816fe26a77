"""Study files and `fuzzyrs study`: what they run, what they print, and what is wrong with them."""

from __future__ import annotations

import csv
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import fuzzyrs as fz
from fuzzyrs import cli, experiments
from fuzzyrs.studies.document import Document, key_lines, tomllib
from fuzzyrs.studies.file import read_study
from fuzzyrs.studies.settings import changed, leaves, parts

EXAMPLES = Path(__file__).parents[1] / "examples" / "studies"

PURSUIT = """
[study]
train = "q_lambda"
seeds = {first = 5, count = 3}

[settings]
learner.steps = 100
starts = [[2, 4], [-6, 7]]
max_time = 5.0

[grid]
learner.episodes = [4, 8]
game.time_step = {from = 0.1, to = 0.2, step = 0.1}
"""


def study(folder: Path, text: str, *options: str) -> int:
    (folder / "study.toml").write_text(text, encoding="utf-8")
    return cli.main(["study", str(folder / "study.toml"), *options])


def test_a_technique_is_trained_and_tested_at_every_point(tmp_path: Path) -> None:
    assert study(tmp_path, PURSUIT) == 0
    columns = fz.open_study(tmp_path / "study.db", "study").columns()
    assert len(columns["seed"]) == 12
    for place, seed in enumerate(columns["seed"].tolist()):
        game = fz.OneOnOne(time_step=columns["game.time_step"][place])
        episodes = int(columns["learner.episodes"][place])
        learner = fz.QLambdaTraining(episodes=episodes, steps=100)
        trained = fz.train(game, learner, seed=seed)
        durations = trained.history["duration of the games [s]"]
        times = game.play_many(
            trained.controller, evader_starts=[(2, 4), (-6, 7)], max_time=5
        ).capture_time
        for name, value in {
            "learning time": trained.learning_time,
            "mean of duration of the games [s]": durations.mean(),
            "last of duration of the games [s]": durations[-1],
            "capture time from (2, 4)": times[0],
            "capture time from (-6, 7)": times[1],
        }.items():
            np.testing.assert_array_equal(columns[name][place], value)


def test_an_experiment_runs_with_other_settings(tmp_path: Path) -> None:
    text = """
    [study]
    experiment = "figure-6-8"
    name = "fewer steps"
    seeds = [3, 4]
    database = "runs.sqlite"
    [settings]
    episodes = [2, 4]
    [grid]
    learner.steps = [50, 100]
    """
    assert study(tmp_path, text) == 0
    columns = fz.open_study(tmp_path / "runs.sqlite", "fewer steps").columns()
    assert columns["learner.steps"].tolist() == [50, 50, 100, 100]
    for place, seed in enumerate([3, 4, 3, 4]):
        kind = experiments.find("figure-6-8")
        changes = {"learner.steps": columns["learner.steps"][place].item(), "episodes": [2, 4]}
        experiment = kind(changed(kind().settings, changes))
        outcome = experiment.run_seed(seed, fz.Control())
        assert columns["learning time[1]"][place] == outcome["learning time"][1]
        assert "seconds" in columns


@pytest.mark.parametrize("backend", ["threads", "processes"])
def test_a_function_is_found_beside_the_file(
    tmp_path: Path, backend: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / f"beside_{backend}.py").write_text(
        "def run(seed, x, control, power=1):\n"
        "    assert not control.done\n"
        "    return {'value': x**power + seed, 'even': seed % 2 == 0, 'text': 'a',\n"
        "            'rare': 1.5 if seed else None, 'none': None}\n",
        encoding="utf-8",
    )
    text = f"""
    [study]
    function = "beside_{backend}:run"
    seeds = 4
    backend = "{backend}"
    workers = 2
    [settings]
    power = 2
    [grid]
    x = {{from = 0.5, to = 1.5, count = 2}}
    """
    table = tmp_path / "table.csv"
    options = ["--csv", str(table), "--measure", "*a*e*", "--measure", "even"]
    assert study(tmp_path, text, *options) == 0
    rows = list(csv.DictReader(table.read_text(encoding="utf-8").splitlines()))
    assert [float(row["value"]) for row in rows] == [0.25, 1.25, 2.25, 3.25, 2.25, 3.25, 4.25, 5.25]
    captured = capsys.readouterr()
    assert re.sub(r" in \S+study.db", "", captured.out) == (
        "value\n"
        "  x    n  median  middle half  95 % interval\n"
        "  0.5  4  1.75    1.75         0.25 to 3.25\n"
        "  1.5  4  3.75    3.75         2.25 to 5.25\n"
        "\n"
        "even\n"
        "  x    n  median  middle half  95 % interval\n"
        "  0.5  4  0.5     0.5          0 to 1\n"
        "  1.5  4  0.5     0.5          0 to 1\n"
        "\n"
        "rare\n"
        "  x    n       median  middle half  95 % interval\n"
        "  0.5  3 of 4  1.5     1.5          1.5 to 1.5\n"
        "  1.5  3 of 4  1.5     1.5          1.5 to 1.5\n"
        "\n"
        "runs of study: 8\n"
        "n: runs that have a number; the others count nowhere\n"
    ), captured.out
    assert "8 of 8 runs in " in captured.err
    # What is done is not done again, and more seeds are only the new ones.
    assert study(tmp_path, text, "--seeds", "5", "--json") == 0
    captured = capsys.readouterr()
    started, *_, last, summary = map(json.loads, captured.out.splitlines())
    assert started == {"event": "started", "name": "study", "total": 10, "done": 8}
    assert (last["event"], last["done"], last["remaining"]) == ("runs", 10, 0.0)
    assert (summary["runs"], summary["failed"], captured.err) == (10, 0, "")
    value = {one["measure"]: one for one in summary["summary"]}["value"]
    assert value["point"] == {"x": 1.5}
    assert (value["count"], value["missing"], value["median"]) == (5, 0, 4.25)


def test_a_table_that_cannot_be_written_is_told_of_before_the_work(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for path, message in [
        (tmp_path / "none" / "x.csv", "none; make it first"),
        (tmp_path, "it is a folder; name a file"),
    ]:
        assert study(tmp_path, PURSUIT, "--csv", str(path)) != 0
        captured = capsys.readouterr()
        assert f"cannot write {path}: " in captured.err
        assert message in captured.err
        assert "Traceback" not in captured.err
        assert not (tmp_path / "study.db").exists()


def test_a_summary_is_of_each_point() -> None:
    runs = [
        fz.studies.Run({"a": a}, seed, {"v": float(a * seed), "w": [None, seed]}, None, 0.1)
        for a in (1, 10)
        for seed in range(8)
    ]
    results = fz.StudyResults("s", Path("s.db"), ["a"], runs)
    table = {(one.point["a"], one.measure): one for one in results.summary()}
    assert list(table) == [(1, "v"), (1, "w[1]"), (10, "v"), (10, "w[1]")]
    for a in (1, 10):
        one = table[a, "v"]
        # Half of eight values are the middle half.
        assert (one.count, one.missing, one.median) == (8, 0, 3.5 * a)
        assert one.interquartile_mean == np.mean([2, 3, 4, 5]) * a
        assert one.interval is not None
        assert one.interval[0] < 3.5 * a < one.interval[1]


@pytest.mark.filterwarnings("error")
def test_infinite_outcomes_are_summed_up(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "infinite.py").write_text(
        "def run(seed, x):\n"
        "    inf = float('inf')\n"
        "    return {'v': [-inf, 1.0, 2.0, inf][(seed + x) % 4], 'w': [-inf, inf][seed % 2]}\n",
        encoding="utf-8",
    )
    text = '[study]\nfunction = "infinite:run"\nseeds = 4\n[grid]\nx = [1]\n'
    assert study(tmp_path, text, "--measure", "v", "--measure", "w") == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert lines[2] == ["1", "4", "1.5", "1.5", "-inf", "to", "inf"]
    assert lines[6] == ["1", "4", "-", "-", "-inf", "to", "inf"]


def toml(study: str = 'train = "q_lambda"', settings: str = "", grid: str = "") -> str:
    grid = grid or "learner.steps = [9]"
    return f"[study]\n{study}\n\n[settings]\n{settings}\n\n[grid]\n{grid}\n"


EXPERIMENT = 'experiment = "table-6-3"'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (toml('train = "dai"\nsedes = 3'), "3: unknown key 'sedes' in [study]; did you mean 'seed"),
        (toml('train = "q_lamda"'), "2: unknown technique 'q_lamda'; did you mean 'q_lambda'?"),
        (toml("seeds = 3"), "1: [study] must have one of 'experiment', 'train' and 'function'"),
        (toml('train = "dai"\n' + EXPERIMENT), "'function', got 2"),
        (toml('experiment = "table-63"'), "2: unknown experiment 'table-63'; did you mean 'table"),
        (toml('function = "sin"'), "2: the function must be given as 'module:function'"),
        (toml('function = "no_such:f"'), "2: cannot import 'no_such' from here"),
        (toml('function = "math:no"'), "2: there is no function 'no' in module 'math'"),
        (toml('function = "studied:line"', grid="slop = [1]"), "8: unknown argument of studied:l"),
        (toml('function = "studied:line"', grid="slope = [1]"), "8: studied:line can't be called"),
        (toml("train = 3"), "2: 'train' must be a text such as 'q_lambda', got 3"),
        (toml('train = "dai"\nworkers = true'), "3: 'workers' must be a whole number such as 2"),
        (toml('train = "dai"\nname = ""'), "3: a study can't be called ''"),
        (toml('train = "dai"\nworkers = -1'), "3: workers must be zero or more"),
        (toml('train = "dai"\nbackend = "rays"'), "3: unknown backend 'rays'; did you mean 'ray'?"),
        (toml('train = "dai"\nseeds = "a"', grid="max_time = [1]"), "3: seeds must be a number, a"),
        (toml('train = "dai"\nseeds = 0', grid="max_time = [1]"), "3: a study takes one seed at "),
        (toml('train = "dai"\nseeds = [1, 1]', grid="max_time = [1]"), "3: the seeds must differ"),
        (toml('train = "dai"\nseeds = {fist = 1}', grid="max_time = [1]"), "did you mean 'first'?"),
        (toml(settings="learner.step = 1"), "5: unknown setting 'learner.step'; did you mean 'lea"),
        (toml(settings="starts = 3"), "5: 'starts' must be a list, got 3"),
        (toml(settings='starts = [["a"]]'), "5: evader_starts must be real numbers"),
        (
            toml(settings="learner = 3"),
            "5: 'learner' has several settings in it, such as 'learner.",
        ),
        (toml(settings="learner.steps = 3"), "8: 'learner.steps' is in [settings] already"),
        (toml(grid="learner.discount = [0.5, 2]"), "8: discount must be between 0 and 1, got 2"),
        (toml(grid="learner.discount = [nan]"), "8: discount must be finite"),
        (toml(grid="steps = [9]"), "8: unknown setting 'steps'; did you mean 'learner.steps'?"),
        (toml(grid="learner.steps = [0.5]"), "8: 'learner.steps' must be a whole number such as "),
        (toml(grid="learner.steps = 9"), "8: the grid's 'learner.steps' must be a list of values"),
        (toml(grid="learner.steps = []"), "8: the grid's 'learner.steps' has no values"),
        (toml(grid="learner.steps = [1, 1]"), "8: the grid's 'learner.steps' has a value twice"),
        (toml(grid="learner.steps = [1e3, 1979-05-27]"), "must be a number, a text, True, False"),
        (toml(grid=f"learner.steps = [{10**30}]"), "must fit into 64 bits"),
        (toml(grid="learner.steps = {from = 1, to = 9, stp = 2}"), "did you mean 'step'?"),
        (toml(grid="learner.steps = {from = 1, to = 9}"), "8: the range of 'learner.steps' must"),
        (toml(grid="learner.steps = {from = 1, to = 9, step = 0}"), "does not lead from 1 to 9"),
        (toml(grid="learner.steps = {from = 1, to = 9, step = -1}"), "does not lead from 1 to 9"),
        (toml(grid="learner.steps = {from = 1, to = 9, count = 1}"), "'count' must be 2 at least"),
        (toml(EXPERIMENT, grid="qlbgflc.stage_2 = [1]"), "8: 'qlbgflc.stage_2' has several sett"),
        (toml(EXPERIMENT, grid="stage_2.iterations = [0]"), "did you mean 'qlbgflc.stage_2.iter"),
        ('[study]\ntrain = "dai"\n[grid] # none\n', "3: the grid is empty"),
        ('[study]\ntrain = "dai"\n[gird]\n', "3: unknown table 'gird'; did you mean 'grid'?"),
        ("study = 3\n", "1: 'study' must be a table, got 3"),
        ("[study]\nname = \n", "2: Invalid value"),
        ("[study]\na = 1\na = 2\n", "Cannot overwrite a value"),
        ("a = " + "[" * 10_000, "1: this document cannot be read: nested too deeply"),
        ("\n" + ".".join("a" * 100_000) + " = 1", "2: there are more than 100 dots in this name"),
        ("#" * 1_000_001, "1: a study file has at most 1000000 bytes"),
    ],
    ids=lambda value: None if len(value) > 80 else value,
)
def test_what_is_wrong_in_a_file_is_named_with_its_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, message: str
) -> None:
    assert study(tmp_path, text) == 1
    error = capsys.readouterr().err
    assert error.startswith(f"fuzzyrs: {tmp_path / 'study.toml'}:"), error
    assert message in error, error
    assert not (tmp_path / "study.db").exists()


def test_files_that_are_no_texts_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "study.toml").write_bytes(b"[study]\n\xff\xfe")
    for path, message in [
        (tmp_path / "study.toml", "study.toml:2: this is no text in UTF-8"),
        (tmp_path, "cannot read"),
        (tmp_path / "none.toml", "cannot read"),
    ]:
        assert cli.main(["study", str(path)]) == 1
        assert message in capsys.readouterr().err


@given(
    st.binary(max_size=200)
    | st.text(alphabet="[]{}\"'=.#\n\\abc1 ,-:T", max_size=200).map(str.encode)
)
def test_hostile_files_are_errors(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    path = tmp_path_factory.getbasetemp() / "hostile.toml"
    path.write_bytes(data)
    with pytest.raises(fz.errors.FormatError, match=r"hostile.toml:\d+: "):
        read_study(path)


WORDS = st.text(alphabet="ab=#[]{}.\"' \\é", max_size=5)
BARE = st.text(alphabet="abc-_1", min_size=1, max_size=3)
NAMES = BARE | WORDS.map(json.dumps) | st.just("'a = [#'")
VALUES = st.one_of(
    st.just("1"),
    WORDS.map(json.dumps),
    st.sampled_from(
        [
            "[\n 1, # ] = [\n [2],\n]",
            '"""a = 1\n[b]\n\\""""""',
            "'''\n[c]\nd = '' ''''",
            '{x = 1, "y]" = [2]}',
            "[{a = 1},\n {b = ']'}]",
        ]
    ),
)
BLANKS = st.sampled_from(["", " ", "\t"])


@st.composite
def documents(draw: st.DrawFn) -> tuple[str, dict[tuple[str, ...], int]]:
    """A document, and the line of each key of its own."""
    lines: list[str] = []
    places: dict[tuple[str, ...], int] = {}
    for table in range(draw(st.integers(0, 4))):
        header = f"table{table}", *(draw(st.lists(NAMES, max_size=2)))
        if table or draw(st.booleans()):
            lines.append(f"{draw(BLANKS)}[ {' . '.join(header)}{draw(BLANKS)}] # [x]\n")
        else:
            header = ()
        way = keys_of(header)
        number = sum(line.count("\n") for line in lines)
        if way:
            places[way] = number
        for name in draw(st.lists(NAMES, max_size=4, unique_by=lambda name: keys_of((name,)))):
            lines.append(draw(st.sampled_from(["", "\n", "# a = 'b\n"])))
            number = sum(line.count("\n") for line in lines) + 1
            inner = draw(st.sampled_from([(), ("z",), ("z", "'q'")]))
            spelled = ".".join((name, *inner))
            lines.append(f"{draw(BLANKS)}{spelled}{draw(BLANKS)}={draw(BLANKS)}{draw(VALUES)}\n")
            places[(*way, *keys_of((name, *inner)))] = number
    return "".join(lines), places


def keys_of(names: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(next(iter(tomllib.loads(f"{name} = 1"))) for name in names)


@given(documents())
def test_every_key_is_found_on_its_line(document: tuple[str, dict[tuple[str, ...], int]]) -> None:
    text, places = document
    tomllib.loads(text)
    lines = key_lines(text)
    assert {keys: lines.get(keys) for keys in places} == places


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_the_studies_of_the_thesis_run(path: Path, tmp_path: Path) -> None:
    for module in EXAMPLES.glob("*.py"):
        shutil.copy(module, tmp_path)
    text = path.read_text(encoding="utf-8")
    # Two values of each parameter.
    text = re.sub(r"\[(\d+), (\d+)(, \d+)+\]", r"[\1, \2]", text)
    text = text.replace("to = 6600", "to = 1200")
    assert study(tmp_path, text, "--seeds", "1") == 0
    results = fz.open_study(tmp_path / "study.db")
    assert len(results.runs) == 2 ** len(results.parameters)
    assert all(one.median > 0 for one in results.summary() if "reward" not in one.measure)


@pytest.mark.skipif(os.name != "posix", reason="signals are sent")
@pytest.mark.parametrize(
    ("backend", "lines"),
    # After the first finished runs; of processes also while they start, which takes longer.
    [("threads", 2), ("processes", 2), ("processes", 1)],
)
def test_a_stopped_study_says_how_to_go_on(tmp_path: Path, backend: str, lines: int) -> None:
    (tmp_path / "waiting.py").write_text(
        "import time\n\n\ndef wait(seed, x):\n    time.sleep(0.01)\n    return seed * x\n",
        encoding="utf-8",
    )
    text = '[study]\nfunction = "waiting:wait"\nseeds = 2000\n[grid]\nx = [2]\n'
    (tmp_path / "study.toml").write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "fuzzyrs", "study", "study.toml", "--json"]
    process = subprocess.Popen(
        [*command, "--backend", backend],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert process.stdout is not None
    events = [json.loads(process.stdout.readline()) for _ in range(lines)]
    time.sleep(0.2)
    # As a terminal does: to all processes.
    os.killpg(process.pid, signal.SIGINT)
    _, errors = process.communicate()
    assert process.returncode == 130
    *_, last = errors.splitlines()
    told = re.fullmatch(
        r"interrupted after (\d+) of 2000 runs; they are kept in study.db; "
        r"the same command goes on from there",
        last,
    )
    assert told is not None, errors
    assert "Traceback" not in errors
    results = fz.open_study(tmp_path / "study.db")
    assert len(results.runs) == int(told[1]) >= events[-1]["done"]
    assert all(run.outcome == {"value": 2 * run.seed} for run in results.runs)


def test_an_exception_leaves_what_is_finished(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "breaking.py").write_text(
        "def run(seed, x):\n    return [1, 2][seed] / x\n", encoding="utf-8"
    )
    text = toml('function = "breaking:run"\nworkers = 1\nseeds = 3', grid="x = [2]")
    with pytest.raises(IndexError):
        study(tmp_path, text)
    assert "2 finished runs are kept in" in capsys.readouterr().err
    # Recorded, it is a line of the output.
    text = text.replace("seeds = 3", "seeds = 3\nrecord_errors = true")
    assert study(tmp_path, text) == 0
    assert "failed: {'x': 2}, seed 2: IndexError" in capsys.readouterr().out


def test_what_only_a_run_finds_out_names_its_point(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert study(tmp_path, toml(EXPERIMENT, grid="qlbgflc.stage_2.iterations = [0]")) == 2
    errors = capsys.readouterr().err
    assert "fuzzyrs: iterations must be at least 1, got 0" in errors
    if sys.version_info >= (3, 11):
        assert "at {'qlbgflc.stage_2.iterations': 0} with seed " in errors


def test_settings_are_changed_where_they_are() -> None:
    training = fz.QlbgflcTraining(steps=30)
    changes: dict[str, Any] = {"stage_2.iterations": 5, "stage_2.population": 9, "phase_1.steps": 7}
    other = changed(training, changes)
    assert other.stage_2 == fz.GeneticPhase(
        **{**training.stage_2.to_dict(), "iterations": 5, "population": 9}
    )
    assert other.phase_1.steps == 7
    assert (other.steps, other.stage_1) == (30, training.stage_1)
    assert changed(training, {}) == training
    # A whole number is a number, but True is none.
    assert changed(training, {"phase_1.discount": 0}).phase_1.discount == 0.0
    with pytest.raises(fz.errors.InvalidTypeError, match=r"'phase_1.discount' must be a number"):
        changed(training, {"phase_1.discount": True})


@pytest.mark.parametrize("identifier", experiments.ids())
def test_every_setting_of_every_experiment_can_be_set(identifier: str) -> None:
    settings = getattr(experiments.find(identifier)(), "settings", None)
    if settings is None:
        return
    assert changed(settings, {}) == settings
    names = list(leaves(settings))
    assert names
    assert changed(settings, {name: value_of(settings, name) for name in names}) == settings


def value_of(settings: Any, name: str) -> Any:
    for part in name.split("."):
        settings = parts(settings)[part]
    return settings


def test_settings_of_both_robots_are_told_apart() -> None:
    settings = experiments.find("table-6-5")().settings
    other = changed(settings, {"q_lambda.1.episodes": 3})
    assert [learner.episodes for learner in other.q_lambda] == [settings.q_lambda[0].episodes, 3]
    with pytest.raises(fz.FuzzyrsError, match=r"did you mean 'q_lambda.1.episodes'"):
        changed(settings, {"q_lambda.1.episode": 3})
    with pytest.raises(fz.FuzzyrsError, match="'evader' is a EvasiveTurn, which can't be written"):
        changed(experiments.find("table-6-4")().settings, {"evader": 3})


def test_windows_lines_are_lines(tmp_path: Path) -> None:
    path = tmp_path / "s.toml"
    path.write_bytes(b"[study]\r\nname = 'a'\r\n[grid]\r\nx = [1,\r\n2]\r\ny = [3]\r\n")
    error = Document(path).error(("grid", "y"), "here")
    assert str(error).endswith("s.toml:6: here")
