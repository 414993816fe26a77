"""Sections 6.5.4 and 7.3.3: the pursuer and the evader learn at the same time.

The thesis compares paths by eye: the nearer to the classical ones, the better. But an evader that
steers hard over when the pursuer is near is never caught, so the classical evader isn't the best,
and a likeness is no merit. What each robot can do shows against classical opponents.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, ClassVar

import fuzzyrs._fuzzyrs as native
from fuzzyrs import plot
from fuzzyrs._fuzzyrs import (
    Control,
    DaiTraining,
    OneOnOne,
    QLambdaTraining,
    QlbgflcTraining,
    QlfisTraining,
    RewardGaTraining,
)
from fuzzyrs.experiments.crossplay import MEASURES, CrossPlay, Start, cross_play
from fuzzyrs.experiments.experiment import Experiment, median_seed, published, save_figure
from fuzzyrs.experiments.result import Row
from fuzzyrs.experiments.statistics import FEWEST_PAIRS, paired, share_fits
from fuzzyrs.experiments.verdict import judge_claim, unchecked

Pair = tuple[Any, Any]


def _both(settings: Any, evader: dict[str, Any] | None = None) -> Pair:
    """Return settings of the pursuer and of the evader, which differ as told."""
    return settings, type(settings)(**{**settings.to_dict(), **(evader or {})})


def _exploring(**changes: Any) -> QLambdaTraining:
    """Return Q(λ) as for one learner, but for ε = 1/i (6.19)."""
    return QLambdaTraining(exploration=1.0, **changes)


def _qlbgflc(actions: int) -> QlbgflcTraining:
    """Return QLBGFLC whose first phase is Q(λ) with so many steering angles."""
    return QlbgflcTraining(phase_1=_exploring(episodes=200, actions=actions))


@dataclass(frozen=True)
class BothLearnConfig:
    """The game of section 6.5.2, learners in both robots; of each the pursuer's, the evader's."""

    game: OneOnOne = field(default_factory=OneOnOne)
    #: Those of Table 6.3, and two from where the printed paths may begin.
    starts: tuple[Start, ...] = (
        (-6.0, 7.0),
        (-7.0, -7.0),
        (2.0, 4.0),
        (3.0, -8.0),
        (6.0, 7.0),
        (5.0, 8.0),
    )
    #: When a test game is given up [s].
    max_time: float = 60.0
    #: The evader has 21 steering angles (6.5.4).
    q_lambda: Pair = field(default_factory=lambda: (_exploring(), _exploring(actions=21)))
    reward_ga: Pair = field(default_factory=lambda: _both(RewardGaTraining()))
    qlbgflc: Pair = field(default_factory=lambda: (_qlbgflc(11), _qlbgflc(21)))
    qlfis: Pair = field(default_factory=lambda: _both(QlfisTraining()))
    dai: Pair = field(default_factory=lambda: _both(DaiTraining()))

    def techniques(self, names: Sequence[str]) -> dict[str, Pair]:
        """Return the settings of techniques, whose names may end in the pairing of individuals."""
        found = {}
        for name in names:
            technique, _, pairing = name.partition(" by ")
            pair = getattr(self, technique)
            changes = {"pairing": pairing} if pairing else {}
            found[name] = tuple(type(one)(**{**one.to_dict(), **changes}) for one in pair)
        return found

    def train(self, pair: Pair, seed: int, control: Control) -> native.Trained:
        """Let both robots learn."""
        return native.train(self.game, pair[0], evader=pair[1], seed=seed, control=control)


class BothLearn(Experiment):
    """Techniques compared where both robots learn."""

    values: ClassVar[str] = "losses and gains beside the classical game, worst of six starts"
    #: Of `BothLearnConfig.techniques`.
    names: ClassVar[tuple[str, ...]]

    def __init__(self, config: BothLearnConfig | None = None) -> None:
        self.settings = config or BothLearnConfig()

    def config(self) -> dict[str, Any]:
        """Return the game, the starts and the settings of all techniques."""
        settings = self.settings
        return {
            "game": settings.game.to_dict(),
            "starts": [list(start) for start in settings.starts],
            "max_time": settings.max_time,
            **{
                name: [one.to_dict() for one in pair]
                for name, pair in settings.techniques(self.names).items()
            },
        }

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Let both robots learn by each technique, and see how they play."""
        settings = self.settings
        outcome: dict[str, Any] = {"seconds": {}}
        for name, pair in settings.techniques(self.names).items():
            began = time.perf_counter()
            trained = settings.train(pair, seed, control)
            outcome["seconds"][name] = time.perf_counter() - began
            players = (trained.controller, trained.evader)
            played = cross_play(settings.game, *players, settings.starts, settings.max_time)
            outcome[name] = {
                "learning_time": round(trained.learning_time, 6),
                **played.to_dict(),
            }
        return outcome

    def measures(self, outcomes: Sequence[dict[str, Any]]) -> dict[str, Row]:
        """Lay out what every technique reached."""
        rows = {}
        for name in self.names:
            each = [{k: v for k, v in o[name].items() if k != "learning_time"} for o in outcomes]
            rows[name] = Row(
                name=name,
                columns=list(MEASURES),
                published=[None] * len(MEASURES),
                per_seed=[CrossPlay(**one).measures(self.settings.max_time) for one in each],
                digits=2,
            )
        return rows

    def learning_times(self, outcomes: Sequence[dict[str, Any]]) -> Row:
        """Lay out the simulated learning times beside the print."""
        printed = published(self.id)["learning_time"]
        return Row(
            name="learning time [s]",
            columns=list(self.names),
            published=[printed.get(name) for name in self.names],
            per_seed=[[o[name]["learning_time"] for name in self.names] for o in outcomes],
        )

    def draw(
        self, outcomes: Sequence[dict[str, Any]], seeds: Sequence[int], folder: Path
    ) -> Iterator[Path]:
        """Save the paths of each technique beside the classical ones."""
        plot.require_matplotlib()
        for name, pair in self.settings.techniques(self.names).items():
            chosen = median_seed([_likeness(outcome[name]) for outcome in outcomes])
            trained = self.settings.train(pair, seeds[chosen], Control())
            path = folder / f"{self.id}-{name.replace(' ', '-')}.png"
            title = f"Both learned by {name} (seed {seeds[chosen]}), classical dotted"
            yield self._draw_paths(trained, title, path)

    def _draw_paths(self, trained: native.Trained, title: str, path: Path) -> Path:
        from matplotlib.figure import Figure

        settings = self.settings
        figure = Figure(figsize=(12, 8), layout="constrained")
        for index, start in enumerate(settings.starts):
            axes = figure.add_subplot(2, -(-len(settings.starts) // 2), index + 1)
            players = {":": ("classical", "classical"), "-": (trained.controller, trained.evader)}
            for style, (one, other) in players.items():
                played = settings.game.play(
                    one, other, evader_start=start, max_time=settings.max_time
                )
                plot.paths(played, ax=axes, style=style)
                caught = played.capture_time
                axes.plot([], [], " ", label="escaped" if caught is None else f"{caught:.1f} s")
            axes.legend(loc="best", fontsize="x-small")
            axes.set_title(f"evader from ({start[0]:g}, {start[1]:g}) m")
        figure.suptitle(title)
        return save_figure(figure, path)


def _likeness(outcome: Mapping[str, Any]) -> list[float]:
    return [*outcome["pursuer_distance"], *outcome["evader_distance"]]


def paths(rows: Mapping[str, Row], names: Sequence[str]) -> Row:
    """Lay out how far both robots together are from the classical paths [m]."""
    columns = [MEASURES.index(measure) for measure in MEASURES if "path" in measure]
    count = len(next(iter(rows.values())).per_seed)

    def both(name: str, seed: int) -> float:
        values = [rows[name].per_seed[seed][column] for column in columns]
        return sum(value for value in values if value is not None)

    return Row(
        name="distance of both paths [m]",
        columns=list(names),
        published=[None] * len(names),
        per_seed=[[both(name, seed) for name in names] for seed in range(count)],
        digits=2,
    )


def judge_smallest(row: Row, column: str, than: Sequence[str]) -> Row:
    """Judge the claim that a column is smaller than each of some others, seed by seed."""
    own = [values[row.columns.index(column)] for values in row.per_seed]
    decisions, reasons = [], []
    for other in than:
        theirs = [values[row.columns.index(other)] for values in row.per_seed]
        comparison = paired([float(v or 0) for v in own], [float(v or 0) for v in theirs])
        decisions.append(comparison.decision)
        reasons.append(f"{column} against {other}: {comparison}")
    reason = "; ".join(reasons)
    if len(row.per_seed) < FEWEST_PAIRS:
        return unchecked(row, f"{FEWEST_PAIRS} pairs are needed; {reason}")
    return judge_claim(row, held=set(decisions) == {"smaller"}, reason=reason)


#: What QLFIS reached on 95 % of other seeds: no escape, and no more than these [s, m, m].
QLFIS_BANDS = {"pursuer's loss [s]": 0.6, "pursuer's path [m]": 0.7, "evader's path [m]": 1.1}


def judge_qlfis(row: Row) -> Row:
    """Judge the measures of QLFIS by what they were on other seeds."""
    escapes = row.columns.index("escapes [%]")
    limits = {row.columns.index(measure): most for measure, most in QLFIS_BANDS.items()}
    count = len(row.per_seed)
    held = sum(
        values[escapes] == 0 and all((values[c] or 0) <= most for c, most in limits.items())
        for values in row.per_seed
    )
    shown = ", ".join(f"{measure} at most {most:g}" for measure, most in QLFIS_BANDS.items())
    reason = f"{held} of {count} seeds without escape and {shown}, expected 95 %"
    return judge_claim(row, held=share_fits(held, count, least=0.95), reason=reason, chance=True)


NOT_PRINTED = "the print has paths of one run; these are ours"

#: How individuals of two populations may meet; the thesis doesn't say.
BY_PLACE = " by place"


class Table67(BothLearn):
    """Table 6.7 and Figures 6.14 to 6.16."""

    id: ClassVar[str] = "table-6-7"
    title: ClassVar[str] = "both robots learn: cross-play, paths and learning times"
    claim: ClassVar[str] = (
        "QLBGFLC is nearest to the classical paths at the least learning time; the reward-based GA "
        "gets worse."
    )
    source: ClassVar[str] = "Table 6.7 and Figures 6.14-6.16, section 6.5.4"
    includes: ClassVar[tuple[str, ...]] = ("figure-6-14", "figure-6-15", "figure-6-16")
    names: ClassVar[tuple[str, ...]] = (
        "q_lambda",
        "reward_ga",
        "reward_ga" + BY_PLACE,
        "qlbgflc",
        "qlbgflc" + BY_PLACE,
    )

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the measures of each technique, and judge the claims."""
        measured = self.measures(outcomes)
        rows = [unchecked(row, NOT_PRINTED) for row in measured.values()]
        likeness = paths(measured, self.names)
        nearest = judge_smallest(likeness, "qlbgflc", than=["q_lambda", "reward_ga"])
        by_place = judge_smallest(
            replace(likeness, name="the same, individuals meet by place"),
            "qlbgflc" + BY_PLACE,
            than=["q_lambda", "reward_ga" + BY_PLACE],
        )
        times = self.learning_times(outcomes)
        fastest = judge_smallest(times, "qlbgflc", than=["q_lambda", "reward_ga"])
        return [*rows, nearest, by_place, fastest]


class Table76(BothLearn):
    """Table 7.6 and Figures 7.7 to 7.11."""

    id: ClassVar[str] = "table-7-6"
    title: ClassVar[str] = "both robots learn, five techniques: cross-play, paths, learning times"
    claim: ClassVar[str] = (
        "QLBGFLC and QLFIS are about equal and the best; QLBGFLC learns in the least time."
    )
    source: ClassVar[str] = "Table 7.6 and Figures 7.7-7.11, section 7.3.3"
    includes: ClassVar[tuple[str, ...]] = tuple(f"figure-7-{number}" for number in range(7, 12))
    names: ClassVar[tuple[str, ...]] = ("q_lambda", "reward_ga", "dai", "qlbgflc", "qlfis")

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the measures of each technique, and judge the claims."""
        measured = self.measures(outcomes)
        rows = [
            judge_qlfis(row) if name == "qlfis" else unchecked(row, NOT_PRINTED)
            for name, row in measured.items()
        ]
        others = ["q_lambda", "reward_ga", "dai"]
        likeness = paths(measured, self.names)
        best = [
            judge_smallest(replace(likeness, name=f"{likeness.name}: {one}"), one, than=than)
            for one, than in (("qlbgflc", others), ("qlfis", [*others, "qlbgflc"]))
        ]
        times = self.learning_times(outcomes)
        fastest = judge_smallest(times, "qlbgflc", than=[*others, "qlfis"])
        return [*rows, *best, fastest]


EXPERIMENTS: tuple[type[Experiment], ...] = (Table67, Table76)
