"""Studies: grids and seeds, a database that survives anything, columns."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import re
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest

import fuzzyrs as fz
from fuzzyrs.studies.store import Run, Store
from studied import leave, line

posix = pytest.mark.skipif(os.name != "posix", reason="signals, rights and forks are POSIX's")

GRID: dict[str, list[Any]] = {"slope": [1, 2.5], "kind": ["a", "b", None]}


def numbers(results: fz.StudyResults) -> dict[str, list[Any]]:
    columns = results.columns()
    del columns["seconds"]
    return {name: column.tolist() for name, column in columns.items()}


def by_run(results: fz.StudyResults) -> list[str]:
    """All rows in an order that does not depend on that of the grid."""
    columns = dict(sorted(numbers(results).items()))
    return sorted(map(repr, zip(*columns.values(), strict=True)))


@pytest.mark.parametrize("backend", ["threads", "processes"])
def test_a_study_runs_every_point_with_every_seed(tmp_path: Path, backend: str) -> None:
    path = tmp_path / "study.db"
    results = fz.study(line, GRID, seeds=3, database=path, backend=backend, workers=2)
    columns = results.columns()
    assert columns["slope"].tolist() == [1] * 9 + [2.5] * 9
    assert columns["kind"].tolist() == (["a"] * 3 + ["b"] * 3 + [None] * 3) * 2
    assert columns["seed"].tolist() == [0, 1, 2] * 6
    assert columns["value"].tolist() == [0, 1, 2] * 3 + [0, 2.5, 5] * 3
    assert columns["large"].dtype == bool
    again = fz.open_study(path)
    assert by_run(again) == by_run(results)
    assert "18 runs" in repr(results)


def test_what_is_done_is_not_done_again(tmp_path: Path) -> None:
    calls: list[tuple[int, int]] = []

    def counted(seed: int, place: int) -> float:
        calls.append((seed, place))
        return seed / (place + 1)

    def run(places: list[int], seeds: list[int]) -> fz.StudyResults:
        grid = {"place": places}
        return fz.study(counted, grid, seeds=seeds, database=tmp_path / "s.db", name="counted")

    run([0, 1], [7, 8])
    assert len(calls) == 4
    grown = run([0, 1, 2], [8, 9, 7])
    assert sorted(calls[4:]) == [(7, 2), (8, 2), (9, 0), (9, 1), (9, 2)]
    assert grown.columns()["seed"].tolist() == [8, 9, 7] * 3
    # A part of what is there.
    assert run([1], [9]).columns()["value"].tolist() == [4.5]
    assert len(calls) == 9


@dataclasses.dataclass
class Technique:
    rate: float

    def run(self, seed: int) -> float:
        return self.rate * seed

    def __call__(self, seed: int) -> float:
        return self.run(seed)

    @classmethod
    def of_all(cls, seed: int) -> int:
        return seed


def scaled(seed: int, by: Any = 1, of: Any = None) -> float:
    return seed * (by if of is None else of.rate)


def within(rate: float) -> Callable[[int], float]:
    def run(seed: int) -> float:
        return rate * seed

    return run


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (Technique(0.1).run, Technique(0.2).run),
        (Technique(0.1), Technique(0.2)),
        (lambda seed: 0.1 * seed, lambda seed: 0.2 * seed),
        (within(0.1), within(0.2)),
        (partial(scaled, of=Technique(0.1)), partial(scaled, of=Technique(0.2))),
        (partial(within(0.1)), partial(within(0.2))),
        (Technique.of_all, Technique.of_all),
    ],
    ids=["method", "object", "lambda", "nested", "partial", "partial of nested", "class method"],
)
def test_a_function_does_not_get_the_results_of_another_of_its_name(
    tmp_path: Path, first: Callable[..., Any], second: Callable[..., Any]
) -> None:
    path = tmp_path / "s.db"
    for function in (first, second):
        with pytest.raises(fz.errors.InvalidValueError, match="give the study a name of its own"):
            fz.study(function, {}, seeds=3, database=path)
    assert not path.exists()
    for name, function in (("first", first), ("second", second)):
        results = fz.study(function, {}, seeds=3, database=path, name=name)
        assert results.columns()["value"].tolist() == [function(seed=seed) for seed in range(3)]


def test_a_partial_function_goes_on_in_another_process(tmp_path: Path) -> None:
    path = tmp_path / "s.db"
    fz.study(partial(scaled, by=2), {}, seeds=2, database=path)
    fz.study(partial(scaled, by=3), {}, seeds=2, database=path)
    fz.study(partial(scaled, of=Technique(0.1)), {}, seeds=2, database=path, name="a tenth")
    # Another object of the same value, as another process has it.
    again = partial(scaled, of=Technique(0.1))
    assert len(fz.study(again, {}, seeds=3, database=path, name="a tenth").runs) == 3
    name = f"{__name__}.scaled{{'by': 3}}"
    assert fz.open_study(path, name).columns()["value"].tolist() == [0, 3]


def test_an_exception_ends_a_study_and_nothing_is_lost(tmp_path: Path) -> None:
    broken = {3}

    def fragile(seed: int, control: fz.Control) -> dict[str, float]:
        assert not control.done
        if seed in broken:
            raise ZeroDivisionError("seed 3")
        return {"value": seed, "nothing": float("nan")}

    def run(**options: Any) -> fz.StudyResults:
        path = tmp_path / "s.db"
        return fz.study(fragile, {}, seeds=6, database=path, workers=1, name="fragile", **options)

    with pytest.raises(ZeroDivisionError, match="seed 3") as caught:
        run()
    if sys.version_info >= (3, 11):
        assert any("with seed 3" in note for note in caught.value.__notes__)
    assert fz.open_study(tmp_path / "s.db").columns()["value"].tolist()[:3] == [0, 1, 2]
    recorded = run(record_errors=True)
    assert recorded.columns()["value"].tolist() == [0, 1, 2, 4, 5]
    assert np.isnan(recorded.columns()["nothing"]).all()
    [failure] = recorded.failures()
    assert (failure.seed, failure.error) == (3, "ZeroDivisionError: seed 3")
    # A failed run is tried again.
    broken.clear()
    assert run().columns()["value"].tolist() == [0, 1, 2, 3, 4, 5]


def test_a_worker_that_ends_loses_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "s.db"
    with pytest.raises(fz.errors.ThreadsError, match="a worker process ended too early"):
        fz.study(leave, {}, seeds=50, database=path, backend="processes", workers=1)
    kept = fz.open_study(path).columns()["seed"].tolist()
    assert kept == list(range(len(kept)))
    with pytest.raises(fz.FuzzyrsError, match="define it in a module, or use backend='threads'"):
        fz.study(lambda seed: seed, {}, database=path, backend="processes", name="lambda")


def test_seeds_have_64_bits_and_outcomes_any_form(tmp_path: Path) -> None:
    runs = [
        Run({"b": True}, seed, {"a": [{"c": None}, seed], "": "\ud800"}, None, 0.5)
        for seed in (0, 2**63 - 1, 2**63, 2**64 - 1)
    ]
    failed = Run({"b": True}, 1, None, "half a pair: \ud800", 0.5)
    with Store(tmp_path / "s.db", "s", {}) as store:
        store.add([*reversed(runs), failed])
        kept = replace(failed, error="half a pair: \\ud800")
        assert store.runs() == [runs[0], kept, *runs[1:]]
        assert {seed for _, seed in store.done()} == {run.seed for run in runs}
        # What is there stays, unless it had failed.
        store.add([replace(run, seconds=0.1, error=None) for run in [*runs, failed]])
        assert store.runs() == [runs[0], replace(failed, error=None, seconds=0.1), *runs[1:]]
        anew = replace(runs[-1], outcome=None)
        store.add([anew], anew=True)
        assert store.runs()[-1] == anew


def test_runs_do_not_come_to_a_study_that_replaced_theirs(tmp_path: Path) -> None:
    path = tmp_path / "s.db"
    run = Run({}, 1, {"value": 1}, None, 0.5)
    with Store(path, "s", {"settings": 1}) as store:
        store.add([run])
        with contextlib.closing(sqlite3.connect(path)) as other, other:
            other.execute("DELETE FROM run")
            other.execute("DELETE FROM study")
        with Store(path, "s", {"settings": 2}) as replaced:
            with pytest.raises(fz.errors.FileError, match="removed or replaced their study"):
                store.add([run])
            assert replaced.runs() == []


def test_a_database_that_was_changed_is_told_of(tmp_path: Path) -> None:
    path = tmp_path / "s.db"
    fz.study(line, GRID, seeds=1, database=path)
    with contextlib.closing(sqlite3.connect(path)) as connection, connection:
        connection.execute("UPDATE run SET outcome = 'no JSON' WHERE point LIKE '%2.5%'")
    with pytest.raises(fz.errors.FormatError, match="was changed by another program"):
        fz.open_study(path)


def test_results_come_as_text(tmp_path: Path) -> None:
    results = fz.study(line, {"slope": [2], "kind": ["a"]}, seeds=2, database=tmp_path / "s.db")
    text = results.to_csv()
    assert text is not None
    header, first, second = text.splitlines()
    assert header == "slope,kind,seed,value,kind too,large,seconds"
    assert first.startswith("2,a,0,0,a,False,")
    assert second.startswith("2,a,1,2,a,False,")
    assert results.to_csv(tmp_path / "s.csv") is None
    assert (tmp_path / "s.csv").read_text(encoding="utf-8") == text


def outcome(seed: int, slope: float, kind: str) -> dict[str, Any]:
    """At slope 2 it is smaller, but on every fifth seed, where there is none at slope 1."""
    value = None if slope == 1 and seed % 5 == 0 else slope * (-1 if slope == 2 else 1) * seed
    return {"value": value, "text": kind, "infinite": float("inf") if slope == 1 else 0.0}


def test_points_are_compared_on_the_seeds_that_both_have(tmp_path: Path) -> None:
    path = tmp_path / "s.db"
    grid = {"slope": [1.0, 2.0], "kind": ["a", "b"]}
    fz.study(outcome, {"slope": [2.0], "kind": ["b"]}, seeds=range(3, 40), database=path)
    fz.study(outcome, {**grid, "kind": ["a"]}, seeds=50, database=path)
    results = fz.open_study(path)
    first, second = {"slope": 2, "kind": "a"}, {"slope": np.float64(1)}
    pairs = results.compare("value", first, second)
    # Of 50 seeds 40 have a number.
    assert (pairs.count, pairs.smaller, pairs.decision) == (40, 40, "smaller")
    seeds = [seed for seed in range(50) if seed % 5]
    assert pairs.difference == np.median([-3 * seed for seed in seeds])
    turned = results.compare("value", second, first)
    assert (turned.larger, turned.difference) == (40, -pairs.difference)
    fewer = results.compare("value", {"kind": "b"}, first)
    assert (fewer.count, fewer.equal, fewer.decision) == (37, 37, "undecided")
    infinite = results.compare("infinite", first, second)
    assert (infinite.count, infinite.difference) == (50, float("-inf"))


@pytest.mark.parametrize(
    ("measure", "first", "second", "message"),
    [
        ("valeu", {"slope": 1}, {"slope": 2}, "unknown outcome 'valeu'; did you mean 'value'?"),
        ("value", {"slop": 1}, {"slope": 2}, "unknown parameter 'slop'; did you mean 'slope'?"),
        ("value", {"slope": 3}, {"slope": 2}, "no run is at {'slope': 3}; there are runs at {'"),
        ("value", {"slope": True}, {"slope": 2}, "no run is at {'slope': True}"),
        ("value", {"slope": 1}, {"kind": "b"}, "not one point but 2; name 'kind' too"),
        ("value", 1, {"slope": 2}, "a point must be a dictionary of parameters, got 1"),
        ("value", {"slope": 2}, {"slope": 2, "kind": "a"}, "are the same point; name two"),
        ("text", {"slope": 1, "kind": "a"}, {"slope": 2}, "no seed has a number at both points"),
        ("value", {"slope": 1, "kind": "b"}, {"slope": 2}, "40 have one at {'slope': 1, 'kind'"),
    ],
)
def test_points_that_cannot_be_compared_are_told_of(
    tmp_path: Path, measure: str, first: Any, second: Any, message: str
) -> None:
    path = tmp_path / "s.db"
    fz.study(outcome, {"slope": [1], "kind": ["a", "b"]}, seeds=50, database=path)
    fz.study(outcome, {"slope": [2], "kind": ["a"]}, seeds=range(50, 60), database=path)
    with pytest.raises(fz.FuzzyrsError, match=re.escape(message)):
        fz.open_study(path).compare(measure, first, second)


@pytest.mark.parametrize("library", ["pandas", "polars"])
def test_results_come_as_frames(tmp_path: Path, library: str) -> None:
    frames = pytest.importorskip(library)
    results = fz.study(line, GRID, seeds=2, database=tmp_path / "s.db")
    frame = getattr(results, f"to_{library}")()
    assert isinstance(frame, frames.DataFrame)
    columns = results.columns()
    assert list(frame.columns) == list(columns)
    for name in ["slope", "seed", "value", "large", "seconds"]:
        assert list(frame[name]) == columns[name].tolist()


@pytest.mark.parametrize("library", ["pandas", "polars"])
def test_without_a_library_of_frames_it_is_said_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, library: str
) -> None:
    results = fz.study(line, GRID, seeds=1, database=tmp_path / "s.db")
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(ImportError, match=f"install it with: pip install {library}"):
        getattr(results, f"to_{library}")()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"grid": {"slope": []}}, "has no values"),
        ({"grid": {"slope": "abc"}}, "must be a list of values"),
        ({"grid": {"slope": [1, 1]}}, "has a value twice"),
        ({"grid": {"slope": [[1]]}}, "must be a number, a text"),
        ({"grid": {"seed": [1]}}, "can't be called 'seed'"),
        ({"seeds": 0}, "one seed at least"),
        ({"seeds": [1, 1]}, "differ"),
        ({"seeds": [-1]}, "from 0 to"),
        ({"seeds": 10**12}, "the seeds are more than"),
        ({"seeds": "ab"}, "a whole number or a list of them"),
        ({"seeds": 1.5}, "a whole number or a list of them"),
        ({"grid": {"slope": [2**64]}}, "must fit into 64 bits"),
        ({"name": "\ud800"}, "it is no text"),
        ({"name": ""}, "can't be called ''"),
        ({"name": " "}, "can't be called ' '"),
        ({"name": 3}, "must be a text, got 3"),
        ({"grid": {"slope": range(10**6)}, "seeds": range(100)}, "at most 10000000 runs"),
        ({"backend": "thread"}, "'threads'"),
        ({"workers": -1}, "zero or more"),
        ({"function": 3}, "runs a function"),
    ],
)
def test_bad_studies_are_refused_in_words(
    tmp_path: Path, arguments: dict[str, Any], message: str
) -> None:
    given = {"function": line, "grid": GRID, "database": tmp_path / "s.db", **arguments}
    with pytest.raises(fz.FuzzyrsError, match=message):
        fz.study(given.pop("function"), given.pop("grid"), **given)
    assert not (tmp_path / "s.db").exists()


def test_outcomes_must_be_plain_values(tmp_path: Path) -> None:
    with pytest.raises(fz.FuzzyrsError, match="outcome's 'path' must be a number"):
        fz.study(lambda seed: {"path": [seed]}, {}, database=tmp_path / "s.db", name="s")
    path = tmp_path / "t.db"
    results = fz.study(lambda seed: np.float64(seed), {}, seeds=2, database=path, name="t")
    assert results.columns()["value"].tolist() == [0.0, 1.0]


def test_other_files_are_refused(tmp_path: Path) -> None:
    def run(path: Path, **options: Any) -> None:
        fz.study(line, GRID, database=path, **options)

    text = tmp_path / "text.db"
    text.write_text("This is no database, but a text that is long enough to be looked at." * 20)
    with pytest.raises(fz.errors.FormatError, match="not a study database"):
        run(text)
    other = tmp_path / "other.db"
    with sqlite3.connect(other) as connection:
        connection.execute("CREATE TABLE cats (name TEXT)")
    connection.close()
    with pytest.raises(fz.errors.FormatError, match="not one of studies"):
        run(other)
    newer = tmp_path / "newer.db"
    run(newer, seeds=1)
    with sqlite3.connect(newer) as connection:
        connection.execute("PRAGMA user_version = 9")
    connection.close()
    with pytest.raises(fz.errors.FormatError, match="version 9"):
        run(newer)
    with pytest.raises(fz.errors.FileError, match="folder does not exist"):
        run(tmp_path / "nowhere" / "s.db")
    with pytest.raises(fz.errors.FileError, match="there is no study database"):
        fz.open_study(tmp_path / "none.db")
    assert not (tmp_path / "none.db").exists()
    (tmp_path / "empty.db").touch()
    with pytest.raises(fz.errors.FormatError, match="not one of studies"):
        fz.open_study(tmp_path / "empty.db")
    assert (tmp_path / "empty.db").stat().st_size == 0


def test_a_database_holds_several_studies(tmp_path: Path) -> None:
    path = tmp_path / "s.db"
    fz.study(line, GRID, seeds=1, database=path, name="first")
    with pytest.raises(fz.FuzzyrsError, match=r"otherwise: function was 'studied\.line', is"):
        fz.study(lambda seed: seed, {}, seeds=1, database=path, name="first")
    fz.study(lambda seed: seed, {}, seeds=2, database=path, name="second")
    assert len(fz.open_study(path, "second").runs) == 2
    with pytest.raises(fz.FuzzyrsError, match="'first', 'second'"):
        fz.open_study(path)
    with pytest.raises(fz.FuzzyrsError, match="no study 'third'"):
        fz.open_study(path, "third")


def test_finished_runs_survive_a_full_disk(tmp_path: Path) -> None:
    path = tmp_path / "s.db"
    fz.study(line, {"slope": [1], "kind": ["a"]}, seeds=3, database=path, name="s")

    def long(seed: int, slope: int, kind: str) -> str:
        return f"{seed}{slope}{kind}" * 10_000_000

    long.__module__, long.__qualname__ = line.__module__, line.__qualname__
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1_000_000, hard))
    try:
        with pytest.raises(fz.errors.FileError, match="intact"):
            fz.study(long, {"slope": [2], "kind": ["a"]}, seeds=1, database=path, name="s")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        signal.signal(signal.SIGXFSZ, ignored)
    assert fz.open_study(path).columns()["value"].tolist() == [0, 1, 2]


@contextlib.contextmanager
def without_rights(folder: Path) -> Iterator[None]:
    """As somebody who may read a folder and not write into it."""
    folder.chmod(0o555)
    if os.geteuid() == 0:
        os.seteuid(65534)
    try:
        yield
    finally:
        os.seteuid(os.getuid())
        folder.chmod(0o755)


@posix
def test_what_cannot_be_written_can_be_read() -> None:
    # Not pytest's folder, which only its owner may enter.
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        path = folder / "s.db"
        fz.study(line, GRID, seeds=1, database=path)
        with without_rights(folder):
            assert len(fz.open_study(path).runs) == 6
            with pytest.raises(fz.errors.FileError, match="cannot be written"):
                fz.study(line, GRID, seeds=2, database=path)
            with pytest.raises(fz.errors.FileError, match="cannot be written"):
                fz.study(line, GRID, database=folder / "new.db")
        assert len(fz.open_study(path).runs) == 6
        assert list(folder.iterdir()) == [path]


def test_who_writes_for_long_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fuzzyrs.studies.store.PATIENCE", 0.05)
    path = tmp_path / "s.db"
    fz.study(line, GRID, seeds=1, database=path)
    with contextlib.closing(sqlite3.connect(path)) as other:
        other.execute("BEGIN EXCLUSIVE")
        with pytest.raises(fz.errors.FileError, match="another program writes"):
            fz.study(line, GRID, seeds=2, database=path)
    assert len(fz.study(line, GRID, seeds=2, database=path).runs) == 12


# Processes are forked, so that none has to import anything before it is killed.
KILLED = """
import os, random, sqlite3, sys, time
import fuzzyrs as fz

