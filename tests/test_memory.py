"""Memory: training stays small, and calls leave nothing behind."""

from __future__ import annotations

import subprocess
import sys

import pytest

MEGABYTE = 2**20

# The peak of a process's own memory. On Linux `ru_maxrss` begins at the peak of the process that
# started it, which would hide everything below.
PEAK = """
import sys
import numpy as np
import fuzzyrs as fz

def peak():
    if sys.platform == "linux":
        with open("/proc/self/status") as status:
            return next(int(line.split()[1]) * 1024 for line in status if "VmHWM" in line)
    import resource
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

game = fz.OneOnOne()
system = fz.TSK([fz.Variable.evenly(name, (-1, 1), "NZP") for name in "xy"], np.arange(9.0))
points = np.zeros((50_000, 2))
out = np.empty(50_000)
"""


def growth(work: str, warm_up: str = "pass") -> int:
    """Bytes by which the peak rises while a fresh process does the work."""
    script = f"{PEAK}\n{warm_up}\nbefore = peak()\n{work}\nprint(peak() - before)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return int(done.stdout)


def test_the_measure_sees_what_is_allocated():
    assert growth("kept = np.ones(5_000_000)") > 35 * MEGABYTE


def test_training_one_learner_stays_below_64_megabytes():
    assert growth("fz.train(game, fz.QlbgflcTraining())") < 64 * MEGABYTE


def test_a_batch_with_out_allocates_nothing_that_grows_with_it():
    assert growth("for _ in range(20): system(points, out=out)") < MEGABYTE


MANY_CALLS = {
    "one point": "for _ in range(1_000_000): system(0.1, 0.2)",
    "a batch": "for _ in range(100): system(points)",
    "a gradient": "for _ in range(20): system.gradient(points[:5000])",
    "a refused call": "for _ in range(30_000):\n  try: system(0.1)\n  except ValueError: pass",
    "a copy": "for _ in range(10_000): fz.TSK.from_json(system.to_json())",
    "a trajectory": "for _ in range(3000): game.play(evader_start=(2, 4)).pursuer",
    "many games": "for _ in range(200): game.play_many(evader_starts=points[:2000], max_time=1)",
}


@pytest.mark.parametrize("calls", MANY_CALLS.values(), ids=MANY_CALLS)
def test_repeated_calls_leak_nothing(calls):
    # The first round fills caches and pools; the second must find room in them.
    assert growth(calls, warm_up=calls) < 4 * MEGABYTE
