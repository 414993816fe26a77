"""Experiments: the layout of results, the same bytes every time, interrupted runs."""

from __future__ import annotations

import dataclasses
import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import fuzzyrs as fz
from fuzzyrs import experiments
from fuzzyrs.experiments import saved
from fuzzyrs.experiments.chapter6 import Table63, Table63Config
from fuzzyrs.experiments.saved import DATABASE, load, open_runs
from fuzzyrs.studies.store import Run
from small import CONFIG, Small

HANGS = 120
SEEDS = range(4)


def document(folder):
    return json.loads((folder / "table-6-3.json").read_text(encoding="utf-8"))


def apart_from_run(folder):
    """The text of a result without what no two runs share."""
    text = (folder / "table-6-3.json").read_text(encoding="utf-8")
    kept, _, run = text.partition('\n  "run": {')
    assert run
    return kept


@pytest.fixture(scope="module")
def clean(tmp_path_factory):
    """The folder of a run from start to end."""
    folder = tmp_path_factory.mktemp("clean")
    experiments.reproduce(Small(), SEEDS, folder)
    return folder


def test_a_result_has_the_layout_of_all_experiments(clean):
    result = document(clean)
    assert list(result) == ["id", "version", "seeds", "config", "rows", "run"]
    assert (result["id"], result["version"]) == ("table-6-3", fz.__version__)
    assert result["seeds"] == list(SEEDS)
    names = ["classical", "q_lambda", "reward_ga", "qlbgflc", "learning_time"]
    claims = ["sum of the times", "longest learning time"]
    assert [row["name"] for row in result["rows"]] == names + claims
    statistics = ["median", "low", "high", "interquartile_mean", "interval"]
    keys = ["name", "columns", "published", *statistics, "per_seed", "verdict", "reason", "digits"]
    for row in result["rows"]:
        assert list(row) == keys
        assert {len(row[key]) for key in keys[1:8]} == {len(row["columns"])}
        assert [len(values) for values in row["per_seed"]] == [len(row["columns"])] * len(SEEDS)
        assert row["verdict"] in {"reproduced", "close", "differs", "can't be checked"}
    assert result["rows"][0]["columns"] == ["(-6,7)", "(-7,-7)", "(2,4)", "(3,-8)"]
    assert result["rows"][4]["columns"] == ["q_lambda", "reward_ga", "qlbgflc"]


def test_the_published_numbers_stand_beside_ours(clean):
    published = {row["name"]: row["published"] for row in document(clean)["rows"]}
    assert published == {
        "classical": [9.6, 10.4, 4.5, 8.5],
        "q_lambda": [12.6, 15.6, 8.5, 11.9],
        "reward_ga": [9.7, 10.5, 4.5, None],
        "qlbgflc": [9.9, 10.5, 4.6, None],
        "learning_time": [32.0, 460.8, 47.8],
        "sum of the times": [48.6, None, None],
        "longest learning time": [32.0, 460.8, 47.8],
    }


def test_the_rows_are_what_training_and_playing_give(clean):
    rows = {row["name"]: row["per_seed"] for row in document(clean)["rows"]}
    assert rows["classical"] == [[9.6, 10.4, 4.5, 8.5]] * len(SEEDS)
    game = fz.OneOnOne()
    for column, name in enumerate(["q_lambda", "reward_ga", "qlbgflc"]):
        for seed in SEEDS:
            trained = fz.train(game, getattr(CONFIG, name), seed=seed)
            times = [
                game.play(trained.controller, evader_start=start, max_time=20).capture_time
                for start in CONFIG.starts
            ]
            assert rows[name][seed] == times
            assert rows["learning_time"][seed][column] == round(trained.learning_time, 6)


