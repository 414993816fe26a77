"""Chapter 8, section 8.4: two pursuers and an evader, all learning at once by QLBGFLC.

`docs/chapter-8.md` tells what was found.
"""

from __future__ import annotations

import statistics
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from fuzzyrs._fuzzyrs import (
    Control,
    TwoPursuers,
    TwoPursuersQlbgflcTraining,
    TwoPursuersTrained,
    TwoPursuersTrajectory,
)
from fuzzyrs.experiments.experiment import Experiment, median_seed, published
from fuzzyrs.experiments.figures import draw_games, seeds_of
from fuzzyrs.experiments.printed_settings import PrintedSettings, settings_rows
from fuzzyrs.experiments.result import Result, Row, Value, infinite, rounded
from fuzzyrs.experiments.statistics import share_fits
from fuzzyrs.experiments.strips import by_columns, draw_strips
from fuzzyrs.experiments.trained import train
from fuzzyrs.experiments.verdict import (
    RANKED,
    judge_claim,
    judge_mean_within,
    judge_smaller,
    unchecked,
)
from fuzzyrs.recording import Recording

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIGHT = "line-of-sight"
PREDICTION = "intercept"

#: Who plays: classical robots; all three as they learned together, judged from four starts or from
#: one; their tables after phase 1; and either side as it learned against a classical other side.
LEARNED = "learned"
LITERAL = "learned from one start"
TABLES = "tables of phase 1"
PURSUERS = "learned pursuers, classical evader"
EVADER = "classical pursuers, learned evader"


@dataclass(frozen=True)
class TwoPursuersConfig:
    """Section 8.4: the game, and the starts of Figures 8.4 and 8.7."""

    #: The game of section 8.4.1, whose pursuers are let aim otherwise for Figure 8.7.
    game: TwoPursuers = field(default_factory=TwoPursuers)
    #: Starts of the pursuers [m], (a) to (f); the evader starts from the origin.
    starts: tuple[tuple[tuple[float, float], tuple[float, float]], ...] = (
        ((-3.0, -6.0), (4.0, -4.0)),
        ((-4.0, 3.0), (5.0, -2.0)),
        ((-3.0, 6.0), (-2.0, -5.0)),
        ((-4.0, 5.0), (3.0, 4.0)),
        ((-6.0, -2.0), (5.0, 3.0)),
        ((-5.0, 3.0), (-2.0, 6.0)),
    )
    #: When a test game is given up [s]; ours, about twice the longest printed capture.
    max_time: float = 60.0
    qlbgflc: TwoPursuersQlbgflcTraining = field(default_factory=TwoPursuersQlbgflcTraining)

    def to_dict(self) -> dict[str, Any]:
        """Return everything as plain values."""
        return {
            "game": self.game.to_dict(),
            "starts": [[list(position) for position in start] for start in self.starts],
            "max_time": self.max_time,
            "qlbgflc": self.qlbgflc.to_dict(),
        }

    @property
    def columns(self) -> list[str]:
        """The starts, as the print numbers them."""
        return [chr(ord("a") + index) for index in range(len(self.starts))]

    def aiming(self, aim: str) -> TwoPursuers:
        """Return the game with pursuers that aim so."""
        plain: Any = self.game.to_dict()
        robots = self.game.pursuers, self.game.evader
        options = {k: v for k, v in plain.items() if k not in {"pursuers", "evader"}}
        return TwoPursuers(*robots, **{**options, "aim": aim})

    def trained(
        self, game: TwoPursuers, seed: int, control: Control
    ) -> tuple[dict[str, TwoPursuersTrained], dict[str, float]]:
        """Return the robots that play each other, by what their row is called, and how many seconds
        they took. Phase 1 and stage 1 are done once for all.
        """
        learned, first = train(game, self.qlbgflc, seed, control)
        literal = {**self.qlbgflc.to_dict(), "starts_per_generation": 1}
        settings = TwoPursuersQlbgflcTraining(**literal)
        from_one, second = train(game, settings, seed, control, begun=learned)
        assert learned.tables is not None, "QLBGFLC learns tables first"
        robots = {LEARNED: learned, LITERAL: from_one, TABLES: learned.tables}
        return robots, {LEARNED: first, LITERAL: second}

    def play(self, game: TwoPursuers, pursuers: Any, evader: Any) -> list[TwoPursuersTrajectory]:
        """Play a game from each start."""
        return [
            game.play(pursuers, evader, pursuer_starts=start, max_time=self.max_time)
            for start in self.starts
        ]

    def measure(self, game: TwoPursuers, pursuers: Any, evader: Any) -> dict[str, list[Value]]:
        """Return what came of it, start by start.

        The capture times [s]; the angle between the directions in which both pursuers see the
        evader at the end [rad]; how long they were beside each other [s].
        """
        played = self.play(game, pursuers, evader)
        return {
            "times": [one.capture_time for one in played],
            "angle": [_angle(one) for one in played],
            "beside": [_beside(one, game.time_step) for one in played],
        }


