"""Running an experiment over seeds: on several threads, to disk as they finish, resumable."""

from __future__ import annotations

import hashlib
import json
import os
import platform
import time
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from pathlib import Path
from typing import Any, Protocol

from fuzzyrs._fuzzyrs import Control, __version__, write_text
from fuzzyrs.errors import FuzzyrsError, from_kind
from fuzzyrs.experiments.experiment import Experiment
from fuzzyrs.experiments.result import Result

Outcome = dict[str, Any]

#: More seeds than this would not fit into a result that anybody reads.
MOST_SEEDS = 100_000


class Progress(Protocol):
    """Who is told how far a run is."""

    def started(self, total: int) -> None:
        """Work on that many seeds begins."""

    def resumed(self, done: int, total: int) -> None:
        """Seeds of an interrupted run were found."""

    def finished(self, seed: int, done: int, total: int) -> None:
        """One more seed is done."""


class Interrupted(KeyboardInterrupt):
    """A run was stopped by Ctrl-C; what it finished is on disk."""

    def __init__(self, done: int, total: int, path: Path) -> None:
        super().__init__(f"interrupted after {done} of {total} seeds; they are kept in {path}")


class Partial:
    """The finished seeds of runs that are not complete, one JSON line each.

    The first line says which experiment, version and config they belong to, and so does the
    file's name: runs of another config have another file. A line that was cut off by a crash is
    ignored.
    """

    def __init__(self, folder: Path, experiment: Experiment) -> None:
        header = {"id": experiment.id, "version": __version__, "config": experiment.config()}
        self._header = json.dumps(header)
        digest = hashlib.sha256(self._header.encode()).hexdigest()[:8]
        self.path = folder / f"{experiment.id}.{digest}.partial.jsonl"

    def read(self) -> dict[int, Outcome]:
        """Return the outcomes by seed; none if there is no such file."""
        try:
            text = self.path.read_text(encoding="utf-8", errors="replace")
        except FileNotFoundError:
            return {}
        except OSError as error:
            raise _file_error("read", self.path, error) from error
        header, *lines = text.split("\n")
        return dict(filter(None, map(_record, lines))) if header == self._header else {}

    def write(self, outcomes: dict[int, Outcome]) -> None:
        """Replace the file by one with these outcomes, or by none if there are none."""
        if outcomes:
            lines = [self._header, *(_line(seed, outcome) for seed, outcome in outcomes.items())]
            write_text(self.path, "\n".join(lines) + "\n")
        else:
            self.path.unlink(missing_ok=True)

    def add(self, seed: int, outcome: Outcome) -> None:
        """Append one seed, and see it on disk before going on."""
        new = not self.path.exists()
        try:
            with self.path.open("a", encoding="utf-8") as file:
                file.write((self._header + "\n" if new else "") + _line(seed, outcome) + "\n")
                file.flush()
                os.fsync(file.fileno())
        except OSError as error:
            raise _file_error("write", self.path, error) from error


def _line(seed: int, outcome: Outcome) -> str:
    return json.dumps({"seed": seed, "outcome": outcome})


def _record(line: str) -> tuple[int, Outcome] | None:
    """Return the seed and its outcome from a line, or None if it is not whole."""
    try:
        record = json.loads(line)
    except ValueError:
        return None
    match record:
        case {"seed": int(seed), "outcome": {"seconds": dict()} as outcome}:
            return seed, dict(outcome)
    return None


def _file_error(action: str, path: Path, error: OSError) -> FuzzyrsError:
    return from_kind("file", f"cannot {action} {path}: {error.strerror or error}")