def test_the_config_says_what_the_result_depends_on(clean):
    config = document(clean)["config"]
    assert list(config) == ["game", "starts", "max_time", "q_lambda", "reward_ga", "qlbgflc"]
    pursuer = {"speed": 2.0, "wheelbase": 0.3, "max_steering": 0.5, "speed_law": "constant"}
    assert config["game"]["pursuer"] == pursuer
    assert config["q_lambda"]["episodes"] == 10
    assert config["qlbgflc"]["stage_2"]["iterations"] == 3
    assert Table63().config() == Table63(Table63Config()).config() != Small().config()


def test_what_no_two_runs_share_stands_apart(clean):
    run = document(clean)["run"]
    assert set(run) >= {"seconds", "seconds_per_seed", "threads", "machine", "python"}
    assert len(run["seconds_per_seed"]) == len(SEEDS)
    assert run["machine"] not in (apart_from_run(clean) if len(run["machine"]) > 6 else "")


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_results_are_the_same_bytes_on_any_number_of_threads(clean, tmp_path, threads):
    experiments.reproduce(Small(), SEEDS, tmp_path, threads=threads)
    assert apart_from_run(tmp_path) == apart_from_run(clean)


def test_a_saved_result_comes_back_whole(clean):
    result = load(clean, Small())
    assert result.to_json() == (clean / "table-6-3.json").read_text(encoding="utf-8")
    assert [outcome["classical"]["times"] for outcome in result.outcomes] == classical(clean)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (f'"version": "{fz.__version__}"', '"version": "0.0.0"', "of fuzzyrs 0.0.0.*again"),
        ('"rows"', '"columns"', "not a result"),
        ('"episodes": 10', '"episodes": 11', "of another config"),
        ("{", "[", "not a result"),
    ],
)
def test_a_result_that_cannot_be_used_says_why(clean, tmp_path, old, new, words):
    shutil.copytree(clean, tmp_path, dirs_exist_ok=True)
    path = tmp_path / "table-6-3.json"
    path.write_text(path.read_text(encoding="utf-8").replace(old, new, 1), encoding="utf-8")
    with pytest.raises(fz.errors.FormatError, match=f"table-6-3.json.*{words}"):
        load(tmp_path, Small())


def test_a_result_without_its_runs_cannot_be_drawn(clean, tmp_path):
    shutil.copy(clean / "table-6-3.json", tmp_path)
    with pytest.raises(fz.errors.FileError, match=DATABASE):
        load(tmp_path, Small())
    with pytest.raises(fz.errors.FileError, match=r"cannot read .*table-6-3.json"):
        load(tmp_path / "nowhere", Small())


def test_seeds_come_in_the_order_asked_for(clean, tmp_path):
    experiments.reproduce(Small(), [3, 1], tmp_path)
    few, all_rows = document(tmp_path), document(clean)["rows"]
    assert few["seeds"] == [3, 1]
    for row, whole in zip(few["rows"], all_rows, strict=True):
        assert row["per_seed"] == [whole["per_seed"][3], whole["per_seed"][1]]


class Log:
    """Keeps what it is told."""

    def __init__(self):
        self.lines = []

    def started(self, total, done):
        self.lines.append(("started", total, done))

    def finished(self, seeds, done, total):
        self.lines.append(("finished", list(seeds), done, total))

    @property
    def seeds(self):
        return sorted(seed for line in self.lines if line[0] == "finished" for seed in line[1])


def test_progress_is_told_of_every_seed(tmp_path):
    log = Log()
    experiments.reproduce(Small(), [5, 6], tmp_path, threads=1, progress=log)
    assert log.lines[0] == ("started", 2, 0)
    assert log.seeds == [5, 6]
    assert log.lines[-1][2:] == (2, 2)


