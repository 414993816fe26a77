"""Experiments whose results are known, for tests of the report."""

from __future__ import annotations

import numpy as np

import fuzzyrs as fz
from fuzzyrs import experiments
from fuzzyrs.experiments.experiment import Experiment
from fuzzyrs.experiments.result import Row

#: What must come out as text wherever it stands.
HOSTILE = "</script><img src=x onerror=\"document.title='hacked'\"> & 'more'"

SEEDS = range(3, 8)


class Known(Experiment):
    """Two rows, two games in each of two panels, a figure."""

    id = "table-9-1"
    title = "numbers that are known"
    claim = "Seeds count."
    source = "Table 9.1, section 9.2"
    includes = ("figure-9-2",)

    def config(self):
        return {"list": list(range(60)), "name": "known"}

    def run_seed(self, seed, control):
        del control
        return {"time": float(seed), "seconds": {}}

    def rows(self, outcomes):
        times = [outcome["time"] for outcome in outcomes]
        last = [[time, None if time == times[-1] else -time] for time in times]
        return [
            Row("all", ["time"], [5.2], [[time] for time in times], "reproduced", "near"),
            Row("some", ["early", "late"], [None, 1.0], last, "differs", "far", digits=2),
        ]

    def games(self, outcomes, seeds):
        del outcomes, seeds
        game = fz.OneOnOne()
        for start in [(2, 4), (-6, 7)]:
            for label, pursuer in [("classical", "classical"), ("straight", fz.PD(0.0, 0.0))]:
                played = game.play(pursuer, evader_start=start, max_time=20.0)
                panel = f"evader from {start} m"
                yield fz.Recording.of(played, label=label, panel=panel, capture_radius=0.1)

    def figures(self, result):
        del result
        from matplotlib.figure import Figure

        figure = Figure(figsize=(3, 2))
        figure.add_subplot().plot([0, 1, 4])
        yield "figure-9-2-curve", figure


class Hostile(Known):
    """The same with texts that would like to be HTML."""

    id = "figure-9-3"
    title = HOSTILE
    claim = HOSTILE
    source = HOSTILE
    includes = ()
    values = HOSTILE
    missing = HOSTILE

    def config(self):
        return {HOSTILE: HOSTILE}

    def rows(self, outcomes):
        times = [[outcome["time"], None] for outcome in outcomes]
        return [Row(HOSTILE, [HOSTILE, "b"], [1.0, None], times, HOSTILE, HOSTILE)]

    def games(self, outcomes, seeds):
        del outcomes, seeds
        robots = tuple(
            fz.RecordedRobot(f"{role} {HOSTILE}", role, np.zeros((2, 3)))
            for role in ("pursuer", "evader")
        )
        for panel in (HOSTILE, "other"):
            yield fz.Recording(robots, 0.1, label=HOSTILE, panel=panel)

    def figures(self, result):
        del result
        yield from ()


class NotRun(Known):
    """One without a result."""

    id = "section-9-4"
    includes = ()


ALL = (Known(), Hostile(), NotRun())


def saved(folder):
    """Save the results of those that are run."""
    for experiment in ALL[:2]:
        experiments.reproduce(experiment, SEEDS, folder)
    return folder
