"""Section 8.3: minimax-Q(λ) against independent Q(λ), both robots learning.

The thesis leaves open how the evader chooses from the table of joint actions. Under the one of two
pure readings by which its figures come out the evader answers the pursuer's choice. A long game
may come from a good evader or from a bad pursuer, so both play classical opponents too.
"""

from __future__ import annotations

import statistics
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from fuzzyrs._fuzzyrs import (
    Control,
    MinimaxQTraining,
    OneOnOne,
    QLambdaTraining,
    Trained,
    Vehicle,
)
from fuzzyrs.experiments.experiment import Experiment, published
from fuzzyrs.experiments.figures import draw_curve, legend_below, panels, seeds_of
from fuzzyrs.experiments.result import Result, Row, Value
from fuzzyrs.experiments.statistics import mean_interval
from fuzzyrs.experiments.strips import by_rows, draw_strips
from fuzzyrs.experiments.trained import train
from fuzzyrs.experiments.verdict import (
    RANKED,
    judge_claim,
    judge_exact,
    judge_smaller,
    told,
    unchecked,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Settings = MinimaxQTraining | QLambdaTraining
Pair = tuple[Settings, Settings]

MINIMAX, IQL = "minimax-Q", "IQL"
SECURITY, MIXED, BOLDER = "minimax-Q, security", "minimax-Q, mixed", "IQL, ε = 1/i"

#: The keys of `Trained.history`.
DURATIONS = "duration of the games [s]"
REWARDS = "pursuer's total reward in the games"


def _minimax(play: str) -> Pair:
    settings = MinimaxQTraining(play=play)  # type: ignore[arg-type]
    return settings, settings


def _independent(exploration: float) -> Pair:
    """Return Q(λ) for both robots, with ε = exploration/i, and ties as minimax-Q breaks them."""
    pursuer = QLambdaTraining(episodes=200, exploration=exploration, ties="random")
    return pursuer, QLambdaTraining(
        episodes=200, exploration=exploration, actions=21, ties="random"
    )


def _learners() -> dict[str, Pair]:
    return {
        MINIMAX: _minimax("answer"),
        # (8.6) has no number left in the scan; the text says that (8.5), 1/i, is larger.
        IQL: _independent(0.1),
        SECURITY: _minimax("security"),
        MIXED: _minimax("mixed"),
        BOLDER: _independent(1.0),
    }


@dataclass(frozen=True)
class MinimaxConfig:
    """The game of section 8.3; of each learner the pursuer's settings and the evader's."""

    game: OneOnOne = field(
        default_factory=lambda: OneOnOne(Vehicle(1.0, 0.3, 0.5), Vehicle(0.5, 0.3, 1.0))
    )
    learners: dict[str, Pair] = field(default_factory=_learners)
    #: When a game against a classical opponent is given up [s]: as when learning.
    max_time: float = 600.0
    #: So many times more games give minimax-Q as many visits of each of its values: 11·21/21.
    longer: int = 11

    def to_dict(self, names: Sequence[str]) -> dict[str, Any]:
        """Return the game and the settings of some learners as plain values."""
        learners = {name: [one.to_dict() for one in self.learners[name]] for name in names}
        return {"game": self.game.to_dict(), "max_time": self.max_time, **learners}

    def train(self, name: str, seed: int, control: Control) -> tuple[Trained, float]:
        """Let both robots learn, and tell how many seconds it took."""
        pursuer, evader = self.learners[name]
        return train(self.game, pursuer, seed, control, evader=evader)

    def train_longer(self, name: str, seed: int, control: Control) -> tuple[Trained, float]:
        """The same with more games."""
        settings = self.learners[name][0].to_dict()
        settings["episodes"] *= self.longer
        longer = MinimaxQTraining(**settings)
        return train(self.game, longer, seed, control, evader=longer)

    def steps(self, trained: Trained) -> float:
        """Return the time steps that were played while learning."""
        return round(trained.learning_time / self.game.time_step)

    def cross_play(self, trained: Trained) -> dict[str, float]:
        """Return how long the robots' games against classical opponents last [s], on average over
        the starts from which they learned.
        """
        starts = QLambdaTraining().starts

        def mean(pursuer: Any, evader: Any) -> float:
            limit = self.max_time
            played = self.game.play_many(pursuer, evader, evader_starts=starts, max_time=limit)
            return round(float(played.duration.mean()), 6)

        return {
            "pursuer": mean(trained.controller, "classical"),
            "evader": mean("classical", trained.evader),
        }


class MinimaxStudy(Experiment):
    """Learners of section 8.3 side by side."""

    values: ClassVar[str] = "simulated seconds unless told"
    #: Of `MinimaxConfig.learners`.
    names: ClassVar[tuple[str, ...]]

    def __init__(self, config: MinimaxConfig | None = None) -> None:
        self.settings = config or MinimaxConfig()

    def config(self) -> dict[str, Any]:
        """Return the game and the settings of all learners."""
        return self.settings.to_dict(self.names)

    def comparison(
        self, name: str, outcomes: Sequence[dict[str, Any]], key: str, digits: int = 1
    ) -> Row:
        """Lay out one number of each learner."""
        return Row(
            name=name,
            columns=list(self.names),
            published=[None] * len(self.names),
            per_seed=[[outcome[learner][key] for learner in self.names] for outcome in outcomes],
            digits=digits,
        )


#: Groups of games, from the first to the last.
GROUPS = ((1, 10), (11, 50), (51, 100), (101, 200))


class Figure81(MinimaxStudy):
    """Figures 8.1 and 8.2."""

    id: ClassVar[str] = "figure-8-1"
    cost: ClassVar[float] = 0.18
    title: ClassVar[str] = "minimax-Q and independent Q: capture time and reward while learning"
    claim: ClassVar[str] = (
        "Independent Q is better at equal episodes and steps, in capture time and in total reward."
    )
    source: ClassVar[str] = "Figures 8.1 and 8.2, section 8.3"
    page: ClassVar[str] = "about pp. 149-150"
    expected: ClassVar[str] = f"Independent Q's capture times {RANKED}; minimax-Q's rewards too."
    includes: ClassVar[tuple[str, ...]] = ("figure-8-2",)
    default_seeds: ClassVar[int] = 100
    quick_seeds: ClassVar[int] = 5
    names: ClassVar[tuple[str, ...]] = (MINIMAX, IQL)

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Let both robots learn by each technique."""
        outcome: dict[str, Any] = {"seconds": {}}
        for name in self.names:
            trained, outcome["seconds"][name] = self.settings.train(name, seed, control)
            durations, rewards = trained.history[DURATIONS], trained.history[REWARDS]
            outcome[name] = {
                "durations": durations.round(6).tolist(),
                "rewards": rewards.round(6).tolist(),
                "mean duration": round(float(durations.mean()), 6),
                "mean reward": round(float(rewards.mean()), 6),
            }
        return outcome

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the means of groups of games, and judge the claims seed by seed."""
        lost = published(self.id)["notes"][0]
        groups = [
            unchecked(self._groups(name, outcomes, measure), lost)
            for measure in ("durations", "rewards")
            for name in self.names
        ]
        times = self.comparison("duration of all games [s]", outcomes, "mean duration")
        rewards = self.comparison("total reward, mean of all games", outcomes, "mean reward")
        return [*groups, judge_smaller(times, IQL, MINIMAX), judge_smaller(rewards, MINIMAX, IQL)]

    def _groups(self, name: str, outcomes: Sequence[dict[str, Any]], measure: str) -> Row:
        games = len(outcomes[0][name][measure])
        groups = [(first, min(last, games)) for first, last in GROUPS if first <= games]
        return Row(
            name=f"{name}: {measure}",
            columns=[f"games {first}-{last}" for first, last in groups],
            published=[None] * len(groups),
            per_seed=[
                [round(statistics.fmean(o[name][measure][a - 1 : b]), 6) for a, b in groups]
                for o in outcomes
            ],
        )

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw both measures game by game, means over the runs with their 95 % intervals."""
        labels = {"durations": "capture time [s]", "rewards": "total reward"}
        runs = seeds_of(len(result.seeds))
        titles = [f"{label.split(' [')[0]}, {runs}" for label in labels.values()]
        figure, axes = panels(titles, columns=2, height=2.6)
        for cell, (measure, label) in zip(axes, labels.items(), strict=True):
            for name in self.names:
                curves = np.array([outcome[name][measure] for outcome in result.outcomes])
                games = np.arange(1, curves.shape[1] + 1).tolist()
                low, high = zip(*map(mean_interval, curves.T.tolist()), strict=True)
                band = (low, high) if len(result.seeds) > 1 else (None, None)
                draw_curve(cell, games, curves.mean(axis=0).tolist(), *band, label=name)
            cell.set(xlabel="game", ylabel=label)
            if measure == "rewards":
                # The first game, nearly without a plan, would leave nothing to see of the others.
                cell.set_ylim(bottom=0)
        legend_below(figure)
        yield self.id, figure


#: The ratio of simulated steps, minimax-Q to independent Q: groups of 30 runs lay within.
STEP_RATIO = (3.0, 9.0)


class Section83(MinimaxStudy):
    """What section 8.3 says besides, and what its learners can do."""

    id: ClassVar[str] = "section-8-3"
    cost: ClassVar[float] = 4.3
    most_seeds: ClassVar[int | None] = 30
    title: ClassVar[str] = "minimax-Q and independent Q: learning time, tables, cross-play"
    claim: ClassVar[str] = (
        "Independent Q takes a fifth of the time; with as many visits minimax-Q would be better."
    )
    source: ClassVar[str] = "section 8.3"
    page: ClassVar[str] = "about pp. 143-151"
    expected: ClassVar[str] = (
        f"Minimax-Q learns {told([STEP_RATIO])} times as long; tables exactly; rankings: {RANKED}."
    )
    default_seeds: ClassVar[int] = 30
    names: ClassVar[tuple[str, ...]] = (MINIMAX, SECURITY, MIXED, IQL, BOLDER)

    def config(self) -> dict[str, Any]:
        """Return the game, the settings of all learners and how much longer some learn."""
        return {**super().config(), "longer": self.settings.longer}

    @property
    def longer(self) -> dict[str, str]:
        """What learners are called that play more games."""
        return {name: f"{name}, {self.settings.longer} × games" for name in (MINIMAX, SECURITY)}

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Let both robots learn by each technique, and play classical opponents."""
        settings = self.settings
        outcome: dict[str, Any] = {"seconds": {}}
        for name in self.names:
            trained, outcome["seconds"][name] = settings.train(name, seed, control)
            outcome[name] = self._learned(trained)
        for name, longer in self.longer.items():
            trained, outcome["seconds"][longer] = settings.train_longer(name, seed, control)
            outcome[longer] = self._learned(trained)
        return outcome

    def _learned(self, trained: Trained) -> dict[str, Any]:
        durations = trained.history[DURATIONS]
        return {
            "steps": self.settings.steps(trained),
            "second half": round(float(durations[len(durations) // 2 :].mean()), 6),
            **self.settings.cross_play(trained),
        }

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out learning times, tables and cross-play, and judge the claims."""
        steps = self.comparison("time steps played while learning", outcomes, "steps", 0)
        pursuer = self.comparison("learned pursuer, classical evader [s]", outcomes, "pursuer")
        evader = self.comparison("classical pursuer, learned evader [s]", outcomes, "evader")
        return [
            unchecked(steps, "not printed"),
            self._ratio(outcomes),
            self._tables(len(outcomes)),
            self._visits(outcomes),
            judge_smaller(pursuer, IQL, MINIMAX),
            replace(
                judge_smaller(pursuer, BOLDER, MINIMAX),
                name="the same: IQL explores as minimax-Q does",
            ),
            unchecked(evader, "not printed; the classical pursuer catches them all"),
            *self._with_as_many_visits(outcomes),
        ]

    def _ratio(self, outcomes: Sequence[dict[str, Any]]) -> Row:
        """Lay out how much longer minimax-Q learns, beside the ratio of printed minutes."""
        steps = [[outcome[name]["steps"] for name in (MINIMAX, IQL)] for outcome in outcomes]
        row = Row(
            name="learning time, minimax-Q to IQL",
            columns=["ratio"],
            published=[published(self.id)["learning_minutes"]["ratio"]],
            per_seed=[[round(one / other, 6)] for one, other in steps],
        )
        ratio = sum(one for one, _ in steps) / sum(other for _, other in steps)
        low, high = STEP_RATIO
        reason = (
            f"{ratio:.2f} times the simulated steps in all runs together, expected {low:g}-{high:g}"
            "; the print has minutes of a computer"
        )
        return judge_claim(row, held=low <= ratio <= high, reason=reason, chance=True)

    def _sizes(self) -> dict[str, int]:
        """Return how many values each table has."""
        joint, (pursuer, evader) = self.settings.learners[MINIMAX][0], self.settings.learners[IQL]
        assert isinstance(joint, MinimaxQTraining)
        return {
            MINIMAX: joint.points**2 * joint.actions * joint.evader_actions,
            "IQL, pursuer": pursuer.points**2 * pursuer.actions,
            "IQL, evader": evader.points**2 * evader.actions,
        }

    def _tables(self, seeds: int) -> Row:
        sizes: list[Value] = [float(size) for size in self._sizes().values()]
        printed = [float(size) for size in published(self.id)["table_sizes"]]
        row = Row("values in each table", list(self._sizes()), [*printed], [sizes] * seeds)
        return judge_exact(replace(row, digits=0))

    def _visits(self, outcomes: Sequence[dict[str, Any]]) -> Row:
        """Lay out how often the usual value of each table was learned from."""
        sizes = self._sizes()
        learners = [MINIMAX, IQL, IQL]
        row = Row(
            name="visits of a value, on average",
            columns=list(sizes),
            published=[*map(float, published(self.id)["visits"])],
            per_seed=[
                [
                    round(outcome[learner]["steps"] / size, 6)
                    for learner, size in zip(learners, sizes.values(), strict=True)
                ]
                for outcome in outcomes
            ],
        )
        joint, pursuer, evader = (statistics.fmean(row.column(index)) for index in range(3))
        reason = (
            f"IQL visits {pursuer / joint:.1f} and {evader / joint:.1f} times as often, printed at "
            "least 11; the print counts 6000 steps in every game, but a capture ends a game"
        )
        return judge_claim(row, held=min(pursuer, evader) / joint >= 11, reason=reason, chance=True)

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw what all seeds of each learner reached."""
        rows = {row.name.split(":")[0]: row for row in result.rows}
        panels_of = {
            "steps while learning": "time steps played while learning",
            "learned pursuer [s]": "learned pursuer, classical evader [s]",
            "learned evader [s]": "classical pursuer, learned evader [s]",
            "second half of the games [s]": "second half of the games [s]",
        }
        shown = by_rows([rows[name] for name in panels_of.values()], titles=list(panels_of))
        title = f"Learners of section 8.3, {seeds_of(len(result.seeds))}"
        yield self.id, draw_strips(shown, title, log=True)

    def _with_as_many_visits(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Judge whether minimax-Q is better after more games, under each reading."""
        names = [*self.longer.values(), IQL, BOLDER]
        row = Row(
            name="second half of the games [s]",
            columns=names,
            published=[None] * len(names),
            per_seed=[[outcome[name]["second half"] for name in names] for outcome in outcomes],
        )
        return [
            replace(judge_smaller(row, longer, other), name=f"{row.name}: {longer} before {other}")
            for longer in self.longer.values()
            for other in (IQL, BOLDER)
        ]


EXPERIMENTS = (Figure81, Section83)