def slow(seed, place):
    time.sleep(0.001)
    return {"value": seed * 1000 + place, "root": (seed + place) ** 0.5}

def study(database, told=None):
    def progress(done, total):
        if told is not None:
            os.write(told, f"{done}\\n".encode())
    grid = {"place": range(20)}
    return fz.study(slow, grid, seeds=40, database=database, workers=2, progress=progress)

def child(told):
    process = os.fork()
    if process == 0:
        study("killed.db", told)
        os._exit(0)
    return process

study("whole.db")
chance = random.Random(2010)
before = set()
for kill in range(20):
    read, write = os.pipe()
    process = child(write)
    os.close(write)
    told = []
    with open(read) as reports:
        # The first two die while the database is made.
        goal = len(before) + chance.randrange(1, 25) if kill >= 2 else 0
        while not told or told[-1] < goal:
            if kill < 2 or not (line := reports.readline()):
                break
            told.append(int(line))
        time.sleep(chance.uniform(0.0, 0.01))
        os.kill(process, 9)
        os.waitpid(process, 0)
        told += map(int, reports.read().split())
    connection = sqlite3.connect("killed.db")
    assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    tables = connection.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]
    # With their times: a run that is there is not done again.
    rows = set(connection.execute("SELECT * FROM run")) if tables else set()
    connection.close()
    assert before <= rows, "lost, or done again"
    assert len(rows) >= max(told, default=0), "told to be finished, but lost"
    before = rows
    print(len(rows))