def reproduce(
    experiment: Experiment,
    seeds: Sequence[int],
    folder: Path,
    *,
    threads: int = 0,
    resume: bool = True,
    progress: Progress | None = None,
) -> Result:
    """Run an experiment and write its result as JSON.

    Parameters
    ----------
    experiment : Experiment
        What to run.
    seeds : sequence of int
        One run each; at least one, all different.
    folder : pathlib.Path
        Where the result goes; made if needed. Figures are drawn by the experiment's `draw`.
    threads : int, optional
        How many seeds at a time; 0 for one on each core. Results do not depend on it.
    resume : bool, optional
        Whether to use the seeds that an interrupted run of the same config left.
    progress : Progress, optional
        Who is told.

    Returns
    -------
    Result

    Raises
    ------
    Interrupted
        On Ctrl-C; the finished seeds are on disk.
    FileError
        If the folder cannot be written.
    """
    seeds = _checked(seeds)
    began = time.perf_counter()
    threads = threads or _usable_cores()
    _prepare(folder)
    partial = Partial(folder, experiment)
    known = partial.read() if resume else {}
    outcomes = {seed: known[seed] for seed in seeds if seed in known}
    if progress is not None:
        progress.started(len(seeds))
        if outcomes:
            progress.resumed(len(outcomes), len(seeds))
    # Anew: a line that was cut off must not run into the next.
    partial.write(known)

    def finished(seed: int, outcome: Outcome) -> None:
        partial.add(seed, outcome)
        outcomes[seed] = outcome
        if progress is not None:
            progress.finished(seed, len(outcomes), len(seeds))

    try:
        waiting = [seed for seed in seeds if seed not in outcomes]
        _run_seeds(experiment, waiting, threads, finished)
    except KeyboardInterrupt as interruption:
        raise Interrupted(len(outcomes), len(seeds), partial.path) from interruption

    ordered = [outcomes[seed] for seed in seeds]
    result = Result(
        id=experiment.id,
        seeds=list(seeds),
        config=experiment.config(),
        rows=experiment.rows(ordered),
        run={
            "seconds": round(time.perf_counter() - began, 3),
            "seconds_per_seed": [outcome.get("seconds", {}) for outcome in ordered],
            "threads": threads,
            "machine": platform.node(),
            "processor": platform.machine(),
            "python": platform.python_version(),
        },
        outcomes=ordered,
    )
    write_text(folder / f"{experiment.id}.json", result.to_json())
    # Seeds that this run did not ask for stay for one that does.
    partial.write({seed: outcome for seed, outcome in known.items() if seed not in outcomes})
    return result


def _run_seeds(
    experiment: Experiment,
    seeds: Sequence[int],
    threads: int,
    finished: Callable[[int, Outcome], None],
) -> None:
    """Run the seeds on threads; on a failure or Ctrl-C, stop the others and keep what is done.

    The work itself is Rust with the GIL released, so threads are as good as processes.
    """
    control = Control()
    pool = ThreadPoolExecutor(max_workers=threads, thread_name_prefix="fuzzyrs")
    running = {pool.submit(experiment.run_seed, seed, control): seed for seed in seeds}
    try:
        while running:
            done, _ = wait(running, timeout=0.1, return_when=FIRST_COMPLETED)
            for future in done:
                outcome = future.result()
                finished(running.pop(future), outcome)
    except BaseException:
        control.cancel()
        pool.shutdown(wait=True, cancel_futures=True)
        for future, seed in running.items():
            if _succeeded(future):
                finished(seed, future.result())
        raise
    pool.shutdown()


def _succeeded(future: Future[Outcome]) -> bool:
    return future.done() and not future.cancelled() and future.exception() is None


def _checked(seeds: Sequence[int]) -> list[int]:
    """Return the seeds as plain integers, or say what is wrong with them."""
    if not 1 <= len(seeds) <= MOST_SEEDS:
        message = f"the number of seeds must be from 1 to {MOST_SEEDS}, got {len(seeds)}"
        raise from_kind("out_of_range", message)
    plain = [int(seed) for seed in seeds]
    if len(set(plain)) < len(plain):
        raise from_kind("out_of_range", "the seeds must differ from each other")
    if not all(0 <= seed < 2**64 for seed in plain):
        raise from_kind("out_of_range", "seeds must be whole numbers from 0 to 2^64 - 1")
    return plain


def _usable_cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _prepare(folder: Path) -> None:
    """Make the folder, and find out now rather than after the work whether it can be written."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe = folder / f".{os.getpid()}.probe"
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise _file_error("write results into", folder, error) from error