#: Nearer than this two pursuers are beside each other [m]: five capture radii.
BESIDE = 0.5


def _angle(played: TwoPursuersTrajectory) -> float:
    x, y = (played.evader[-1, :2] - played.pursuers[:, -1, :2]).T
    return rounded(float(abs(np.angle(np.exp(1j * (np.arctan2(y, x) @ [1, -1]))))))


def _beside(played: TwoPursuersTrajectory, time_step: float) -> float:
    gaps = np.hypot(*(played.pursuers[0] - played.pursuers[1])[:, :2].T)
    return rounded(float(time_step * (gaps < BESIDE).sum()))


def _told_near(near: dict[str, float]) -> str:
    """Return in words how near the classical times robots are expected that learned."""
    each = ", ".join(f"{name} {most:g} s" for name, most in near.items())
    return f"On 95 % of the seeds no escape, and from classical on average at most: {each}."


class SixStarts(Experiment):
    """The capture times from six starts, classical and learned, with these aims."""

    #: How the pursuers aim, the printed aim last.
    aims: ClassVar[tuple[str, ...]]
    #: How far from classical the learned robots were on 95 % of other seeds, on average over the
    #: starts [s]: judged from four starts and from one.
    near: ClassVar[dict[str, float]]
    heading: ClassVar[str]
    settings: TwoPursuersConfig

    def __init__(self, config: TwoPursuersConfig | None = None) -> None:
        self.settings = config or TwoPursuersConfig()

    def config(self) -> dict[str, Any]:
        """Return the game, the tests and the settings of the training."""
        return {**self.settings.to_dict(), "aims": list(self.aims)}

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Let the robots learn with this seed under every aim, and play from the starts."""
        settings = self.settings
        outcome: dict[str, Any] = {"seconds": {}}
        for aim in self.aims:
            game = settings.aiming(aim)
            reached = {"classical": settings.measure(game, "classical", "classical")}
            learned, seconds = settings.trained(game, seed, control)
            outcome["seconds"] |= {f"{name}, {aim}": taken for name, taken in seconds.items()}
            for name, trained in learned.items():
                reached[name] = settings.measure(game, trained.pursuers, trained.evader)
                if name == LEARNED:
                    pursuers, evader = trained.pursuers, trained.evader
                    reached[PURSUERS] = settings.measure(game, pursuers, "classical")
                    reached[EVADER] = settings.measure(game, "classical", evader)
            outcome[aim] = reached
        return outcome

    def captures(self, outcomes: Sequence[dict[str, Any]]) -> dict[str, Row]:
        """Lay out the capture times; what learned together beside the print."""
        aim, columns, printed = self.aims[-1], self.settings.columns, published(self.id)
        there = dict(zip(printed["columns"], printed["capture_time"], strict=True))
        own = self.settings.starts == TwoPursuersConfig.starts
        rows = {}
        for name in outcomes[0][aim]:
            compared = own and name in {LEARNED, LITERAL}
            rows[name] = Row(
                name=name,
                columns=columns,
                published=[there[column] if compared else None for column in columns],
                per_seed=[outcome[aim][name]["times"] for outcome in outcomes],
            )
        return rows

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the capture times, and judge those that are printed."""
        rows = self.captures(outcomes)
        classical = [infinite(time) for time in rows["classical"].per_seed[0]]
        judged = {
            name: judge_mean_within(rows[name], classical, most) for name, most in self.near.items()
        }
        wide = "from one start the seeds spread too far for a band; the print is one run"
        reasons = {LITERAL: wide}
        return [
            judged.get(name) or unchecked(row, reasons.get(name, "not printed"))
            for name, row in rows.items()
        ]

    def games(
        self, outcomes: Sequence[dict[str, Any]], seeds: Sequence[int]
    ) -> Iterator[Recording]:
        """Play from the starts: classical robots, and those of the median seed."""
        settings, aim = self.settings, self.aims[-1]
        game = settings.aiming(aim)
        chosen = median_seed([outcome[aim][LEARNED]["times"] for outcome in outcomes])
        trained, _ = train(game, settings.qlbgflc, seeds[chosen], Control())
        plain = settings.play(game, "classical", "classical")
        learned = settings.play(game, trained.pursuers, trained.evader)
        for start, *both in zip(settings.starts, plain, learned, strict=True):
            panel = "pursuers from " + ", ".join(f"({x:g}, {y:g})" for x, y in start) + " m"
            labels = ("classical", f"learned (seed {seeds[chosen]})")
            for label, played in zip(labels, both, strict=True):
                radius = game.capture_radius
                yield Recording.of(played, label=label, panel=panel, capture_radius=radius)

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the paths from the starts, and the capture times of all seeds."""
        yield f"{self.id}-paths", draw_games(result.games, self.heading)
        columns = self.settings.columns
        rows = [row for row in result.rows if row.name in result.outcomes[0][self.aims[-1]]]
        title = f"Capture times by start, {seeds_of(len(result.seeds))}"
        shown = by_columns(rows, "time [s]", [f"start {column}" for column in columns])
        yield f"{self.id}-times", draw_strips(shown, title)


class Figure84(SixStarts):
    """Figure 8.4: pursuers that follow the line of sight."""

    id: ClassVar[str] = "figure-8-4"
    cost: ClassVar[float] = 1.9
    quick_seeds: ClassVar[int] = 1
    most_seeds: ClassVar[int | None] = 40
    title: ClassVar[str] = "two pursuers and an evader learn at once"
    claim: ClassVar[str] = (
        "Both pursuers and the evader learn their strategies at once; pursuers that start side by "
        "side end up on one path."
    )
    source: ClassVar[str] = "Figure 8.4, section 8.4.1"
    page: ClassVar[str] = "about pp. 157-159"
    aims: ClassVar[tuple[str, ...]] = (SIGHT,)
    near: ClassVar[dict[str, float]] = {LEARNED: 1.5, LITERAL: 3.5}
    expected: ClassVar[str] = _told_near(near)
    heading: ClassVar[str] = "Paths after learning; pursuers follow the line of sight"


class Figure87(SixStarts):
    """Figure 8.7: pursuers that steer to where they would meet the evader."""

    id: ClassVar[str] = "figure-8-7"
    cost: ClassVar[float] = 2
    quick_seeds: ClassVar[int] = 1
    most_seeds: ClassVar[int | None] = 40
    title: ClassVar[str] = "two pursuers that predict where they meet the evader"
    claim: ClassVar[str] = (
        "Prediction shortens the capture from every start, and the pursuers take different paths."
    )
    source: ClassVar[str] = "Figure 8.7, section 8.4.2"
    page: ClassVar[str] = "about pp. 163-164"
    aims: ClassVar[tuple[str, ...]] = (SIGHT, PREDICTION)
    near: ClassVar[dict[str, float]] = {LEARNED: 1.0}
    expected: ClassVar[str] = (
        f"{_told_near(near)} Prediction is sooner from every start, without chance and on 95 % of "
        f"the seeds; rankings: {RANKED}."
    )
    heading: ClassVar[str] = "Paths after learning; pursuers predict the capture"

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the capture times, and judge what prediction is said to bring."""
        shorter = "claim: prediction shortens the capture"
        parts = "claim: prediction parts the pursuers"
        classical, learned = (
            self._gains(outcomes, name, f"{shorter} [s saved], {name}")
            for name in ("classical", LEARNED)
        )
        always = all(min(map(float, gains)) > 0 for gains in _numbers(classical))
        return [
            *super().rows(outcomes),
            judge_claim(classical, held=always, reason="less from every start, without chance"),
            _from_every_start(learned),
            *(
                judge_smaller(
                    self._means(outcomes, "times", f"{shorter}, mean of the starts, {name}", name),
                    PREDICTION,
                    than=SIGHT,
                )
                for name in (LEARNED, LITERAL)
            ),
            judge_smaller(
                self._means(outcomes, "angle", f"{parts}: angle between them at the end [rad]"),
                SIGHT,
                than=PREDICTION,
            ),
            judge_smaller(
                self._means(outcomes, "beside", f"{parts}: time within {BESIDE:g} m [s]"),
                PREDICTION,
                than=SIGHT,
            ),
        ]

    def _gains(self, outcomes: Sequence[dict[str, Any]], name: str, called: str) -> Row:
        """Lay out by how much the capture is sooner with prediction [s], start by start."""
        printed = [published(figure)["capture_time"] for figure in ("figure-8-4", "figure-8-7")]
        own = self.settings.starts == TwoPursuersConfig.starts

        def saved(before: Sequence[Value], after: Sequence[Value]) -> list[Value]:
            limit = self.settings.max_time  # an escape counts as that
            pairs = zip(before, after, strict=True)
            return [rounded(min(infinite(a), limit) - min(infinite(b), limit)) for a, b in pairs]

        return Row(
            name=called,
            columns=self.settings.columns,
            published=saved(*printed) if own else [None] * len(self.settings.starts),
            per_seed=[saved(*(one[aim][name]["times"] for aim in self.aims)) for one in outcomes],
        )

    def _means(
        self, outcomes: Sequence[dict[str, Any]], what: str, called: str, name: str = LEARNED
    ) -> Row:
        """Lay out a mean over the starts with both aims; an escape counts as the time limit."""
        limit = self.settings.max_time

        def mean(values: Sequence[Value]) -> float:
            return rounded(statistics.fmean(limit if v is None else v for v in values))

        return Row(
            name=called,
            columns=list(self.aims),
            published=[None] * len(self.aims),
            per_seed=[
                [mean(outcome[aim][name][what]) for aim in self.aims] for outcome in outcomes
            ],
            digits=2,
        )


