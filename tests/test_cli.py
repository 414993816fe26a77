"""The command line."""

from __future__ import annotations

import io
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

import fuzzyrs as fz
from fuzzyrs import cli, experiments
from fuzzyrs.cli import drawings
from fuzzyrs.experiments import registry
from fuzzyrs.experiments.chapter6 import Table63
from small import Small, Undrawn


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setitem(registry._EXPERIMENTS, "table-6-3", Undrawn)


def fuzzyrs(*arguments):
    command = [sys.executable, "-m", "fuzzyrs", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True)


def test_the_list_names_every_experiment(capsys):
    assert cli.main(["list"]) == 0
    output = capsys.readouterr().out
    assert re.search(
        "^  table-6-3 +capture time from four starts of the evader", output, re.MULTILINE
    )
    assert "Table 6.3, section 6.5.2" in output


def test_the_version_is_told(capsys):
    with pytest.raises(SystemExit) as end:
        cli.main(["--version"])
    assert end.value.code == 0
    assert capsys.readouterr().out == f"fuzzyrs {fz.__version__}\n"


def test_the_main_job_prints_lines_and_writes_its_files(tmp_path):
    done = fuzzyrs("reproduce", "table-6-3", "--seeds", 2, "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    assert "\r" not in done.stdout + done.stderr
    assert "\x1b" not in done.stdout + done.stderr
    last = done.stderr.splitlines()[-1]
    assert re.fullmatch(r"table-6-3: 2 of 2 seeds in .* s; all in all .* s, about 0.0 s left", last)
    for name in ["classical", "q_lambda", "reward_ga", "qlbgflc", "learning_time"]:
        assert f"\n{name} " in done.stdout
    assert "  published  9.6             10.4               4.5             8.5" in done.stdout
    assert "verdict: reproduced (equal in every cell)" in done.stdout
    names = {path.name for path in tmp_path.iterdir()}
    kept = {"runs.sqlite", "table-6-3.games.json"}
    shown = {"table-6-3-pursuer.json", "table-6-3.json"}
    assert names > kept | shown | {"table-6-3-paths.png", "table-6-3-paths.svg"}
    for name in names - kept:
        assert f"wrote {tmp_path / name}" in done.stdout
        begins = (tmp_path / name).read_bytes()[:5]
        assert (begins == b"\x89PNG\r") == name.endswith(".png")
        assert (begins == b"<?xml") == name.endswith(".svg")
    assert len(fz.load(tmp_path / "table-6-3-pursuer.json").system.parameters) == 21
    result = json.loads((tmp_path / "table-6-3.json").read_text(encoding="utf-8"))
    assert result["config"]["qlbgflc"]["stage_1"]["iterations"] == 800


@pytest.mark.usefixtures("small")
def test_seeds_are_counted_from_the_first(tmp_path, capsys):
    options = ["--seeds", "3", "--seed", "5", "--threads", "2", "--out", str(tmp_path)]
    assert cli.main(["reproduce", "table-6-3", *options]) == 0
    assert json.loads((tmp_path / "table-6-3.json").read_text())["seeds"] == [5, 6, 7]
    assert "3 seeds from 5;" in capsys.readouterr().out


@pytest.mark.usefixtures("small")
@pytest.mark.parametrize(("option", "count"), [(["--quick"], 3), ([], 20)])
def test_without_a_number_the_experiment_decides_how_many_seeds(tmp_path, option, count):
    assert cli.main(["reproduce", "table-6-3", *option, "--out", str(tmp_path / "a" / "b")]) == 0
    document = json.loads((tmp_path / "a" / "b" / "table-6-3.json").read_text())
    assert document["seeds"] == list(range(count))


@pytest.mark.usefixtures("small")
def test_escapes_are_counted_in_the_table(tmp_path, capsys):
    assert cli.main(["reproduce", "table-6-3", "--quick", "--out", str(tmp_path)]) == 0
    output = capsys.readouterr().out
    assert "  not caught  " in output
    assert "-]" in output


@pytest.mark.usefixtures("small")
def test_a_terminal_gets_a_bar(tmp_path, capsys, monkeypatch):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    assert cli.main(["reproduce", "table-6-3", "--quick", "--out", str(tmp_path)]) == 0
    assert "3/3" in terminal.getvalue()
    assert "\r" in terminal.getvalue()
    assert "\r" not in capsys.readouterr().out


def test_an_experiment_that_shows_two_figures_runs_once(tmp_path, capsys):
    arguments = ["figure-6-7", "figure-6-6", "--seeds", "1", "--out", str(tmp_path)]
    assert cli.main(["reproduce", *arguments]) == 0
    assert capsys.readouterr().out.count("figure-6-6: ") == 1


def test_a_chapter_is_all_of_its_experiments(tmp_path, capsys, monkeypatch):
    options = ["--seeds", "1", "--json", "--out", str(tmp_path)]
    light = [kind for kind in registry._EXPERIMENTS.values() if kind.chapter() in (5, 7)]
    light = [kind for kind in light if kind.id in ("table-5-2", "table-5-3", "table-7-1")]
    monkeypatch.setattr(registry, "_EXPERIMENTS", {kind.id: kind for kind in light})
    assert cli.main(["reproduce", "table-7-1", "chapter-5", *options]) == 0
    events = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    kinds = experiments.select(["table-5-2", "table-5-3", "table-7-1"])
    assert events[0] == {
        "event": "plan",
        "experiments": [{"id": kind.id, "seeds": 1} for kind in kinds],
    }
    results = [event for event in events if event["event"] == "result"]
    assert [event["id"] for event in results] == [kind.id for kind in kinds]
    drawn = {event["id"] for event in events if event["event"] == "figures"}
    assert drawn == {event["id"] for event in results}
    files = [file for event in events for file in event.get("files", [])]
    assert all(Path(file).exists() for file in files)
    assert len(files) >= 3 + 1
    for event in events:
        if event["event"] == "seeds":
            assert (event["done"], event["total"]) == (1, 1)
            assert event["remaining"] >= 0
    claims = json.loads((tmp_path / "claims.json").read_text(encoding="utf-8"))
    assert [claim["number"] for claim in claims] == [7, 8, 9]
    assert claims[2]["findings"][0]["verdict"] == "not run"
    assert events[-2]["claims"] == claims
    assert events[-1] == {"event": "report", "files": [str(tmp_path / "report.html")]}


def test_claims_go_by_what_earlier_runs_left_too(tmp_path, capsys):
    options = ["--seeds", "1", "--out", str(tmp_path)]
    cli.main(["reproduce", "table-6-1", "table-5-3", *options])
    cli.main(["reproduce", "table-6-1", "table-5-2", *options])
    said = capsys.readouterr().out
    claims = json.loads((tmp_path / "claims.json").read_text(encoding="utf-8"))
    [converges] = [claim for claim in claims if claim["number"] == 8]
    verdicts = [finding["verdict"] for finding in converges["findings"]]
    assert verdicts == [*["not run"] * 3, *["can't be checked"] * 2]
    assert "  7. Q stays below the bound (5.5). (section 5.3)" in said
    assert "figure-5-2, model, λ 0.9: not run" in said


def test_a_piped_run_says_what_was_done_before(tmp_path, capsys):
    options = ["--seeds", "2", "--out", str(tmp_path)]
    assert cli.main(["reproduce", "table-5-2", *options]) == 0
    assert cli.main(["reproduce", "table-5-2", *options]) == 0
    said = capsys.readouterr().err.splitlines()
    assert said[-1] == "table-5-2: going on with 2 of 2 seeds that are done already"
    assert cli.main(["reproduce", "table-5-2", "--no-resume", *options]) == 0
    assert "2 of 2 seeds in" in capsys.readouterr().err.splitlines()[-1]


def test_show_tells_all_that_a_run_depends_on(capsys):
    assert cli.main(["show", "figure-6-7"]) == 0
    said = capsys.readouterr().out
    assert said.startswith("figure-6-6: duration of the learning games")
    assert "also:      figure-6-7" in said
    assert "reproduce: fuzzyrs reproduce figure-6-6" in said
    assert "  steps: [600, 1200," in said
    assert cli.main(["show", "table-6-3", "--json"]) == 0
    about = json.loads(capsys.readouterr().out)
    assert about["config"] == json.loads(json.dumps(Table63().config()))
    assert about["published"]["classical"] == [9.6, 10.4, 4.5, 8.5]
    assert about["chapter"] == 6


def test_the_list_is_also_for_machines(capsys):
    assert cli.main(["list", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert [about["id"] for about in listed] == experiments.ids()
    assert all(about["cost"] > 0 and about["claim"] for about in listed)
    # They differ by orders of magnitude; all were the same once.
    assert len({about["cost"] for about in listed}) > 20


def test_an_unknown_id_gets_a_hint_before_anything_runs(tmp_path):
    done = fuzzyrs("reproduce", "table-6-3", "tabel-6-3", "--out", tmp_path / "out")
    assert done.returncode == 2
    assert done.stderr == ("fuzzyrs: unknown experiment 'tabel-6-3'; did you mean 'table-6-3'?\n")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--seeds", "0"], "must be at least 1, got 0"),
        (["--seeds", "few"], "must be a whole number, got 'few'"),
        (["--threads", "-1"], "must be zero or more, got -1"),
        (["--seed", "-1"], "must be zero or more, got -1"),
    ],
)
def test_impossible_options_are_refused_in_words(capsys, options, words):
    with pytest.raises(SystemExit) as end:
        cli.main(["reproduce", "table-6-3", *options])
    assert end.value.code == 2
    assert words in capsys.readouterr().err


def test_a_seed_too_large_is_bad_usage(tmp_path, capsys):
    options = ["--seed", str(2**63), "--out", str(tmp_path)]
    assert cli.main(["reproduce", "table-6-3", *options]) == 2
    assert capsys.readouterr().err == "fuzzyrs: seeds must be whole numbers from 0 to 2^63 - 1\n"


def test_no_command_shows_how_to_use_it(capsys):
    with pytest.raises(SystemExit) as end:
        cli.main([])
    assert end.value.code == 2
    assert "usage: fuzzyrs" in capsys.readouterr().err


def test_a_folder_that_cannot_be_written_is_told_before_the_work(tmp_path):
    (tmp_path / "file").write_text("mine")
    done = fuzzyrs("reproduce", "table-6-3", "--out", tmp_path / "file")
    assert done.returncode == 1
    assert done.stderr.startswith(f"fuzzyrs: cannot write results into {tmp_path / 'file'}: ")
    assert len(done.stderr.splitlines()) == 1


def test_a_figure_that_could_not_be_written_was_a_traceback(tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(registry._EXPERIMENTS, "table-6-3", Small)
    (tmp_path / "table-6-3-paths.png").mkdir()
    assert cli.main(["reproduce", "table-6-3", "--seeds", "1", "--out", str(tmp_path)]) == 1
    assert "table-6-3-paths.png" in capsys.readouterr().err.splitlines()[-1]


def test_without_matplotlib_the_result_is_written_all_the_same(tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(registry._EXPERIMENTS, "table-6-3", Small)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert cli.main(["reproduce", "table-6-3", "--seeds", "1", "--out", str(tmp_path)]) == 0
    assert (tmp_path / "table-6-3-pursuer.json").exists()
    assert "no figures: plotting needs matplotlib" in capsys.readouterr().err


def test_what_has_no_chance_was_run_for_every_seed(tmp_path, capsys):
    assert cli.main(["reproduce", "table-6-1", "--seeds", "5", "--out", str(tmp_path)]) == 0
    assert json.loads((tmp_path / "table-6-1.json").read_text())["seeds"] == [0]
    assert "1 seed from 0" in capsys.readouterr().out


def test_seeds_that_take_seconds_are_fewer_in_a_chapter(monkeypatch, capsys, tmp_path):
    class Slow(Undrawn):
        most_seeds = 2

    monkeypatch.setattr(registry, "_EXPERIMENTS", {"table-6-3": Slow})
    options = ["--seeds", "3", "--out", str(tmp_path)]
    assert cli.main(["reproduce", "chapter-6", *options]) == 0
    captured = capsys.readouterr()
    assert "2 seeds from 0" in captured.out
    assert "table-6-3 gets 2 seeds; by its own id it gets all" in captured.err
    assert cli.main(["reproduce", "table-6-3", *options]) == 0
    assert "3 seeds from 0" in capsys.readouterr().out
    assert cli.main(["show", "table-6-3"]) == 0
    assert "in a chapter or all 2 at most" in capsys.readouterr().out


def test_a_closed_standard_error_ended_the_command(tmp_path):
    line = f"{sys.executable} -m fuzzyrs reproduce table-6-1 --out {tmp_path} 2>&-"
    done = subprocess.run(line, shell=True, stdout=subprocess.PIPE, text=True)
    assert done.returncode == 0
    assert "verdict: reproduced" in done.stdout


def test_a_killed_drawing_process_ended_everything(tmp_path, capsys, monkeypatch):
    add = drawings.Drawings.add

    def add_after_a_kill(self, identifier):
        for process in list((self._pool._processes or {}).values()):
            process.kill()
            process.join()
        add(self, identifier)

    monkeypatch.setattr(drawings.Drawings, "add", add_after_a_kill)
    ids = ["table-6-1", "table-8-1", "table-7-1"]
    assert cli.main(["reproduce", *ids, "--out", str(tmp_path)]) == 0
    captured = capsys.readouterr()
    assert "was not drawn: " in captured.err
    assert {f"{identifier}.json" for identifier in ids} < {path.name for path in tmp_path.iterdir()}
    # The report draws what is missing.
    assert list(tmp_path.glob("table-7-1*.svg"))


def test_an_old_report_stood_beside_a_new_result(tmp_path, capsys):
    cli.main(["reproduce", "table-6-1", "table-8-1", "--out", str(tmp_path)])
    before = (tmp_path / "report.html").read_text(encoding="utf-8")
    cli.main(["reproduce", "table-7-1", "--out", str(tmp_path)])
    after = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert before != after
    assert capsys.readouterr().out.count("report.html") == 2
