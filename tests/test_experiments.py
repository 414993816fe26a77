"""Experiments: the layout of results, the same bytes every time, interrupted runs."""

from __future__ import annotations

import dataclasses
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import fuzzyrs as fz
from fuzzyrs import experiments
from fuzzyrs.experiments.chapter6 import Table63, Table63Config
from fuzzyrs.experiments.runner import Partial
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
    keys = ["name", "columns", "published", "median", "low", "high", "per_seed", "verdict"]
    for row in result["rows"]:
        assert list(row) == keys
        assert {len(row[key]) for key in keys[1:6]} == {len(row["columns"])}
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

    def started(self, total):
        self.lines.append(("started", total))

    def resumed(self, done, total):
        self.lines.append(("resumed", done, total))

    def finished(self, seed, done, total):
        self.lines.append(("finished", seed, done, total))


def test_progress_is_told_seed_by_seed(tmp_path):
    log = Log()
    experiments.reproduce(Small(), [5, 6], tmp_path, threads=1, progress=log)
    assert log.lines == [("started", 2), ("finished", 5, 1, 2), ("finished", 6, 2, 2)]


def interrupt(folder):
    """Run four seeds of which one is stuck, press Ctrl-C after three, return what was said."""
    script = f"""
import sys
sys.path.insert(0, {str(Path(__file__).parent)!r})
from fuzzyrs import cli
from fuzzyrs.experiments import registry
from small import Stuck
registry._EXPERIMENTS["table-6-3"] = Stuck
arguments = ["--seeds", "4", "--threads", "2", "--out", sys.argv[1]]
sys.exit(cli.main(["reproduce", "table-6-3", *arguments]))
"""
    command = [sys.executable, "-c", script, str(folder)]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        try:
            for _ in range(3):
                assert "done" in process.stderr.readline()
            process.send_signal(signal.SIGINT)
            _, said = process.communicate(timeout=HANGS)
        finally:
            process.kill()
    assert process.returncode == 130
    return said


def test_an_interrupted_run_is_taken_up_again_and_gives_the_same(clean, tmp_path):
    said = interrupt(tmp_path)
    assert "interrupted after 3 of 4 seeds" in said
    assert "the same command goes on from there" in said
    assert list(tmp_path.iterdir()) == [partial(tmp_path).path]
    log = Log()
    experiments.reproduce(Small(), SEEDS, tmp_path, progress=log)
    assert log.lines == [("started", 4), ("resumed", 3, 4), ("finished", 2, 4, 4)]
    assert apart_from_run(tmp_path) == apart_from_run(clean)
    assert [path.name for path in tmp_path.iterdir()] == ["table-6-3.json"]


def partial(folder, experiment=None):
    return Partial(folder, experiment or Small())


def leave_partial(folder, *, experiment=None, seeds=(0, 1), mark=None):
    """Leave what an interrupted run leaves; with a mark, outcomes that no run gives."""
    experiment = experiment or Small()
    left = partial(folder, experiment)
    for seed in seeds:
        outcome = experiment.run_seed(seed, fz.Control())
        if mark is not None:
            outcome["classical"]["times"] = [mark] * 4
        left.add(seed, outcome)
    return left.path


def classical(folder):
    return document(folder)["rows"][0]["per_seed"]


def test_finished_seeds_are_not_run_again(tmp_path):
    leave_partial(tmp_path, mark=77.0)
    experiments.reproduce(Small(), range(3), tmp_path)
    assert [times[0] for times in classical(tmp_path)] == [77.0, 77.0, 9.6]


def test_finished_seeds_are_run_again_on_request(clean, tmp_path):
    leave_partial(tmp_path, mark=77.0)
    experiments.reproduce(Small(), SEEDS, tmp_path, resume=False)
    assert apart_from_run(tmp_path) == apart_from_run(clean)


def test_other_starts_were_compared_with_the_printed_ones(tmp_path):
    starts = ((2.0, 4.0), (1.0, 1.0))
    experiment = Table63(dataclasses.replace(CONFIG, starts=starts))
    result = experiments.reproduce(experiment, [0], tmp_path)
    assert result.rows[0].published == [4.5, None]
    assert {row.verdict for row in result.rows} == {"can't be checked"}


def test_seeds_of_another_config_are_not_used(clean, tmp_path):
    other = Table63(Table63Config(q_lambda=fz.QLambdaTraining(episodes=11), max_time=20.0))
    other.run_seed = Small().run_seed
    left = leave_partial(tmp_path, experiment=other, mark=77.0)
    before = left.read_bytes()
    experiments.reproduce(Small(), SEEDS, tmp_path)
    assert apart_from_run(tmp_path) == apart_from_run(clean)
    assert left.read_bytes() == before


def test_seeds_that_a_run_did_not_ask_for_were_thrown_away(tmp_path):
    leave_partial(tmp_path, seeds=(5, 0), mark=77.0)
    experiments.reproduce(Small(), range(2), tmp_path)
    assert [times[0] for times in classical(tmp_path)] == [77.0, 9.6]
    assert list(partial(tmp_path).read()) == [5]


@pytest.mark.parametrize("version", ["0.0.0", None])
def test_seeds_of_another_version_are_not_used(clean, tmp_path, version):
    path = leave_partial(tmp_path, mark=77.0)
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace(f'"{fz.__version__}"', json.dumps(version), 1), encoding="utf-8")
    experiments.reproduce(Small(), SEEDS, tmp_path)
    assert apart_from_run(tmp_path) == apart_from_run(clean)


@pytest.mark.parametrize("kept", [0.0, 0.001, 0.3, 0.7, 0.99])
def test_a_resume_file_cut_off_by_a_crash_is_tolerated(clean, tmp_path, kept):
    path = leave_partial(tmp_path)
    whole = path.read_bytes()
    path.write_bytes(whole[: int(kept * len(whole))])
    experiments.reproduce(Small(), SEEDS, tmp_path)
    assert apart_from_run(tmp_path) == apart_from_run(clean)


def test_a_resume_file_of_garbage_stopped_the_run(clean, tmp_path):
    partial(tmp_path).path.write_bytes(os.urandom(64) + b"\xff\n[1]\n3\n")
    experiments.reproduce(Small(), SEEDS, tmp_path)
    assert apart_from_run(tmp_path) == apart_from_run(clean)


def test_a_failing_seed_keeps_the_others_and_no_result_is_written(tmp_path):
    class Failing(Small):
        def run_seed(self, seed, control):
            if seed == 2:
                raise ZeroDivisionError
            return super().run_seed(seed, control)

    with pytest.raises(ZeroDivisionError):
        experiments.reproduce(Failing(), SEEDS, tmp_path, threads=1)
    assert list(tmp_path.iterdir()) == [partial(tmp_path).path]
    log = Log()
    experiments.reproduce(Small(), SEEDS, tmp_path, progress=log)
    assert log.lines[1][0] == "resumed"


@pytest.mark.parametrize("seeds", [[], [1, 1], [-1], [2**64]])
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
