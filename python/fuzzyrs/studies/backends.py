"""Where the runs of a study are worked on: threads, processes, or a Ray cluster."""

from __future__ import annotations

import inspect
import multiprocessing
import os
import pickle
import signal
import time
from collections.abc import Callable, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from dataclasses import dataclass
from typing import Any, Protocol

from fuzzyrs._fuzzyrs import Control
from fuzzyrs.errors import from_kind
from fuzzyrs.studies.definition import outcome_of
from fuzzyrs.studies.store import Point, Run

Job = tuple[Point, int]

#: Jobs that wait at each worker, so that none is idle and few are lost when it is stopped.
AHEAD = 2


@dataclass(frozen=True)
class Work:
    """A function that is run at points with seeds.

    Attributes
    ----------
    function : callable
        Takes the seed and the parameters by name.
    record : bool
        Whether an exception is the outcome of its run or ends the study.
    """

    function: Callable[..., Any]
    record: bool

    def run(self, point: Point, seed: int, control: Control | None = None) -> Run:
        """Run the function once."""
        began = time.perf_counter()
        extra = {"control": control} if control is not None and self._takes_control() else {}
        outcome, failure = None, None
        try:
            outcome = outcome_of(self.function(seed=seed, **point, **extra))
        except Exception as error:
            if not self.record:
                if hasattr(error, "add_note"):  # Python 3.11
                    error.add_note(f"in the run of a study at {point} with seed {seed}")
                raise
            failure = f"{type(error).__name__}: {error}"
        return Run(point, seed, outcome, failure, time.perf_counter() - began)

    def _takes_control(self) -> bool:
        try:
            parameters = inspect.signature(self.function).parameters
        except (TypeError, ValueError):
            return False
        return "control" in parameters


class Backend(Protocol):
    """Works on runs."""

    def work(self, work: Work, jobs: Sequence[Job], finished: Callable[[list[Run]], None]) -> None:
        """Run all jobs and hand over what is finished, soon after it is.

        On an exception or Ctrl-C no further job is begun, and what was finished is handed over.
        """


class Threads:
    """Threads of this process: right for what fuzzyrs does, which needs no GIL."""

    def __init__(self, workers: int) -> None:
        self._workers = workers or usable_cores()

    def work(self, work: Work, jobs: Sequence[Job], finished: Callable[[list[Run]], None]) -> None:
        """Run all jobs; a function that takes a `control` is told to stop on Ctrl-C."""
        control = Control()
        pool = ThreadPoolExecutor(self._workers, thread_name_prefix="fuzzyrs")
        _run(pool, self._workers, work, jobs, finished, control)


class Processes:
    """Processes: right for functions that spend their time in Python."""

    def __init__(self, workers: int) -> None:
        self._workers = workers or usable_cores()

    def work(self, work: Work, jobs: Sequence[Job], finished: Callable[[list[Run]], None]) -> None:
        """Run all jobs in processes that were spawned, not forked: no state is inherited."""
        try:
            pickle.dumps(work)
        except Exception as error:
            message = (
                f"other processes cannot get the function ({error}); define it in a module, or use "
                "backend='threads'"
            )
            raise from_kind("unsuitable", message) from error
        context = multiprocessing.get_context("spawn")
        pool = ProcessPoolExecutor(self._workers, context, initializer=_leave_interrupts)
        _run(pool, self._workers, work, jobs, finished, None)


def _leave_interrupts() -> None:
    """Let the main process answer Ctrl-C, which a terminal sends to all."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _run(
    pool: Executor,
    workers: int,
    work: Work,
    jobs: Sequence[Job],
    finished: Callable[[list[Run]], None],
    control: Control | None,
) -> None:
    """Keep a pool busy; on an exception or Ctrl-C keep what its workers still finish."""
    waiting = iter(jobs)
    running: set[Future[Run]] = set()

    def submit() -> None:
        while len(running) < AHEAD * workers:
            job = next(waiting, None)
            if job is None:
                return
            extra = () if control is None else (control,)
            running.add(pool.submit(work.run, *job, *extra))

    def hand_over(futures: set[Future[Run]]) -> None:
        whole = (future for future in futures if future.done() and not future.cancelled())
        succeeded = [future.result() for future in whole if future.exception() is None]
        if succeeded:
            finished(succeeded)

    try:
        submit()
        while running:
            done, _ = wait(running, timeout=0.1, return_when=FIRST_COMPLETED)
            hand_over(done)
            running -= done
            for future in done:
                future.result()
            submit()
    except BaseException:
        if control is not None:
            control.cancel()
        pool.shutdown(wait=True, cancel_futures=True)
        # What was being handed over just now, too: a run that is there already stays.
        hand_over(running)
        raise
    pool.shutdown()


class Ray:
    """A Ray cluster: the one this process is connected to, or one on this machine."""

    def __init__(self, workers: int) -> None:
        self._workers = workers

    def work(self, work: Work, jobs: Sequence[Job], finished: Callable[[list[Run]], None]) -> None:
        """Run all jobs as tasks of the cluster; fuzzyrs must be installed on its machines."""
        try:
            import ray
        except ImportError as error:
            message = "the backend 'ray' needs Ray: pip install 'fuzzyrs[ray]'"
            raise ImportError(message) from error
        if not ray.is_initialized():
            ray.init(log_to_driver=False, include_dashboard=False, num_cpus=self._workers or None)
        most = AHEAD * (self._workers or int(ray.cluster_resources().get("CPU", 1)))
        shared = ray.put(work)
        task = ray.remote(_task)
        waiting = iter(jobs)
        running: list[Any] = []
        try:
            while True:
                while len(running) < most and (job := next(waiting, None)) is not None:
                    running.append(task.remote(shared, *job))
                if not running:
                    return
                done, running = ray.wait(running, timeout=1.0)
                for one in done:
                    finished([ray.get(one)])
        except BaseException:
            for one in running:
                ray.cancel(one)
            raise


def _task(work: Work, point: Point, seed: int) -> Run:
    return work.run(point, seed)


def backend_of(name: str, workers: int) -> Backend:
    """Return the backend with a name."""
    backends: dict[str, Callable[[int], Backend]] = {
        "threads": Threads,
        "processes": Processes,
        "ray": Ray,
    }
    if name not in backends:
        known = ", ".join(map(repr, backends))
        raise from_kind("unknown_name", f"unknown backend {name!r}; there are {known}")
    if workers < 0:
        raise from_kind("out_of_range", f"workers must be zero or more, got {workers}")
    return backends[name](workers)


def usable_cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
