"""Studies on Ray: the same runs as on threads, and none that is finished is lost."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

import fuzzyrs as fz
from studied import line

SCRIPT = """
import json, os, subprocess, sys, time
import ray
import fuzzyrs as fz
from studied import line

def study(function, seeds, database, backend="ray", **options):
    return fz.study(function, options.pop("grid", {}), seeds=seeds, database=database,
                    backend=backend, **options)

# A study starts a Ray if there is none, and ends it. Here it goes on: starting takes long.
ended = []
ray.shutdown = lambda: ended.append(True)

# A function of a module, and what is finished stays.
grid = {"slope": [1, 2.5], "kind": ["a", None]}
first = study(line, 3, "ray.db", grid=grid).runs
grown = study(line, 5, "ray.db", grid=grid)
assert len(grown.runs) == 20 and all(run in grown.runs for run in first)
assert ended == [True] and os.environ["RAY_USAGE_STATS_ENABLED"] == "0"
threads = study(line, 5, "threads.db", "threads", grid=grid)
assert [run.outcome for run in threads.runs] == [run.outcome for run in grown.runs]

# A function of this script, with what it encloses; more runs than are under way at a time.
factor = 3
tripled = study(lambda seed: factor * seed, 50, "closure.db", workers=2, name="tripled")
assert tripled.columns()["value"].tolist() == [factor * seed for seed in range(50)]

# An exception is the one that was raised, and earlier runs are kept.
def fragile(seed):
    if seed == 3:
        raise ZeroDivisionError("seed three")
    return seed

try:
    study(fragile, 6, "fragile.db", workers=1)
except ZeroDivisionError as error:
    assert "seed three" in str(error), error
else:
    raise AssertionError
assert [run.seed for run in fz.open_study("fragile.db").runs] == [0, 1, 2]
recorded = study(fragile, 6, "fragile.db", record_errors=True)
assert [run.error for run in recorded.failures()] == ["ZeroDivisionError: seed three"]
assert len(recorded.runs) == 6

# A driver that is killed.
os.environ["RAY_ADDRESS"] = ray.get_runtime_context().gcs_address
command = [sys.executable, "-m", "fuzzyrs", "study", "slow.toml", "--json", "--backend", "ray"]
driver = subprocess.Popen([*command, "--database", "killed.db"], stdout=subprocess.PIPE)
told = [line for line, _ in zip(driver.stdout, range(2))]
driver.kill()
driver.communicate()
killed = fz.open_study("killed.db").columns()
assert json.loads(told[-1])["done"] <= len(killed["seed"]) < 1000
assert (killed["value"] == 1000 * killed["seed"] + killed["place"]).all()

# This driver is interrupted, and all of Ray's processes with it.
def wait(seed):
    time.sleep(0.02)
    return seed

try:
    study(wait, 2000, "stopped.db", progress=lambda done, total: print(done, flush=True))
except fz.StudyInterrupted as interruption:
    print(len(interruption.results.runs), interruption, flush=True)
"""

SLOW = """
import time

def slow(seed, place):
    time.sleep(0.02)
    return {"value": seed * 1000 + place}
"""

SLOW_STUDY = """
[study]
function = "slow:slow"
seeds = 500

[grid]
place = [1, 2]
"""


@pytest.mark.skipif(find_spec("ray") is None, reason="Ray is optional")
@pytest.mark.skipif(os.name != "posix", reason="signals are sent")
def test_studies_on_ray_are_those_on_threads(tmp_path: Path) -> None:
    (tmp_path / "script.py").write_text(SCRIPT, encoding="utf-8")
    (tmp_path / "slow.py").write_text(SLOW, encoding="utf-8")
    (tmp_path / "slow.toml").write_text(SLOW_STUDY, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parent)}
    environment.pop("RAY_ADDRESS", None)
    script = subprocess.Popen(
        [sys.executable, "-W", "error", "script.py"],
        cwd=tmp_path,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert script.stdout is not None
    before, told = script.stdout.readline(), script.stdout.readline()
    if told:
        # As a terminal does: to all processes.
        os.killpg(script.pid, signal.SIGINT)
    output, errors = script.communicate()
    assert script.returncode == 0, errors
    assert (before, int(told) > 0) == ("0\n", True)
    *_, last = output.splitlines()
    finished = fz.open_study(tmp_path / "stopped.db").columns()
    count = len(finished["seed"])
    assert int(told) <= count < 2000
    assert last.startswith(f"{count} interrupted after {count} of 2000 runs; they are kept in")
    assert finished["seed"].tolist() == finished["value"].tolist()


def test_without_ray_it_is_said_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(ImportError, match=r"pip install 'fuzzyrs\[ray\]'"):
        fz.study(line, {}, seeds=1, database=tmp_path / "s.db", backend="ray")
