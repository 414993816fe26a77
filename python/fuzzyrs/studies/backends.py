"""Where the runs of a study are worked on: threads, processes, or a Ray cluster."""

from __future__ import annotations

import importlib
import multiprocessing
import os
import pickle
import signal
from collections.abc import Callable, Iterable
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from queue import Empty, SimpleQueue
from typing import Any, Protocol

from fuzzyrs._fuzzyrs import Control
from fuzzyrs.errors import from_kind
from fuzzyrs.studies.store import Point, Run
from fuzzyrs.studies.work import Job, Work

#: Jobs that are given to each worker, so that none is idle.
AHEAD = 2
#: Runs that are entered together at most.
LARGEST_BATCH = 4096


class Backend(Protocol):
    """Works on runs."""

    def work(self, work: Work, jobs: Iterable[Job], finished: Callable[[list[Run]], None]) -> None:
        """Run all jobs and hand over what is finished, soon after it is.

        On an exception or Ctrl-C no further job is begun, and what was finished is handed over.
        """


class Threads:
    """Threads of this process: right for what fuzzyrs does, which needs no GIL."""

    def __init__(self, workers: int) -> None:
        self._workers = workers or usable_cores()

    def work(self, work: Work, jobs: Iterable[Job], finished: Callable[[list[Run]], None]) -> None:
        """Run all jobs; a function that takes a `control` is told to stop on Ctrl-C."""
        control = Control()
        pool = ThreadPoolExecutor(self._workers, thread_name_prefix="fuzzyrs")
        _run(pool, self._workers, work, jobs, finished, control)


class Processes:
    """Processes: right for functions that spend their time in Python."""

    def __init__(self, workers: int) -> None:
        self._workers = workers or usable_cores()

    def work(self, work: Work, jobs: Iterable[Job], finished: Callable[[list[Run]], None]) -> None:
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
    jobs: Iterable[Job],
    finished: Callable[[list[Run]], None],
    control: Control | None,
) -> None:
    """Keep a pool busy; on an exception or Ctrl-C keep what its workers still finish."""
    waiting = iter(jobs)
    running: set[Future[Run]] = set()
    ready: SimpleQueue[Future[Run]] = SimpleQueue()
    extra = () if control is None else (control,)

    def submit(most: int) -> None:
        while len(running) < most and (job := next(waiting, None)) is not None:
            future = pool.submit(work.run, *job, *extra)
            running.add(future)
            future.add_done_callback(ready.put)

    def hand_over(futures: Iterable[Future[Run]]) -> None:
        whole = (future for future in futures if future.done() and not future.cancelled())
        if succeeded := [future.result() for future in whole if future.exception() is None]:
            finished(succeeded)

    try:
        submit(AHEAD * workers)
        while running:
            done = _all_of(ready)
            hand_over(done)
            running.difference_update(done)
            for future in done:
                future.result()
            # Runs that end faster than they are entered wait, and come, in ever larger batches.
            submit(max(AHEAD * workers, min(2 * len(done), LARGEST_BATCH)))
    except BaseException as error:
        if control is not None:
            control.cancel()
        pool.shutdown(wait=True, cancel_futures=True)
        # What was being handed over just now, too: a run that is there already stays.
        hand_over(running)
        if isinstance(error, BrokenProcessPool):
            raise BrokenProcessPool(_BROKEN) from error
        raise
    pool.shutdown()


_BROKEN = (
    "a worker process ended at once: it was killed, ran out of memory, or could not import the "
    "function's module; finished runs are kept"
)


def _all_of(ready: SimpleQueue[Future[Run]]) -> list[Future[Run]]:
    """Wait for the next futures that are done, but not for long, so that Ctrl-C is answered."""
    try:
        done = [ready.get(timeout=0.1)]
        while not ready.empty():
            done.append(ready.get())
    except Empty:
        return []
    return done


class Ray:
    """A Ray cluster: the one this process is connected to, or one on this machine."""

    def __init__(self, workers: int) -> None:
        self._workers = workers

    def work(self, work: Work, jobs: Iterable[Job], finished: Callable[[list[Run]], None]) -> None:
        """Run all jobs as tasks of the cluster; fuzzyrs must be installed on its machines."""
        try:
            ray: Any = importlib.import_module("ray")
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
