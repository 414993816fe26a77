"""Section 6.5.2: how many steps and how many games Q(λ)-learning needs.

What the figures average is the duration of all games of a run, lost ones included, and then the
runs: with that reading, and no other, the printed learning times are one multiple of games times
mean (6.13). The level hangs on the evader's starts, which are not printed, so it is reported and
not judged.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

import fuzzyrs._fuzzyrs as native
from fuzzyrs._fuzzyrs import Control, OneOnOne, QLambdaTraining
from fuzzyrs.experiments.experiment import Experiment, published
from fuzzyrs.experiments.figures import draw_curve, legend_below, panels, seeds_of
from fuzzyrs.experiments.result import Result, Row
from fuzzyrs.experiments.statistics import mean_interval, overlap
from fuzzyrs.experiments.strips import PRINTED
from fuzzyrs.experiments.verdict import judge_claim, unchecked

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Differences of means that count as little.
FLAT = 0.05

#: What 100 games after the 200th add to the learning time.
GROWTH = (0.4, 0.55)

#: The numbers of games that the thesis compares in words.
HUNDRED_MORE = ("200", "300")


@dataclass(frozen=True)
class StudyConfig:
    """The game and the learner of the studies; starts and exploration are our reading."""

    game: OneOnOne = field(default_factory=OneOnOne)
    learner: QLambdaTraining = field(default_factory=lambda: QLambdaTraining(episodes=200))
    #: Steps of a game in the step study.
    steps: tuple[int, ...] = tuple(range(600, 6601, 600))
    #: Games of a run in the episode study.
    episodes: tuple[int, ...] = (50, 100, 150, 200, 300, 400, 500, 600, 800, 1000, 1200)

    def to_dict(self) -> dict[str, Any]:
        """Return the config as plain values."""
        return {
            "game": self.game.to_dict(),
            "learner": self.learner.to_dict(),
            "steps": list(self.steps),
            "episodes": list(self.episodes),
        }

    def durations(self, seed: int, control: Control, **changes: int) -> np.ndarray[Any, Any]:
        """Return the durations of the games [s] of a run, with some changed settings."""
        learner = QLambdaTraining(**{**self.learner.to_dict(), **changes})
        trained = native.train(self.game, learner, seed=seed, control=control)
        return trained.history["duration of the games [s]"]


class Study(Experiment):
    """A mean duration of the games, and a learning time, over a grid of settings."""

    values: ClassVar[str] = "simulated seconds"
    default_seeds: ClassVar[int] = 100
    quick_seeds: ClassVar[int] = 10
    #: What the grid is of, for the figure.
    axis: ClassVar[str]

    def __init__(self, config: StudyConfig | None = None) -> None:
        self.settings = config or StudyConfig()

    @property
    def grid(self) -> tuple[int, ...]:
        """The settings that are compared."""
        raise NotImplementedError

    def config(self) -> dict[str, Any]:
        """Return the game, the learner and the grid."""
        return self.settings.to_dict()

    def _row(self, name: str, outcomes: Sequence[dict[str, Any]], printed: dict[str, float]) -> Row:
        return Row(
            name=name,
            columns=[str(point) for point in self.grid],
            published=[printed.get(str(point)) for point in self.grid],
            per_seed=[outcome[name] for outcome in outcomes],
        )

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw both curves, with the 95 % intervals of the means."""
        names = ("mean duration", "learning time")
        titles = [f"{name}, {seeds_of(len(result.seeds))}" for name in names]
        figure, axes = panels(titles, columns=2, height=2.6)
        for cell, name, row in zip(axes, names, result.rows, strict=True):
            columns = list(zip(*(outcome[name] for outcome in result.outcomes), strict=True))
            low, high = zip(*map(mean_interval, columns), strict=True)
            band = (low, high) if len(result.seeds) > 1 else (None, None)
            means = list(map(statistics.fmean, columns))
            draw_curve(cell, self.grid, means, *band, marker="o", label="mean and 95 % interval")
            # Printed learning times are a computer's.
            if name == "mean duration" and any(value is not None for value in row.published):
                cell.plot(self.grid, np.array(row.published, dtype=float), **PRINTED)
            cell.set(xlabel=self.axis, ylabel=f"{name} [s]", ylim=(0, None))
        legend_below(figure)
        yield self.id, figure


class Figure66(Study):
    """Figures 6.6 and 6.7: games of at most so many steps."""

    id: ClassVar[str] = "figure-6-6"
    cost: ClassVar[float] = 0.018
    title: ClassVar[str] = "duration of the learning games, and learning time, by steps"
    claim: ClassVar[str] = "Both fall as games may take more steps; more than 6000 bring little."
    source: ClassVar[str] = "Figures 6.6 and 6.7, section 6.5.2"
    page: ClassVar[str] = "about pp. 105-106"
    expected: ClassVar[str] = (
        f"Both fall from first to last, and differ by {FLAT:.0%} at most, but for chance, from "
        "2400 steps on."
    )
    includes: ClassVar[tuple[str, ...]] = ("figure-6-7",)
    axis: ClassVar[str] = "steps after which a game is given up"

    @property
    def grid(self) -> tuple[int, ...]:
        """The numbers of steps, rising."""
        return self.settings.steps

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Learn under each limit. A limit that no game reached is the same as any larger one."""
        means: list[float] = []
        totals: list[float] = []
        durations, reached = np.empty(0), True
        for steps in self.grid:
            if reached:
                durations = self.settings.durations(seed, control, steps=steps)
                reached = bool(durations.max() >= (steps - 0.5) * self.settings.game.time_step)
            means.append(round(float(durations.mean()), 6))
            totals.append(round(math.fsum(durations), 6))
        return {"mean duration": means, "learning time": totals, "seconds": {}}

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out both curves."""
        return [
            _falls_and_stays(self._row(name, outcomes, {}), flat=("2400", "6600"))
            for name in ("mean duration", "learning time")
        ]


