"""Threads, Ctrl-C, stopping work, progress, processes."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import fuzzyrs as fz

# Nothing waits this long unless something hangs.
HANGS = 120
ENDLESS = fz.QLambdaTraining(episodes=10**8)


@pytest.fixture
def patient_interpreter():
    """Let no thread lose the GIL unless it gives it away."""
    usual = sys.getswitchinterval()
    sys.setswitchinterval(1e6)
    yield
    sys.setswitchinterval(usual)


GAME = fz.OneOnOne()
SYSTEM = fz.TSK([fz.Variable.evenly(name, (-1, 1), "NZP") for name in "xy"], np.arange(9.0) / 9)
POINTS = np.random.default_rng(0).uniform(-1, 1, (400_000, 2))
FAR = np.full((2000, 2), 1e5)
LONG_WORK = {
    "evaluate": lambda: SYSTEM(POINTS),
    "gradient": lambda: SYSTEM.gradient(POINTS[:40_000]),
    "play": lambda: GAME.play(evader_start=(1e5, 0), max_time=10_000),
    "play_many": lambda: GAME.play_many(evader_starts=FAR, max_time=60),
    "train": lambda: fz.train(GAME, fz.QLambdaTraining(episodes=100)),
    "fit_genetic": lambda: fz.fit_genetic(SYSTEM, POINTS[:500], POINTS[:500, 0]),
}


@pytest.mark.parametrize("work", LONG_WORK.values(), ids=LONG_WORK)
@pytest.mark.usefixtures("patient_interpreter")
def test_other_threads_run_during_long_work(work):
    turns, stop = 0, threading.Event()

    def take_turns():
        nonlocal turns
        while not stop.is_set():
            turns += 1
            time.sleep(0.0001)  # gives the GIL away

    other = threading.Thread(target=take_turns)
    other.start()
    during = 0
    for _ in range(200):  # once is enough, unless the machine is busy with other things
        before = turns
        work()
        during = turns - before
        if during:
            break
    stop.set()
    other.join()
    assert during > 0


def test_threads_share_a_system():
    rng = np.random.default_rng(1)
    batches = [rng.uniform(-1, 1, (20_000, 2)) for _ in range(16)]
    starts = [(x, y) for x in (-4, 5) for y in (-3, 6)]

    def work(batch):
        alone = [SYSTEM(x, y) for x, y in batch[:100].tolist()]
        played = GAME.play_many(SYSTEM, evader_starts=starts, max_time=10, threads=2)
        return SYSTEM(batch, threads=2), SYSTEM.gradient(batch[:100]), alone, played.miss_distance

    expected = [work(batch) for batch in batches]
    with ThreadPoolExecutor(4) as pool:
        for results, right in zip(pool.map(work, batches), expected, strict=True):
            for result, value in zip(results, right, strict=True):
                np.testing.assert_array_equal(result, value)


def test_ctrl_c_stops_training():
    script = """
import fuzzyrs as fz
def progress(done):
    print(done, flush=True)
try:
    fz.train(fz.OneOnOne(), fz.QLambdaTraining(episodes=10**8), progress=progress)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE) as process:
        try:
            assert process.stdout.readline().strip().isdigit()
            process.send_signal(signal.SIGINT)
            output, _ = process.communicate(timeout=HANGS)
        finally:
            process.kill()
    assert output.split()[-1] == b"interrupted"
    assert process.returncode == 0


def test_work_is_cancelled_from_another_thread():
    control = fz.Control()

    def cancel_when_begun():
        while control.done == 0:
            time.sleep(0.001)
        control.cancel()

    other = threading.Thread(target=cancel_when_begun)
    other.start()
    with pytest.raises(fz.errors.CancelledError, match="stopped on request"):
        fz.train(GAME, ENDLESS, control=control)
    other.join()
    assert control.cancelled


def test_games_and_fits_are_cancelled_too():
    control = fz.Control()
    control.cancel()
    with pytest.raises(fz.errors.CancelledError):
        GAME.play_many(evader_starts=FAR, control=control)
    with pytest.raises(fz.errors.CancelledError):
        fz.fit_genetic(SYSTEM, POINTS[:9], POINTS[:9, 0], control=control)


def test_progress_tells_how_far_the_work_is():
    control, told = fz.Control(), []

    def progress(done):
        told.append(done)
        if len(told) == 3:
            control.cancel()

    with pytest.raises(fz.errors.CancelledError):
        fz.train(GAME, ENDLESS, control=control, progress=progress)
    assert len(told) >= 3
    assert told == sorted(told)
    assert told[-1] > 0
    assert control.done >= told[-1]


def test_an_exception_in_a_progress_callback_reaches_the_caller():
    def progress(done):
        raise ZeroDivisionError(f"at {done}")

    with pytest.raises(ZeroDivisionError, match="at "):
        fz.train(GAME, ENDLESS, progress=progress)
    with pytest.raises(ZeroDivisionError):
        GAME.play_many(evader_starts=np.full((10**5, 2), 1e5), progress=progress)


def test_a_control_counts_what_was_done():
    control = fz.Control()
    fz.train(GAME, fz.QLambdaTraining(episodes=7), control=control)
    GAME.play_many(evader_starts=FAR[:300], max_time=1, control=control, threads=2)
    assert (control.done, control.cancelled) == (307, False)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
def test_a_fork_after_threaded_work_does_not_hang():
    script = """
import multiprocessing
import numpy as np
import fuzzyrs as fz

def work(seed):
    system = fz.TSK([fz.Variable.evenly(n, (-1, 1), "NZP") for n in "xy"], np.arange(9.0))
    points = np.random.default_rng(seed).uniform(-1, 1, (20_000, 2))
    trained = fz.train(fz.OneOnOne(), fz.QLambdaTraining(episodes=3), seed=seed)
    return system(points, threads=2).sum(), trained.learning_time

expected = [work(seed) for seed in range(4)]
with multiprocessing.get_context("fork").Pool(2) as pool:
    assert pool.map(work, range(4)) == expected
print("done")
"""
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, capture_output=True, text=True, timeout=HANGS)
    assert done.stdout == "done\n", done.stderr