def interrupt(folder, how=signal.SIGINT):
    """Run four seeds of which one is stuck, stop after three, return code and what was said."""
    script = f"""
import sys
sys.path.insert(0, {str(Path(__file__).parent)!r})
from fuzzyrs import cli
from fuzzyrs.experiments import registry
from small import Stuck
registry._EXPERIMENTS["table-6-3"] = Stuck
arguments = ["--seeds", "4", "--threads", "2", "--json", "--out", sys.argv[1]]
sys.exit(cli.main(["reproduce", "table-6-3", *arguments]))
"""
    command = [sys.executable, "-c", script, str(folder)]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(command, **pipes, text=True) as process:
        try:
            while '"done": 3' not in process.stdout.readline():
                assert process.poll() is None
            process.send_signal(how)
            _, said = process.communicate(timeout=HANGS)
        finally:
            process.kill()
    return process.returncode, said


def test_an_interrupted_run_is_taken_up_again_and_gives_the_same(clean, tmp_path):
    code, said = interrupt(tmp_path)
    assert code == 130
    assert "interrupted after 3 of 4 seeds" in said
    assert "the same command goes on from there" in said
    assert [path.name for path in tmp_path.iterdir()] == [DATABASE]
    log = Log()
    experiments.reproduce(Small(), SEEDS, tmp_path, progress=log)
    assert log.lines == [("started", 4, 3), ("finished", [2], 4, 4)]
    assert apart_from_run(tmp_path) == apart_from_run(clean)


def test_a_killed_run_is_taken_up_again_and_gives_the_same(clean, tmp_path):
    code, _ = interrupt(tmp_path, signal.SIGKILL)
    assert code == -signal.SIGKILL
    log = Log()
    experiments.reproduce(Small(), SEEDS, tmp_path, progress=log)
    assert log.lines == [("started", 4, 3), ("finished", [2], 4, 4)]
    assert apart_from_run(tmp_path) == apart_from_run(clean)


def leave_runs(folder, *, experiment=None, seeds=(0, 1), mark=None):
    """Leave what an interrupted run leaves; with a mark, outcomes that no run gives."""
    experiment = experiment or Small()
    with open_runs(folder, experiment) as runs:
        for seed in seeds:
            outcome = experiment.run_seed(seed, fz.Control())
            if mark is not None:
                outcome["classical"]["times"] = [mark] * 4
            runs.add([Run({}, seed, outcome, None, 0.0)])


def classical(folder):
    return document(folder)["rows"][0]["per_seed"]


def test_finished_seeds_are_not_run_again(tmp_path):
    leave_runs(tmp_path, mark=77.0)
    experiments.reproduce(Small(), range(3), tmp_path)
    assert [times[0] for times in classical(tmp_path)] == [77.0, 77.0, 9.6]


def test_finished_seeds_are_run_again_on_request(clean, tmp_path):
    leave_runs(tmp_path, mark=77.0)
    experiments.reproduce(Small(), SEEDS, tmp_path, resume=False)
    assert apart_from_run(tmp_path) == apart_from_run(clean)


def test_other_starts_were_compared_with_the_printed_ones(tmp_path):
    starts = ((2.0, 4.0), (1.0, 1.0))
    experiment = Table63(dataclasses.replace(CONFIG, starts=starts))
    result = experiments.reproduce(experiment, [0], tmp_path)
    assert result.rows[0].published == [4.5, None]
    assert {row.verdict for row in result.rows} == {"can't be checked"}


def test_seeds_of_another_config_are_not_used_and_kept(clean, tmp_path):
    other = Table63(Table63Config(q_lambda=fz.QLambdaTraining(episodes=11), max_time=20.0))
    other.run_seed = Small().run_seed
    leave_runs(tmp_path, experiment=other, mark=77.0)
    experiments.reproduce(Small(), SEEDS, tmp_path)
    assert apart_from_run(tmp_path) == apart_from_run(clean)
    with open_runs(tmp_path, other) as runs:
        assert [run.outcome["classical"]["times"] for run in runs.runs()] == [[77.0] * 4] * 2


def test_seeds_that_a_run_did_not_ask_for_were_thrown_away(tmp_path):
    leave_runs(tmp_path, seeds=(5, 0), mark=77.0)
    experiments.reproduce(Small(), range(2), tmp_path)
    assert [times[0] for times in classical(tmp_path)] == [77.0, 9.6]
    experiments.reproduce(Small(), [5], tmp_path)
    assert [times[0] for times in classical(tmp_path)] == [77.0]