# Two at once.
print("half", len(before))
processes = [child(1), child(1)]
assert [os.waitpid(process, 0)[1] for process in processes] == [0, 0]
"""


@posix
def test_killed_at_random_moments_a_study_ends_like_one_that_was_not(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", KILLED], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    kills, _ = done.stdout.split("half")
    assert len(set(kills.split())) > 15
    whole, killed = (fz.open_study(tmp_path / name) for name in ("whole.db", "killed.db"))
    assert len(whole.runs) == 800
    assert by_run(killed) == by_run(whole)


WITH_WORKERS = """
import fuzzyrs as fz
from studied import worker

if __name__ == "__main__":
    def progress(done, total):
        print(done, flush=True)
    fz.study(worker, {}, seeds=2000, database="s.db", backend="processes", workers=2,
             progress=progress)
"""


@posix
@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGTERM] if os.name == "posix" else [])
def test_workers_do_not_outlive_a_study_that_is_killed(tmp_path: Path, end: int) -> None:
    (tmp_path / "driver.py").write_text(WITH_WORKERS, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parent)}
    command = [sys.executable, "driver.py"]
    with subprocess.Popen(
        command, cwd=tmp_path, env=environment, stdout=subprocess.PIPE, text=True
    ) as driver:
        assert driver.stdout is not None
        while int(driver.stdout.readline()) < 4:
            pass
        driver.send_signal(end)
        # Its standard output is open as long as a worker lives.
        reader = Thread(target=driver.stdout.read, daemon=True)
        reader.start()
        reader.join(timeout=20.0)
        outlived = reader.is_alive()
        if outlived:
            for process in set(fz.open_study(tmp_path / "s.db").columns()["value"].tolist()):
                os.kill(process, signal.SIGKILL)
            reader.join()
    assert not outlived


@posix
def test_ctrl_c_keeps_what_is_finished(tmp_path: Path) -> None:
    def interrupting(seed: int) -> int:
        if seed == 5:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(0.3)
        return seed

    with pytest.raises(fz.StudyInterrupted, match="of 40 runs; they are kept") as caught:
        fz.study(interrupting, {}, seeds=40, database=tmp_path / "s.db", workers=1, name="s")
    finished = caught.value.results.columns()["seed"].tolist()
    assert 5 <= len(finished) < 40
    assert finished == list(range(len(finished)))
