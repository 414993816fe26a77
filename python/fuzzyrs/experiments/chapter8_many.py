"""Past section 8.5: couplings of up to 32 pursuers with as many evaders.

Q_CF has a value for each of the n! couplings, pairwise learning one for each of the n² pairs, of
which every episode shows n. How far from the best are the couplings that they learn? Robots are
classical, so the best coupling is known: the assignment on the capture times of all pairs. All
pursuers are faster than all evaders; robots and positions are drawn anew for each seed.
"""

from __future__ import annotations

import math
import random
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

import fuzzyrs._fuzzyrs as native
from fuzzyrs import plot
from fuzzyrs._fuzzyrs import (
    Control,
    CoupledRobotsTraining,
    CouplingTraining,
    ManyOnMany,
    PairwiseTraining,
    Vehicle,
)
from fuzzyrs.experiments.experiment import Experiment
from fuzzyrs.experiments.figures import draw_curve, legend_below, panels, seeds_of
from fuzzyrs.experiments.result import Result, Row, Value
from fuzzyrs.experiments.verdict import judge_claim, unchecked

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: The largest n with a table of couplings, and with a search through all of them.
MOST_LISTED = 6

CLASSICAL = CoupledRobotsTraining(steering="classical")

Settings = CouplingTraining | PairwiseTraining


def _learners(episodes: int) -> dict[str, Settings]:
    """Return what is compared."""

    def pairs(**changes: Any) -> PairwiseTraining:
        return PairwiseTraining(episodes=episodes, robots=CLASSICAL, **changes)

    return {
        "Q_CF": CouplingTraining(episodes=episodes, robots=CLASSICAL),
        "Q_CF, inv_f": CouplingTraining(episodes=episodes, robots=CLASSICAL, reward="inv_f"),
        "pairs": pairs(),
        "pairs, sum": pairs(objective="sum"),
        "pairs, softmax": pairs(exploration="softmax"),
        "pairs, nothing known": pairs(first_estimate="zero"),
    }


@dataclass(frozen=True)
class ScalingConfig:
    """Which games are drawn, and how long is learned."""

    sizes: tuple[int, ...] = (2, 3, 4, 6, 8, 16, 32)
    #: When the coupling that was learned is looked at.
    episodes: tuple[int, ...] = (1, 2, 5, 10, 20, 50, 100, 200)
    #: From which speeds [m/s] and steering limits [rad] robots are drawn; all wheelbases 0.3 m.
    pursuers: tuple[tuple[float, float], tuple[float, float]] = ((1.5, 2.5), (0.4, 0.6))
    evaders: tuple[tuple[float, float], tuple[float, float]] = ((0.5, 1.0), (0.4, 0.6))
    #: Positions are drawn from a square of this side for each pair of robots [m].
    side: float = 6.0
    max_time: float = 60.0

    def to_dict(self) -> dict[str, Any]:
        """Return everything as plain values."""
        return {
            "sizes": list(self.sizes),
            "episodes": list(self.episodes),
            "pursuers": [list(limits) for limits in self.pursuers],
            "evaders": [list(limits) for limits in self.evaders],
            "side": self.side,
            "max_time": self.max_time,
            "learners": {name: one.to_dict() for name, one in _learners(1).items()},
        }

    def draw(self, size: int, seed: int) -> tuple[ManyOnMany, dict[str, Any]]:
        """Return a game of so many pairs and where it starts."""
        # Python promises that these numbers stay the same; NumPy's generators may change.
        rng = random.Random(f"{size} pairs, seed {seed}")

        def robots(limits: tuple[tuple[float, float], tuple[float, float]]) -> list[Vehicle]:
            speeds, most = limits
            return [Vehicle(rng.uniform(*speeds), 0.3, rng.uniform(*most)) for _ in range(size)]

        def places() -> list[tuple[float, float]]:
            return [(rng.uniform(-half, half), rng.uniform(-half, half)) for _ in range(size)]

        half = self.side * math.sqrt(size) / 2
        game = ManyOnMany(robots(self.pursuers), robots(self.evaders))
        return game, {"pursuer_starts": places(), "evader_starts": places()}


