"""Section 8.5: n pursuers learn which evader each should go for, then to catch it.

The scan lost where the robots start and what a coupling is rewarded for (8.30). The positions here
were chosen because classical robots then need nearly the printed times, which some twenty thousand
other sets of positions do as well. So the classical times are no evidence, and neither are the
values of Q_CF: they depend on the positions. What may be judged is which coupling is learned.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

import fuzzyrs._fuzzyrs as native
from fuzzyrs._fuzzyrs import (
    Control,
    CouplingTraining,
    GeneticPhase,
    ManyOnMany,
    QLambdaTraining,
    QlbgflcTraining,
)
from fuzzyrs.experiments.experiment import Experiment, median_seed, published
from fuzzyrs.experiments.figures import draw_games, seeds_of
from fuzzyrs.experiments.result import Result, Row, Value
from fuzzyrs.experiments.statistics import share_fits
from fuzzyrs.experiments.strips import by_rows, draw_strips
from fuzzyrs.experiments.trained import train
from fuzzyrs.experiments.verdict import RANKED, judge_claim, judge_smaller, unchecked
from fuzzyrs.recording import Recording

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Places = tuple[tuple[float, float], ...]

#: How couplings are called in Table 8.5.
CHOICES = ("first", "second", "third", "fourth", "fifth", "sixth")

#: Of the rewards of couplings that were tried for the lost (8.30), the two that fit.
REWARDS = ("r_over_T2", "r_over_f")

BY_CONSTRUCTION = "our positions were chosen by these times; they are no evidence"
VALUES = "the values hang on the lost positions and on the lost (8.30)"


@dataclass(frozen=True)
class ManyConfig:
    """A game of section 8.5.3 and what learns in it."""

    game: ManyOnMany
    #: Where the robots start [m], looking along the x axis; ours.
    pursuer_starts: Places
    evader_starts: Places
    #: Stage one, but for the reward.
    coupling: CouplingTraining
    #: Phase 2 of stage two, the table of its genetic searches.
    stage_1: GeneticPhase
    stage_2: GeneticPhase
    #: When a test game is given up [s]: 600 steps.
    max_time: float = 60.0
    #: Starts by which a generation of stage two is judged; the thesis has one.
    starts_per_generation: int = 4
    #: Games from which tables learn in stage two.
    episodes: int = 200

    @property
    def starts(self) -> dict[str, Any]:
        """Return the starts as keywords."""
        return {"pursuer_starts": self.pursuer_starts, "evader_starts": self.evader_starts}

    def rewarded(self, reward: str) -> CouplingTraining:
        """Return stage one under a reward of couplings."""
        return CouplingTraining(**{**self.coupling.to_dict(), "reward": reward})

    def training(self, robot: native.Vehicle, start: tuple[float, float]) -> QlbgflcTraining:
        """Return stage two of a robot; `start` is its pair's, the evader's from the pursuer's."""
        starts = [*QLambdaTraining().starts, start]
        return QlbgflcTraining(
            phase_1=QLambdaTraining(
                episodes=self.episodes,
                steps=600,
                exploration=1.0,
                actions=len(robot.steering_angles()),
                starts=starts,
            ),
            stage_1=self.stage_1,
            stage_2=self.stage_2,
            steps=300,
            starts=starts,
            starts_per_generation=self.starts_per_generation,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return everything as plain values."""
        return {
            "game": self.game.to_dict(),
            "pursuer_starts": [list(place) for place in self.pursuer_starts],
            "evader_starts": [list(place) for place in self.evader_starts],
            "coupling": self.coupling.to_dict(),
            "stage_1": self.stage_1.to_dict(),
            "stage_2": self.stage_2.to_dict(),
            "max_time": self.max_time,
            "starts_per_generation": self.starts_per_generation,
            "episodes": self.episodes,
        }

    def classical(self) -> list[Value]:
        """Return the time of the last capture under every coupling, all robots classical."""
        couplings = native.couplings(len(self.game))
        return [
            self.game.play(coupling, **self.starts, max_time=self.max_time).capture_time
            for coupling in couplings
        ]

    def learned_robots(
        self, coupling: Sequence[int], seed: int, control: Control
    ) -> tuple[list[Any], list[Any]]:
        """Train the pairs of a coupling; return the pursuers' controllers and the evaders'."""
        pursuers: list[Any] = [None] * len(coupling)
        evaders: list[Any] = [None] * len(coupling)
        for i, j in enumerate(coupling):
            (x, y), (ex, ey) = self.pursuer_starts[i], self.evader_starts[j]
            pair = self.game.pair(i, j)
            own, other = (
                self.training(robot, (ex - x, ey - y)) for robot in (pair.pursuer, pair.evader)
            )
            # Each pair has random numbers of its own.
            trained, _ = train(pair, own, seed * 1000 + i, control, evader=other)
            pursuers[i], evaders[j] = trained.controller, trained.evader
        return pursuers, evaders

    def play(self, coupling: Sequence[int], robots: tuple[Any, Any]) -> Any:
        """Play a game of robots that learned."""
        pursuers, evaders = robots
        return self.game.play(
            coupling, **self.starts, pursuers=pursuers, evaders=evaders, max_time=self.max_time
        )


def _stage_2(crossover: float, mutation: float) -> GeneticPhase:
    """Return a search in which mutants are changed controllers, as in section 8.4: fresh ones that
    were lucky replace good ones.
    """
    return GeneticPhase(
        iterations=100, population=10, crossover=crossover, mutation=mutation, fresh_mutants=False
    )


def two() -> ManyConfig:
    """Return n = 2: Tables 8.6 to 8.8."""
    return ManyConfig(
        game=ManyOnMany.thesis(2),
        pursuer_starts=((2.0, 4.0), (-4.0, 5.0)),
        evader_starts=((0.0, 4.0), (-1.0, 0.0)),
        coupling=CouplingTraining(temperature=1.0),
        stage_1=GeneticPhase(iterations=1000, population=80, crossover=0.2, mutation=0.1),
        stage_2=_stage_2(crossover=0.4, mutation=0.2),
    )


def three() -> ManyConfig:
    """Return n = 3: Tables 8.10 to 8.12."""
    return ManyConfig(
        game=ManyOnMany.thesis(3),
        pursuer_starts=((-5.0, -4.0), (-1.0, -6.0), (0.0, 0.0)),
        evader_starts=((-4.0, -4.0), (1.0, -4.0), (-3.0, -1.0)),
        coupling=CouplingTraining(temperature=20.0),
        stage_1=GeneticPhase(iterations=1000, population=80, crossover=0.2, mutation=0.1),
        stage_2=_stage_2(crossover=0.2, mutation=0.1),
    )


class OfMany(Experiment):
    """An experiment on one game of section 8.5.3."""

    settings: ManyConfig

    def __init__(self, config: ManyConfig | None = None) -> None:
        self.settings = config or self.default()

    @staticmethod
    def default() -> ManyConfig:
        """Return the config unless told otherwise."""
        return three()

    def config(self) -> dict[str, Any]:
        """Return the game, the starts and the settings of both stages."""
        return self.settings.to_dict()

    @property
    def columns(self) -> list[str]:
        """The couplings, as Table 8.5 calls them."""
        return list(CHOICES[: len(native.couplings(len(self.settings.game)))])

    def learn(self, seed: int, control: Control) -> dict[str, list[float]]:
        """Return Q_CF under each reward."""
        settings = self.settings
        return {
            reward: native.learn_coupling(
                settings.game,
                settings.rewarded(reward),
                **settings.starts,
                seed=seed,
                control=control,
            ).values.tolist()
            for reward in REWARDS
        }

    def values_row(
        self, reward: str, outcomes: Sequence[Mapping[str, Any]], best: int, printed: list[Value]
    ) -> Row:
        """Lay out Q_CF, and judge which coupling has the largest value."""
        values = [outcome[reward] for outcome in outcomes]
        row = Row(f"Q_CF, {reward}", self.columns, printed, values, digits=3)
        right = sum(int(np.argmax(value)) == best for value in values)
        reason = (
            f"the {CHOICES[best]} coupling is the best for {right} of {len(values)} seeds, "
            f"expected 95 %; {VALUES}"
        )
        held = share_fits(right, len(values), least=0.95)
        return judge_claim(row, held=held, reason=reason, chance=True)


def _order(row: Row) -> Row:
    """Judge whether the medians of Q_CF rank the couplings as the print does."""
    medians, printed = ([v or 0.0 for v in values] for values in (row.median, row.published))
    ranks, expected = (np.argsort(np.argsort(values)) for values in (medians, printed))
    swapped = int((ranks != expected).sum())
    reason = f"{swapped} of {len(ranks)} couplings have another rank than in the print; {VALUES}"
    named = replace(row, name=f"{row.name}: all ranks")
    return judge_claim(named, held=swapped == 0, reason=reason, chance=True)


def draw_values(experiment: Experiment, result: Result) -> Iterator[tuple[str, Figure]]:
    """Draw what all seeds know of the couplings."""
    rows = [row for row in result.rows if row.name in {f"Q_CF, {reward}" for reward in REWARDS}]
    if rows:
        title = f"Q_CF by coupling, {seeds_of(len(result.seeds))}"
        yield f"{experiment.id}-values", draw_strips(by_rows(rows, "Q_CF"), title)


class QTable(OfMany):
    """A printed Q_CF."""

    claim: ClassVar[str] = "Q_CF finds the coupling whose last capture is the earliest."
    values: ClassVar[str] = "Q_CF of each coupling"
    expected: ClassVar[str] = (
        "The printed best coupling is ours on 95 % of the seeds; the medians rank all as printed."
    )
    default_seeds: ClassVar[int] = 100
    quick_seeds: ClassVar[int] = 5

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Learn Q_CF under each reward."""
        began = time.perf_counter()
        values = self.learn(seed, control)
        return {**values, "seconds": {"q_cf": time.perf_counter() - began}}

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out Q_CF beside the print."""
        printed = published(self.id)["q_cf"]
        best = int(np.argmax(printed))
        rows = [self.values_row(reward, outcomes, best, printed) for reward in REWARDS]
        return [*rows, *map(_order, rows)]

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw what all seeds know of the couplings."""
        yield from draw_values(self, result)


class Table813(QTable):
    """Table 8.13."""

    id: ClassVar[str] = "table-8-13"
    cost: ClassVar[float] = 0.16
    title: ClassVar[str] = "Q_CF of three pursuers and three evaders"
    source: ClassVar[str] = "Table 8.13, section 8.5.3"
    page: ClassVar[str] = "about p. 173"


class LearnedCouplings(OfMany):
    """Capture times of couplings whose pairs learned to steer by QLBGFLC."""

    values: ClassVar[str] = "times of the last capture in seconds"
    missing: ClassVar[str] = "not all caught"
    default_seeds: ClassVar[int] = 20
    #: How near the classical time the median of learned robots is expected [s].
    near: ClassVar[float]
    #: Which couplings are learned, by their places.
    learned: ClassVar[tuple[int, ...]]

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Learn Q_CF, and let the pairs of the couplings learn."""
        began = time.perf_counter()
        couplings = native.couplings(len(self.settings.game))
        outcome: dict[str, Any] = {
            **self.learn(seed, control),
            "classical": self.settings.classical(),
            "learned": [None] * len(couplings),
            "pursuers": [None] * len(couplings),
        }
        for choice in self.learned:
            coupling = couplings[choice].tolist()
            robots = self.settings.learned_robots(coupling, seed, control)
            outcome["learned"][choice] = self.settings.play(coupling, robots).capture_time
            against_classical = self.settings.play(coupling, (robots[0], "classical"))
            outcome["pursuers"][choice] = against_classical.capture_time
        return {**outcome, "seconds": {"both stages": time.perf_counter() - began}}

    def classical_row(self, outcomes: Sequence[dict[str, Any]], printed: list[Value]) -> Row:
        """Lay out the classical times."""
        times = [outcome["classical"] for outcome in outcomes]
        return unchecked(Row("classical", self.columns, printed, times), BY_CONSTRUCTION)

    def learned_rows(
        self, choice: int, outcomes: Sequence[dict[str, Any]], printed: Value
    ) -> list[Row]:
        """Lay out the learned times of one coupling; near the classical one, it is claimed.

        A long game may come from a good evader, so the pursuers play classical ones too.
        """
        names = {"learned": "QLBGFLC", "pursuers": "QLBGFLC, classical evaders"}
        classical = outcomes[0]["classical"][choice]
        rows = []
        for key, name in names.items():
            print_of_all = printed if key == "learned" else None
            times = [[outcome[key][choice]] for outcome in outcomes]
            row = Row(name, [CHOICES[choice]], [print_of_all], times)
            median = row.median[0]
            held = median is not None and abs(median - classical) <= self.near
            reason = (
                f"median {median}, expected within {self.near:g} s of {classical:g}, the classical "
                f"time; not all caught for {row.missing(0)} of {len(outcomes)} seeds"
            )
            rows.append(judge_claim(row, held=held, reason=reason, chance=True))
        return rows

    def games(
        self, outcomes: Sequence[dict[str, Any]], seeds: Sequence[int]
    ) -> Iterator[Recording]:
        """Play each learned coupling: classical robots, and those of the median seed."""
        settings = self.settings
        couplings = native.couplings(len(settings.game))
        for choice in self.learned:
            coupling = couplings[choice].tolist()
            middle = median_seed([[outcome["learned"][choice]] for outcome in outcomes])
            robots = settings.learned_robots(coupling, seeds[middle], Control())
            plain = settings.game.play(coupling, **settings.starts, max_time=settings.max_time)
            players = {"classical": plain, "learned": settings.play(coupling, robots)}
            for label, played in players.items():
                yield Recording.of(
                    played,
                    label=label,
                    panel=f"{CHOICES[choice]} coupling (seed {seeds[middle]})",
                    capture_radius=settings.game.capture_radius,
                )

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the paths under each learned coupling, and what all seeds reached."""
        columns = len(self.learned)
        yield f"{self.id}-paths", draw_games(result.games, self.title, columns=columns, height=4)
        yield from draw_values(self, result)


class Table89(LearnedCouplings):
    """Table 8.9 and Figures 8.8 and 8.9."""

    id: ClassVar[str] = "table-8-9"
    cost: ClassVar[float] = 0.9
    quick_seeds: ClassVar[int] = 1
    most_seeds: ClassVar[int | None] = 60
    title: ClassVar[str] = "two pursuers and two evaders: Q_CF, and captures under both couplings"
    claim: ClassVar[str] = (
        "Q_CF finds the right coupling; robots that learned need as long as classical ones, and "
        "longer under the wrong coupling."
    )
    source: ClassVar[str] = "Table 8.9 and Figures 8.8 and 8.9, section 8.5.3"
    page: ClassVar[str] = "about pp. 170-172"
    includes: ClassVar[tuple[str, ...]] = ("figure-8-8", "figure-8-9")
    learned: ClassVar[tuple[int, ...]] = (0, 1)
    near: ClassVar[float] = 0.5
    expected: ClassVar[str] = (
        f"The first coupling is the best on 95 % of the seeds; the median within {near:g} s of the "
        f"classical time; the first coupling's time {RANKED}."
    )

    @staticmethod
    def default() -> ManyConfig:
        """Return n = 2."""
        return two()

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out Q_CF and the times."""
        printed = published(self.id)
        values = [self.values_row(reward, outcomes, 0, printed["q_cf"]) for reward in REWARDS]
        times = [outcome["learned"] for outcome in outcomes]
        wrong = Row("QLBGFLC: wrong later", self.columns, printed["learned"], times)
        return [
            *values,
            self.classical_row(outcomes, printed["classical"]),
            *self.learned_rows(0, outcomes, printed["learned"][0]),
            judge_smaller(wrong, "first", than="second"),
        ]


class Table814(LearnedCouplings):
    """Table 8.14 and Figure 8.10."""

    id: ClassVar[str] = "table-8-14"
    cost: ClassVar[float] = 0.76
    quick_seeds: ClassVar[int] = 1
    most_seeds: ClassVar[int | None] = 60
    title: ClassVar[str] = "three pursuers and three evaders: the last capture under each coupling"
    claim: ClassVar[str] = (
        "The fourth coupling is the fastest; with the second and the fifth, which give pursuer 3 a "
        "faster evader, the game has no solution."
    )
    source: ClassVar[str] = "Table 8.14 and Figure 8.10, section 8.5.3"
    page: ClassVar[str] = "about p. 174"
    includes: ClassVar[tuple[str, ...]] = ("figure-8-10",)
    learned: ClassVar[tuple[int, ...]] = (3,)
    near: ClassVar[float] = 1.5
    expected: ClassVar[str] = (
        f"The printed couplings escape; the fourth's median within {near:g} s of the classical "
        "time."
    )

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the classical times, and the learned ones of the fourth coupling."""
        printed = published(self.id)
        classical = self.classical_row(outcomes, printed["classical"])
        return [
            classical,
            self._hopeless(classical),
            *self.learned_rows(3, outcomes, printed["capture_time"][3]),
        ]

    def _hopeless(self, classical: Row) -> Row:
        """Judge the claim about the pursuer that is slower than its evader."""
        couplings = native.couplings(len(self.settings.game)).tolist()
        prospects = self.settings.game.prospects()
        hopeless = [
            any(prospects[i][j] == "hopeless" for i, j in enumerate(coupling))
            for coupling in couplings
        ]
        escapes = [[time is None for time in times] for times in classical.per_seed]
        row = Row(
            name="escapes",
            columns=self.columns,
            published=[float(time is None) for time in published(self.id)["capture_time"]],
            per_seed=[[float(escape) for escape in each] for each in escapes],
        )
        named = ", ".join(c for c, none in zip(self.columns, hopeless, strict=True) if none)
        reason = f"a pursuer is not faster than its evader in: {named}"
        return judge_claim(row, held=all(each == hopeless for each in escapes), reason=reason)


EXPERIMENTS: tuple[type[Experiment], ...] = (Table89, Table813, Table814)