def _numbers(row: Row) -> list[list[float]]:
    return [[float(value or 0.0) for value in values] for values in row.per_seed]


def _from_every_start(gains: Row) -> Row:
    """Judge that the capture is sooner from every start on the usual seed."""
    each = _numbers(gains)
    every = sum(min(values) > 0 for values in each)
    starts = [
        f"{column} {sum(values[index] > 0 for values in each) / len(each):.0%}"
        for index, column in enumerate(gains.columns)
    ]
    reason = (
        f"from every start on {every} of {len(each)} seeds, expected 95 %; sooner from "
        f"{', '.join(starts)}"
    )
    held = share_fits(every, len(each), least=0.95)
    return judge_claim(gains, held=held, reason=reason, chance=True)


class Table81(PrintedSettings):
    """Table 8.1: what the genetic searches of section 8.4 are set to."""

    id: ClassVar[str] = "table-8-1"
    cost: ClassVar[float] = 0.007
    title: ClassVar[str] = "sizes of the genetic searches of three robots"
    claim: ClassVar[str] = (
        "None; `TwoPursuersQlbgflcTraining` has these values unless told otherwise."
    )
    source: ClassVar[str] = "Table 8.1, section 8.4.1"
    page: ClassVar[str] = "about p. 158"

    def __init__(self, config: TwoPursuersQlbgflcTraining | None = None) -> None:
        self.settings = config or TwoPursuersQlbgflcTraining()

    def config(self) -> dict[str, Any]:
        """Return the settings of QLBGFLC."""
        return {"qlbgflc": self.settings.to_dict()}

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the sizes of both searches.

        The scan lost the population of stage 2; 10 is that of every other table.
        """
        return settings_rows(self.settings, published(self.id), len(outcomes))


EXPERIMENTS: tuple[type[Experiment], ...] = (Table81, Figure84, Figure87)