def test_seeds_of_another_build_are_not_used_and_were_thrown_away(clean, tmp_path, monkeypatch):
    monkeypatch.setattr(saved, "build", lambda: "another")
    leave_runs(tmp_path, mark=77.0)
    monkeypatch.undo()
    experiments.reproduce(Small(), SEEDS, tmp_path)
    assert apart_from_run(tmp_path) == apart_from_run(clean)
    monkeypatch.setattr(saved, "build", lambda: "another")
    with open_runs(tmp_path, Small()) as runs:
        assert [run.outcome["classical"]["times"] for run in runs.runs()] == [[77.0] * 4] * 2


def test_seeds_that_were_to_be_run_again_were_thrown_away_first(tmp_path):
    class Failing(Small):
        def run_seed(self, seed, control):
            if seed == 2:
                raise ZeroDivisionError
            return super().run_seed(seed, control)

    experiments.reproduce(Small(), SEEDS, tmp_path)
    with pytest.raises(ZeroDivisionError):
        experiments.reproduce(Failing(), SEEDS, tmp_path, resume=False, threads=1)
    log = Log()
    experiments.reproduce(Small(), SEEDS, tmp_path, progress=log)
    assert log.lines == [("started", 4, 4)]


def test_a_finished_run_was_done_again(clean, tmp_path):
    experiments.reproduce(Small(), SEEDS, tmp_path)
    log = Log()
    experiments.reproduce(Small(), SEEDS, tmp_path, progress=log)
    assert log.lines == [("started", 4, 4)]
    assert apart_from_run(tmp_path) == apart_from_run(clean)


def test_a_database_of_garbage_is_refused_and_left_alone(tmp_path):
    garbage = os.urandom(4096)
    (tmp_path / DATABASE).write_bytes(garbage)
    with pytest.raises(fz.errors.FormatError, match=DATABASE):
        experiments.reproduce(Small(), SEEDS, tmp_path)
    assert (tmp_path / DATABASE).read_bytes() == garbage


def test_a_failing_seed_keeps_the_others_and_no_result_is_written(tmp_path):
    class Failing(Small):
        def run_seed(self, seed, control):
            if seed == 2:
                raise ZeroDivisionError
            return super().run_seed(seed, control)

    with pytest.raises(ZeroDivisionError):
        experiments.reproduce(Failing(), SEEDS, tmp_path, threads=1)
    assert [path.name for path in tmp_path.iterdir()] == [DATABASE]
    log = Log()
    experiments.reproduce(Small(), SEEDS, tmp_path, progress=log)
    assert log.lines[0] == ("started", 4, 2)


@pytest.mark.parametrize("seeds", [[], [1, 1], [-1], [2**63]])
def test_impossible_seeds_are_refused_before_anything_is_written(tmp_path, seeds):
    with pytest.raises(fz.errors.InvalidValueError, match="seeds"):
        experiments.reproduce(Small(), seeds, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_file_in_the_place_of_the_folder_is_found_before_the_work(tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("mine")
    for folder in [blocked, blocked / "below"]:
        with pytest.raises(fz.errors.FileError, match=r"cannot write results into .*file"):
            experiments.reproduce(Small(), SEEDS, folder)
    assert blocked.read_text() == "mine"


def test_ids_are_found_and_mistyped_ones_get_a_hint():
    assert {"figure-3-8", "table-4-6", "table-6-3"} < set(experiments.ids())
    assert experiments.find("table-6-3") is Table63
    with pytest.raises(fz.errors.UnknownNameError, match=r"did you mean 'table-6-3'\?"):
        experiments.find("tabel-6-3")
    with pytest.raises(fz.errors.UnknownNameError, match="'fuzzyrs list' shows all"):
        experiments.find("zzz")
