"""What a call from Python costs, beside NumPy in the same process, in turns.

Prints the minimum over the rounds and the ratio: on shared machines the minimum is what repeats.

    python benches/python/boundary.py [--quick]
"""

import os
import platform
import sys
import time

# One thread each: NumPy's own would blur the comparison.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import fuzzyrs as fz

QUICK = "--quick" in sys.argv[1:]
ROUNDS = 2 if QUICK else 15
POINTS = 20_000 if QUICK else 1_000_000
CALLS = 1_000 if QUICK else 200_000


def factorised(system, points, block=4096):
    """Compute the batch in NumPy: memberships once per input, blocks that stay in the cache."""
    parameters = system.parameters
    means, sigmas = parameters[0:12:2].reshape(2, 3), parameters[1:12:2].reshape(2, 3)
    table = parameters[12:].reshape(3, 3)
    outputs = np.empty(len(points))
    for first in range(0, len(points), block):
        rows = points[first : first + block, :, None]
        degrees = np.exp(-0.5 * ((rows - means) / sigmas) ** 2)
        a, b = degrees[:, 0], degrees[:, 1]
        strength = a.sum(axis=1) * b.sum(axis=1)
        outputs[first : first + block] = ((a @ table) * b).sum(axis=1) / strength
    return outputs


def in_turns(rounds, works):
    """Return the least seconds of each piece of work, the works taking turns."""
    least = dict.fromkeys(works, float("inf"))
    for _ in range(rounds):
        for name, work in works.items():
            began = time.perf_counter()
            work()
            least[name] = min(least[name], time.perf_counter() - began)
    return least


def main():
    terms = [fz.Variable.evenly(name, (-1, 1), "NZP") for name in ("x", "y")]
    system = fz.TSK(terms, np.linspace(-1, 1, 9))
    points = np.random.default_rng(0).uniform(-1, 1, (POINTS, 2))
    outputs = np.empty(POINTS)
    worst = np.abs(factorised(system, points) - system(points)).max()
    assert worst < 1e-12, worst

    def calls():
        for _ in range(CALLS):
            system(0.3, -0.4)

    def loop():
        for _ in range(CALLS):
            pass

    least = in_turns(
        ROUNDS,
        {
            "batch, fuzzyrs": lambda: system(points, out=outputs),
            "batch, factorised NumPy": lambda: factorised(system, points),
            "call, fuzzyrs": calls,
            "empty loop": loop,
        },
    )
    each = {name: seconds / POINTS * 1e9 for name, seconds in least.items()}
    call = (least["call, fuzzyrs"] - least["empty loop"]) / CALLS * 1e9
    ours, theirs = each["batch, fuzzyrs"], each["batch, factorised NumPy"]
    print(f"fuzzyrs {fz.__version__}, NumPy {np.__version__}, Python {platform.python_version()}")
    print("TSK, two inputs of three Gaussians, one thread, least of the rounds")
    print(f"batch of {POINTS}: fuzzyrs {ours:.1f} ns a point, factorised NumPy {theirs:.1f} ns")
    print(f"                   ratio {theirs / ours:.1f}")
    print(f"one call: {call:.0f} ns")


if __name__ == "__main__":
    main()
