"""What the parts of section 6.5.2 contribute: QLBGFLC without its first two parts, and exploration.

Stage 2 of QLBGFLC runs with and without phase 1 and stage 1, from the same sequence of starts, for
budgets up to the thesis's. Q(λ) alone runs with ten times the exploration that fits Table 6.3.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from fuzzyrs._fuzzyrs import Control, QLambdaTraining, QlbgflcTraining
from fuzzyrs.experiments.chapter6 import Table63Config
from fuzzyrs.experiments.experiment import Experiment
from fuzzyrs.experiments.figures import draw_curve, panels, seeds_of
from fuzzyrs.experiments.result import Result, Row, Value
from fuzzyrs.experiments.statistics import ROUNDING, paired
from fuzzyrs.experiments.trained import train
from fuzzyrs.experiments.verdict import RANKED, judge_claim, judge_smaller, unchecked

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: How stage 2 begins: from what phase 1 and stage 1 learned, or at random.
BEGINNINGS = ("prepared", "random")

#: How far from the classical times is near [s].
NEAR = 0.5


@dataclass(frozen=True)
class AblationConfig:
    """Section 6.5.2, and the budgets of stage 2."""

    pursuit: Table63Config = field(default_factory=Table63Config)
    #: Generations of stage 2; the last is the thesis's.
    budgets: tuple[int, ...] = (2, 10, 20, 50, 200)
    #: Where the evader starts in the tests [m].
    starts: tuple[tuple[float, float], ...] = field(
        default_factory=lambda: tuple(QLambdaTraining().starts)
    )

    def to_dict(self) -> dict[str, Any]:
        """Return the config as plain values."""
        pursuit = self.pursuit
        return {
            "game": pursuit.game.to_dict(),
            "max_time": pursuit.max_time,
            "q_lambda": pursuit.q_lambda.to_dict(),
            "qlbgflc": pursuit.qlbgflc.to_dict(),
            "budgets": list(self.budgets),
            "starts": [list(start) for start in self.starts],
            "test_starts": [list(start) for start in pursuit.starts],
        }

    def qlbgflc(self, beginning: str, budget: int) -> QlbgflcTraining:
        """Return the settings of a run."""
        settings = self.pursuit.qlbgflc
        stage_2 = {**settings.stage_2.to_dict(), "iterations": budget}
        prepared = beginning == "prepared"
        return QlbgflcTraining(**{**settings.to_dict(), "stage_2": stage_2, "prepared": prepared})

    @property
    def explorer(self) -> QLambdaTraining:
        """Q(λ) alone with ε = 1/i."""
        return QLambdaTraining(**{**self.pursuit.q_lambda.to_dict(), "exploration": 1.0})


class Ablation65(Experiment):
    """What phase 1 and stage 1 contribute to QLBGFLC, and exploration to Q(λ)."""

    id: ClassVar[str] = "ablation-6-5"
    cost: ClassVar[float] = 0.21
    title: ClassVar[str] = "QLBGFLC without phase 1 and stage 1; Q(λ) with more exploration"
    claim: ClassVar[str] = (
        "Stage 2 fine-tunes what phase 1 and stage 1 learned; Q(λ) alone is not enough."
    )
    source: ClassVar[str] = "ours, on sections 6.4.3 and 6.5.2"
    expected: ClassVar[str] = (
        f"The prepared beginning's duration {RANKED}; Q(λ)'s medians not within {NEAR:g} s of the "
        "classical times."
    )
    values: ClassVar[str] = "mean duration of a game in seconds, from 64 starts or the printed four"

    def __init__(self, config: AblationConfig | None = None) -> None:
        self.settings = config or AblationConfig()

    def config(self) -> dict[str, Any]:
        """Return the game, the techniques and the budgets."""
        return self.settings.to_dict()

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Let QLBGFLC learn with every beginning and budget, and Q(λ) with more exploration."""
        settings = self.settings
        outcome: dict[str, Any] = {"seconds": {}}

        def learn(technique: QlbgflcTraining | QLambdaTraining) -> Any:
            game = settings.pursuit.game
            return train(game, technique, seed, control)[0].controller

        for beginning in BEGINNINGS:
            began = time.perf_counter()
            outcome[beginning] = [
                self._duration(learn(settings.qlbgflc(beginning, budget)))
                for budget in settings.budgets
            ]
            outcome["seconds"][beginning] = time.perf_counter() - began
        explorer = learn(settings.explorer)
        outcome["q_lambda"] = {
            "times": settings.pursuit.times(explorer),
            "duration": self._duration(explorer),
        }
        return outcome

    def _duration(self, pursuer: Any) -> float:
        """Return the mean duration of the test games; lost ones last their limit."""
        pursuit = self.settings.pursuit
        played = pursuit.game.play_many(
            pursuer, evader_starts=self.settings.starts, max_time=pursuit.max_time
        )
        return round(float(played.duration.mean()), 6)

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the budget curves, the comparison at the full budget, and Q(λ)'s times."""
        columns = [f"{budget} generations" for budget in self.settings.budgets]
        nothing: list[Value] = [None] * len(columns)
        curves = [
            Row(name, columns, nothing, [outcome[name] for outcome in outcomes], digits=2)
            for name in BEGINNINGS
        ]
        return [
            unchecked(curves[0], f"less than from random: {self._shares(outcomes)}"),
            unchecked(curves[1], "for comparison"),
            judge_smaller(
                _beside(
                    outcomes,
                    "full budget",
                    BEGINNINGS,
                    lambda outcome: [outcome[name][-1] for name in BEGINNINGS],
                ),
                "prepared",
                than="random",
            ),
            self._exploration(outcomes),
            judge_smaller(
                _beside(
                    outcomes,
                    "QLBGFLC and Q(λ) alone with ε = 1/i",
                    ("qlbgflc", "q_lambda"),
                    lambda outcome: [outcome["prepared"][-1], outcome["q_lambda"]["duration"]],
                ),
                "qlbgflc",
                than="q_lambda",
            ),
        ]

    def _shares(self, outcomes: Sequence[dict[str, Any]]) -> str:
        """Return on which share of the pairs the prepared beginning is ahead, by budget."""
        words = []
        for index, budget in enumerate(self.settings.budgets):
            pairs = paired(*([o[name][index] for o in outcomes] for name in BEGINNINGS))
            low, high = pairs.share
            words.append(f"{low:.0%}-{high:.0%} of the pairs at {budget} ({pairs.decision})")
        return ", ".join(words)

    def _exploration(self, outcomes: Sequence[dict[str, Any]]) -> Row:
        """Judge whether more exploration brings Q(λ) alone near the classical strategy."""
        pursuit = self.settings.pursuit
        row = Row(
            name="Q(λ) alone with ε = 1/i, capture times",
            columns=[f"({x:g},{y:g})" for x, y in pursuit.starts],
            published=[None] * len(pursuit.starts),
            per_seed=[outcome["q_lambda"]["times"] for outcome in outcomes],
        )
        near = all(
            ours is not None and best is not None and ours <= best + NEAR + ROUNDING
            for ours, best in zip(row.median, pursuit.times("classical"), strict=True)
        )
        reason = f"medians {'' if near else 'not '}within {NEAR:g} s of the classical times"
        return judge_claim(row, held=not near, reason=reason, chance=True)

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the budget curves: medians and middle halves."""
        title = f"medians and middle halves of {seeds_of(len(result.seeds))}"
        figure, (axes,) = panels([title], height=2.8)
        budgets = self.settings.budgets
        for name, marker in zip(BEGINNINGS, "os", strict=True):
            curves = np.array([outcome[name] for outcome in result.outcomes])
            low, middle, high = np.percentile(curves, [25, 50, 75], axis=0).tolist()
            draw_curve(axes, budgets, middle, low, high, marker=marker, label=f"from {name}")
        axes.set(xlabel="generations of stage 2", ylabel="mean duration [s]", xscale="log")
        axes.set_xticks(budgets, [str(budget) for budget in budgets])
        axes.minorticks_off()
        axes.legend()
        yield self.id, figure


def _beside(
    outcomes: Sequence[dict[str, Any]],
    name: str,
    columns: Sequence[str],
    values: Callable[[dict[str, Any]], list[Value]],
) -> Row:
    """Return a row of two columns that nothing is printed for."""
    return Row(name, list(columns), [None, None], [values(o) for o in outcomes], digits=2)


EXPERIMENTS: tuple[type[Experiment], ...] = (Ablation65,)
