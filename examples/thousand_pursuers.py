"""Find out who of many pursuers should go for which of as many evaders.

A hundred unless told otherwise; for a thousand: python thousand_pursuers.py 1000
"""

import sys
import time

import numpy as np

import fuzzyrs as fz

count = int(sys.argv[1]) if len(sys.argv) > 1 else 100
rng = np.random.default_rng(1)
game = fz.ManyOnMany(
    [fz.Vehicle(speed, 0.3, 0.5) for speed in rng.uniform(1.5, 2.5, count)],
    [fz.Vehicle(speed, 0.3, 0.5) for speed in rng.uniform(0.5, 1.0, count)],
)
side = 6 * np.sqrt(count)
starts = {
    "pursuer_starts": rng.uniform(-side / 2, side / 2, (count, 2)),
    "evader_starts": rng.uniform(-side / 2, side / 2, (count, 2)),
}

# Each game shows what n of the n² pairs need; the next coupling is the best of what is known.
robots = fz.CoupledRobotsTraining(steering="classical")
began = time.perf_counter()
settings = fz.PairwiseTraining(episodes=200, robots=robots)
learned = fz.learn_coupling(game, settings, **starts, threads=0)
print(f"200 games of {count} pairs took {time.perf_counter() - began:.1f} s")
print(f"  first game: last capture after {learned.durations[0]:.1f} s")

# What it would be if all n² capture times were known.
times = game.capture_times(**starts, threads=0)
best = fz.assign(times, objective="bottleneck")
pursuers = np.arange(count)
print(f"  learned: {times[pursuers, learned.coupling].max():.1f} s")
print(f"  best possible: {times[pursuers, best].max():.1f} s")