class Figure68(Study):
    """Figures 6.8 and 6.9: runs of so many games."""

    id: ClassVar[str] = "figure-6-8"
    cost: ClassVar[float] = 0.033
    title: ClassVar[str] = "duration of the learning games, and learning time, by games"
    claim: ClassVar[str] = (
        "More than 200 games shorten the mean little and cost much learning time: 300 games 1.0 % "
        "and 48.7 %."
    )
    source: ClassVar[str] = "Figures 6.8 and 6.9, section 6.5.2"
    page: ClassVar[str] = "about pp. 107-108"
    expected: ClassVar[str] = (
        f"The mean falls from first to last and differs by {FLAT:.0%} at most, but for chance, "
        f"from 200 games on; 300 games cost {GROWTH[0]:.0%} to {GROWTH[1]:.0%} more than 200."
    )
    includes: ClassVar[tuple[str, ...]] = ("figure-6-9",)
    axis: ClassVar[str] = "games of a run"

    @property
    def grid(self) -> tuple[int, ...]:
        """The numbers of games, rising."""
        return self.settings.episodes

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Learn once: a run of fewer games is the beginning of a longer one."""
        durations = self.settings.durations(seed, control, episodes=self.grid[-1])
        runs = [durations[:games] for games in self.grid]
        return {
            "mean duration": [round(float(run.mean()), 6) for run in runs],
            "learning time": [round(math.fsum(run), 6) for run in runs],
            "seconds": {},
        }

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out both curves, and what 100 games after the 200th bring and cost."""
        printed = published(self.id)
        mean = self._row("mean duration", outcomes, printed["capture_time"])
        learning = self._row("learning time", outcomes, printed["learning_time"])
        return [_falls_and_stays(mean, flat=HUNDRED_MORE), _grows(learning, printed)]


def _falls_and_stays(row: Row, flat: tuple[str, str]) -> Row:
    """Judge a curve that should fall from first to last, and hardly between two of its points."""
    if not set(flat) <= set(row.columns):
        return unchecked(row, f"the claim is about {flat[0]} and {flat[1]}, which are not compared")
    curve = np.array(row.per_seed, dtype=float)
    means = curve.mean(axis=0)
    since, until = map(row.columns.index, flat)
    fall = mean_interval(list(curve[:, 0] - curve[:, -1]))
    excess = (curve[:, since : until + 1] - curve[:, [until]]) / means[until]
    stays = all(overlap(mean_interval(list(column)), -FLAT, FLAT) for column in excess.T)
    reason = (
        f"means {', '.join(f'{mean:.1f}' for mean in means)}: from first to last they fall by "
        f"{fall[0]:.1f} to {fall[1]:.1f}; from {flat[0]} to {flat[1]} at most "
        f"{np.abs(excess.mean(axis=0)).max():.1%} from the latter, expected {FLAT:.0%} but for "
        f"chance; from {flat[0]} to the last {1 - means[-1] / means[since]:.1%} less"
    )
    if any(value is not None for value in row.published):
        reason += (
            "; the level hangs on the evader's starts, which are not printed, and isn't judged"
        )
    if fall[0] <= 0 <= fall[1]:
        return unchecked(row, f"so few runs don't tell whether it falls; {reason}")
    return judge_claim(row, held=fall[0] > 0 and stays, reason=reason, chance=True)


def _grows(row: Row, printed: dict[str, Any]) -> Row:
    """Judge what the 100 games after the 200th cost, and show what the print averages."""
    if not set(HUNDRED_MORE) <= set(row.columns):
        return unchecked(row, "the claim is about 200 and 300 games, which are not compared")
    first, second = (
        math.fsum(seed[row.columns.index(games)] or 0.0 for seed in row.per_seed)
        for games in HUNDRED_MORE
    )
    factors = [
        printed["learning_time"][games] / (int(games) * printed["capture_time"][games])
        for games in HUNDRED_MORE
    ]
    growth = second / first - 1
    reason = (
        f"300 games cost {growth:.1%} more than 200, printed 48.7 %; the printed times over games "
        f"times printed mean are {factors[0]:.6f} and {factors[1]:.6f}, one k of (6.13): the mean "
        "is over all games of a run"
    )
    return judge_claim(row, held=GROWTH[0] <= growth <= GROWTH[1], reason=reason, chance=True)


EXPERIMENTS: tuple[type[Experiment], ...] = (Figure66, Figure68)