class Scaling(Experiment):
    """Which learner of couplings comes how near to the best."""

    id: ClassVar[str] = "section-8-5-scaling"
    cost: ClassVar[float] = 0.39
    most_seeds: ClassVar[int | None] = 30
    title: ClassVar[str] = "couplings of 2 to 32 pursuers: Q_CF, pairwise learning, assignment"
    claim: ClassVar[str] = (
        "Ours: a table of couplings is hopeless beyond a few pairs; one estimate for each pair and "
        "an exact assignment before each game find the best coupling."
    )
    source: ClassVar[str] = "ours, past section 8.5"
    expected: ClassVar[str] = (
        "Pairwise learning finds the best coupling in every game; no coupling beats the assignment."
    )
    values: ClassVar[str] = "last capture later than the earliest possible, in seconds"
    missing: ClassVar[str] = "not all caught, or n! too many"
    default_seeds: ClassVar[int] = 20

    def __init__(self, config: ScalingConfig | None = None) -> None:
        self.settings = config or ScalingConfig()

    def config(self) -> dict[str, Any]:
        """Return how games are drawn, and the learners."""
        return self.settings.to_dict()

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Return the regret of each learner by size and by episodes."""
        settings = self.settings
        outcome: dict[str, Any] = {"seconds": {}, "regret": {}}
        for size in settings.sizes:
            began = time.perf_counter()
            game, starts = settings.draw(size, seed)
            times = game.capture_times(**starts, max_time=settings.max_time, control=control)

            def last(coupling: Any, times: Any = times) -> float:
                return float(times[np.arange(len(times)), coupling].max())

            best = last(native.assign(times, objective="bottleneck"))
            regret: dict[str, list[Value]] = {
                "assignment, sum": [last(native.assign(times)) - best]
            }
            if size <= MOST_LISTED:
                brute = min(map(last, native.couplings(size)))
                regret["brute force"] = [brute - best]
            for name in _learners(1):
                if name.startswith("Q_CF") and size > MOST_LISTED:
                    continue
                regret[name] = []
                for episodes in settings.episodes:
                    learned = native.learn_coupling(
                        game, _learners(episodes)[name], **starts, seed=seed, control=control
                    )
                    late = last(learned.coupling) - best
                    regret[name].append(round(late, 6) if np.isfinite(late) else None)
            outcome["regret"][str(size)] = regret
            outcome["seconds"][f"n = {size}"] = time.perf_counter() - began
        return outcome

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the regret after all episodes by size, and judge the claims."""
        sizes = [str(size) for size in self.settings.sizes]
        names = ["brute force", "assignment, sum", *_learners(1)]
        columns = [f"n = {size}" for size in sizes]

        def value(outcome: dict[str, Any], size: str, name: str) -> Value:
            regret = outcome["regret"][size].get(name)
            return None if regret is None else regret[-1]

        rows = {
            name: Row(
                name,
                columns,
                [None] * len(sizes),
                [[value(outcome, size, name) for size in sizes] for outcome in outcomes],
                digits=2,
            )
            for name in names
        }
        ours = "nothing of it is printed"
        judged = [unchecked(row, ours) for name, row in rows.items() if name not in self._claims]
        return [*judged, *(claim(rows[name]) for name, claim in self._claims.items())]

    @property
    def _claims(self) -> dict[str, Any]:
        return {"brute force": _zero, "pairs": _small}

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the mean regret by episodes, a panel for each size."""
        settings, outcomes = self.settings, result.outcomes
        titles = [f"n = {size}" for size in settings.sizes]
        figure, axes = panels(titles, columns=4, height=2.0, sharex=True)
        for cell, size in zip(axes, map(str, settings.sizes), strict=True):
            for index, name in enumerate(_learners(1)):
                curves = [outcome["regret"][size].get(name) for outcome in outcomes]
                if None in curves:
                    continue
                late = np.array(
                    [[settings.max_time if v is None else v for v in curve] for curve in curves]
                )
                style: Any = {
                    "color": plot.COLOURS[index],
                    "marker": "osD^vP"[index],
                    "label": name,
                }
                draw_curve(cell, settings.episodes, late.mean(axis=0).tolist(), **style)
            cell.set(xscale="log", xlabel="episodes", ylim=(0, None))
        for cell in axes[::4]:
            cell.set_ylabel("later than possible [s]")
        figure.suptitle(
            "The last capture under the learned coupling: means of "
            f"{seeds_of(len(outcomes))}, {settings.max_time:g} s where not all are caught"
        )
        legend_below(figure, columns=6)
        yield self.id, figure


def _zero(row: Row) -> Row:
    """Judge whether no coupling is better than the assignment."""
    worst = max(abs(v) for seed in row.per_seed for v in seed if v is not None)
    reason = f"the best of all couplings and the assignment differ by {worst:g} s at most"
    return judge_claim(row, held=worst < 1e-9, reason=reason)


def _small(row: Row) -> Row:
    """Judge whether pairwise learning finds the best coupling."""
    values = [v for seed in row.per_seed for v in seed]
    found = sum(v is not None and v < 1e-9 for v in values)
    reason = f"the best coupling was found in {found} of {len(values)} games"
    return judge_claim(row, held=found == len(values), reason=reason, chance=True)


EXPERIMENTS: tuple[type[Experiment], ...] = (Scaling,)
