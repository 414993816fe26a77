"""Studies on Ray: the same runs as on threads, and none that is finished is lost."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

import fuzzyrs as fz

needs_ray = pytest.mark.skipif(find_spec("ray") is None, reason="Ray is optional")

CLUSTER = """
import os, signal, subprocess, sys, time
import ray
import fuzzyrs as fz
from studied import line
os.environ["RAY_USAGE_STATS_ENABLED"] = "0"
ray.init("local", num_cpus=2, include_dashboard=False, log_to_driver=False, logging_level="error")

def study(function, seeds, database, backend="ray", **options):
    return fz.study(function, options.pop("grid", {}), seeds=seeds, database=database,
                    backend=backend, **options)

# A function of a module, and what is finished stays.
grid = {"slope": [1, 2.5], "kind": ["a", None]}
first = study(line, 3, "ray.db", grid=grid).runs
grown = study(line, 5, "ray.db", grid=grid)
assert len(grown.runs) == 20 and all(run in grown.runs for run in first)
threads = study(line, 5, "threads.db", "threads", grid=grid)
assert [run.outcome for run in threads.runs] == [run.outcome for run in grown.runs]

# A function of this script, with what it encloses; more runs than are under way at a time.
factor = 3
tripled = study(lambda seed: factor * seed, 50, "closure.db", workers=2)
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
print(told[-1].decode())
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


def last_told(lines: list[str]) -> int:
    events = [json.loads(line) for line in lines if line]
    return max(event["done"] for event in events if "done" in event)


@needs_ray
@pytest.mark.skipif(os.name != "posix", reason="signals are sent")
def test_studies_on_ray_are_those_on_threads(tmp_path: Path) -> None:
    (tmp_path / "cluster.py").write_text(CLUSTER, encoding="utf-8")
    (tmp_path / "slow.py").write_text(SLOW, encoding="utf-8")
    (tmp_path / "slow.toml").write_text(SLOW_STUDY, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parent)}
    environment.pop("RAY_ADDRESS", None)

    def start(*arguments: str) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [sys.executable, "-W", "error", *arguments],
            cwd=tmp_path,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    # It starts a Ray of its own, and is told to stop as a terminal does: with all its processes.
    own = start("-m", "fuzzyrs", "study", "slow.toml", "--json", "--backend", "ray")
    cluster = start("cluster.py")
    output, errors = cluster.communicate()
    assert cluster.returncode == 0, errors
    told = [line for line, _ in zip(own.stdout or (), range(2), strict=False)]
    os.killpg(own.pid, signal.SIGINT)
    output_of_own, errors = own.communicate()
    assert own.returncode == 130, errors
    assert "the same command goes on from there" in errors

    for database, lines in [("killed.db", output), ("slow.db", "".join(told) + output_of_own)]:
        finished = fz.open_study(tmp_path / database).columns()
        assert last_told(lines.split("\n")) <= len(finished["seed"]) < 1000
        assert (finished["value"] == 1000 * finished["seed"] + finished["place"]).all()


def test_without_ray_it_is_said_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(ImportError, match=r"pip install 'fuzzyrs\[ray\]'"):
        fz.study(lambda seed: seed, {}, seeds=1, database=tmp_path / "s.db", backend="ray")
