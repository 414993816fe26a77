"""Where the runs of a study are worked on: threads, processes, or a Ray cluster."""

from __future__ import annotations

import importlib
import multiprocessing
import os
import pickle
import signal
import sys
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import connection
from queue import Empty, SimpleQueue
from threading import Thread
from typing import Any, Protocol

from fuzzyrs._fuzzyrs import Control
from fuzzyrs.errors import from_kind
from fuzzyrs.studies.settings import unknown
from fuzzyrs.studies.store import Point, Run
from fuzzyrs.studies.work import Job, Work

#: Jobs that are given to each worker, so that none is idle.
AHEAD = 2
#: Runs that are under way at most.
MOST_AHEAD = 4096


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
        """Run all jobs; on Ctrl-C their control is cancelled."""
        control = Control()
        with ThreadPoolExecutor(self._workers, thread_name_prefix="fuzzyrs") as pool:

            def stop() -> None:
                control.cancel()
                pool.shutdown(cancel_futures=True)

            def submit(job: Job) -> Future[Run]:
                return pool.submit(work.run, *job, control)

            _run(submit, stop, AHEAD * self._workers, jobs, finished)


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
        with ProcessPoolExecutor(self._workers, context, initializer=begin_worker) as pool:

            def stop() -> None:
                pool.shutdown(cancel_futures=True)

            def submit(job: Job) -> Future[Run]:
                with _interrupts_held():
                    return pool.submit(work.run, *job)

            try:
                _run(submit, stop, AHEAD * self._workers, jobs, finished)
            except BrokenProcessPool as error:
                raise from_kind("threads", _BROKEN) from error


_BROKEN = (
    "a worker process ended too early: it was killed, ran out of memory, or could not import the "
    "function's module (a script must start its study under if __name__ == '__main__'); finished "
    "runs are kept"
)


@contextmanager
def _interrupts_held() -> Iterator[None]:
    """Let Ctrl-C wait, for this thread and for the processes that it starts meanwhile."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def begin_worker() -> None:
    """Let a process that was started for work leave Ctrl-C to the main one, and end with it.

    A terminal sends Ctrl-C to all processes. A main process that is killed can't end its workers,
    which would wait for work for ever.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    parent = multiprocessing.parent_process()
    if parent is not None:
        Thread(target=_end_with, args=[parent.sentinel], name="fuzzyrs-parent", daemon=True).start()


def _end_with(sentinel: int) -> None:
    """End this process at once when another one has ended."""
    connection.wait([sentinel])
    os._exit(1)


class Ray:
    """A Ray cluster: the one this process is connected to or can find, or one on this machine."""

    def __init__(self, workers: int) -> None:
        # All jobs that wait are given to Ray, so that a cluster may grow.
        self._ahead = workers or MOST_AHEAD

    def work(self, work: Work, jobs: Iterable[Job], finished: Callable[[list[Run]], None]) -> None:
        """Run all jobs as tasks of the cluster; fuzzyrs must be installed on its machines."""
        ray = _ray()
        ours = not ray.is_initialized()
        if ours:
            ray.init(log_to_driver=False, include_dashboard=False, logging_level="error")
        try:
            shared = ray.put((sys.path, ray.cloudpickle.dumps(work)))
            task = ray.remote(_task)
            tasks: dict[Future[Run], Any] = {}

            def stop() -> None:
                under_way = list(tasks.items())
                for _, reference in under_way:
                    ray.cancel(reference)
                wait([future for future, _ in under_way], GRACE)

            def submit(job: Job) -> Future[Run]:
                reference = task.remote(shared, *job)
                future: Future[Run] = reference.future()
                tasks[future] = reference
                future.add_done_callback(tasks.pop)
                return future

            _run(submit, stop, self._ahead, jobs, finished, most=self._ahead)
        except ray.exceptions.RayError as error:
            cause = getattr(error, "cause", error)
            if isinstance(cause, ray.exceptions.RayError):
                message = f"Ray could not work on it: {cause}; finished runs are kept"
                raise from_kind("threads", message) from error
            raise cause from error
        finally:
            if ours:
                ray.shutdown()


#: Seconds that cancelled tasks of Ray have to end.
GRACE = 10.0


def _ray() -> Any:
    """Import Ray, which then tells nobody that it is used."""
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    try:
        return importlib.import_module("ray")
    except ImportError as error:
        message = "the backend 'ray' needs Ray: pip install 'fuzzyrs[ray]'"
        raise ImportError(message) from error


def _task(shared: tuple[list[str], bytes], point: Point, seed: int) -> Run:
    """Run once on a machine of the cluster, which may see the same folders."""
    folders, pickled = shared
    sys.path.extend(folder for folder in folders if folder not in sys.path)
    work: Work = pickle.loads(pickled)
    return work.run(point, seed)


def _run(
    submit: Callable[[Job], Future[Run]],
    stop: Callable[[], None],
    ahead: int,
    jobs: Iterable[Job],
    finished: Callable[[list[Run]], None],
    most: int = MOST_AHEAD,
) -> None:
    """Keep workers busy; on an exception or Ctrl-C stop them and keep what they still finish.

    From `ahead` to `most` jobs are under way at a time.
    """
    waiting = iter(jobs)
    running: set[Future[Run]] = set()
    ready: SimpleQueue[Future[Run]] = SimpleQueue()

    def fill(goal: int) -> None:
        while len(running) < goal and (job := next(waiting, None)) is not None:
            future = submit(job)
            running.add(future)
            future.add_done_callback(ready.put)

    def hand_over(futures: Iterable[Future[Run]]) -> None:
        whole = (future for future in futures if future.done() and not future.cancelled())
        if succeeded := [future.result() for future in whole if future.exception() is None]:
            finished(succeeded)

    try:
        fill(ahead)
        while running:
            done = _all_of(ready)
            hand_over(done)
            running.difference_update(done)
            for future in done:
                future.result()
            # Runs that end faster than they are entered wait, and come, in ever larger batches.
            fill(max(ahead, min(2 * len(done), most)))
    except BaseException:
        stop()
        # What was being handed over just now, too: a run that is there already stays.
        hand_over(running)
        raise


def _all_of(ready: SimpleQueue[Future[Run]]) -> list[Future[Run]]:
    """Wait for the next futures that are done, but not for long, so that Ctrl-C is answered."""
    try:
        done = [ready.get(timeout=0.1)]
        while not ready.empty():
            done.append(ready.get())
    except Empty:
        return []
    return done


BACKENDS: dict[str, Callable[[int], Backend]] = {
    "threads": Threads,
    "processes": Processes,
    "ray": Ray,
}


def backend_of(name: str, workers: int) -> Backend:
    """Return the backend with a name."""
    if name not in BACKENDS:
        raise unknown("backend", name, BACKENDS)
    if workers < 0:
        raise from_kind("out_of_range", f"workers must be zero or more, got {workers}")
    return BACKENDS[name](workers)


def usable_cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
