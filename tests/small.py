"""The experiment of Table 6.3 with budgets that take milliseconds."""

from __future__ import annotations

import fuzzyrs as fz
from fuzzyrs.experiments.chapter6 import Table63, Table63Config

SEARCH = fz.GeneticPhase(iterations=4, population=20)
CONFIG = Table63Config(
    max_time=20.0,
    q_lambda=fz.QLambdaTraining(episodes=10, steps=300),
    reward_ga=fz.RewardGaTraining(genetic=SEARCH, steps=50),
    qlbgflc=fz.QlbgflcTraining(
        phase_1=fz.QLambdaTraining(episodes=5, steps=300),
        stage_1=SEARCH,
        stage_2=fz.GeneticPhase(iterations=3, population=10),
        steps=50,
    ),
)


class Small(Table63):
    """Table 6.3 under the small config."""

    def __init__(self) -> None:
        super().__init__(CONFIG)


class Undrawn(Small):
    """The same without figures, which take seconds."""

    def figures(self, result):
        del result
        return iter(())


class Stuck(Undrawn):
    """The same, but seed 2 goes on until it is stopped."""

    def run_seed(self, seed, control):
        if seed == 2:
            fz.train(fz.OneOnOne(), fz.QLambdaTraining(episodes=10**8), control=control)
        return super().run_seed(seed, control)
