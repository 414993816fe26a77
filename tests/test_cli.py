"""The command line."""

from __future__ import annotations

import io
import json
import re
import subprocess
import sys

import pytest

import fuzzyrs as fz
from fuzzyrs import cli
from fuzzyrs.experiments import registry
from small import Small


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setitem(registry._EXPERIMENTS, "table-6-3", Small)


def fuzzyrs(*arguments):
    command = [sys.executable, "-m", "fuzzyrs", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True)


def test_the_list_names_every_experiment(capsys):
    assert cli.main(["list"]) == 0
    output = capsys.readouterr().out
    assert re.search(
        "^table-6-3 +capture time from four starts of the evader", output, re.MULTILINE
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
    said = done.stderr.splitlines()
    assert sorted(line.split("(")[0] for line in said) == [
        "table-6-3: seed 0 done ",
        "table-6-3: seed 1 done ",
    ]
    assert [line.split("done ")[1] for line in said] == ["(1 of 2)", "(2 of 2)"]
    for name in ["classical", "q_lambda", "reward_ga", "qlbgflc", "learning_time"]:
        assert f"\n{name} " in done.stdout
    assert "  published  9.6             10.4               4.5             8.5" in done.stdout
    assert "verdict: reproduced (equal in every cell)" in done.stdout
    names = [
        "table-6-3-paths.png",
        "table-6-3-pursuer.json",
        "table-6-3.json",
    ]
    assert sorted(path.name for path in tmp_path.iterdir()) == names
    for name in names:
        assert f"wrote {tmp_path / name}" in done.stdout
        png = (tmp_path / name).read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
        assert png == name.endswith(".png")
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
    options = ["--seed", str(2**64), "--out", str(tmp_path)]
    assert cli.main(["reproduce", "table-6-3", *options]) == 2
    assert capsys.readouterr().err == "fuzzyrs: seeds must be whole numbers from 0 to 2^64 - 1\n"


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


@pytest.mark.usefixtures("small")
def test_a_figure_that_could_not_be_written_was_a_traceback(tmp_path, capsys):
    (tmp_path / "table-6-3-paths.png").mkdir()
    assert cli.main(["reproduce", "table-6-3", "--seeds", "1", "--out", str(tmp_path)]) == 1
    assert "table-6-3-paths.png" in capsys.readouterr().err.splitlines()[-1]


@pytest.mark.usefixtures("small")
def test_without_matplotlib_the_result_is_written_all_the_same(tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert cli.main(["reproduce", "table-6-3", "--seeds", "1", "--out", str(tmp_path)]) == 0
    assert (tmp_path / "table-6-3.json").exists()
    assert "no figures: plotting needs matplotlib" in capsys.readouterr().err
