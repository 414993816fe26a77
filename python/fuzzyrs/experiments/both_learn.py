"""Sections 6.5.4 and 7.3.3: the pursuer and the evader learn at the same time.

The thesis compares paths by eye: the nearer to the classical ones, the better. But an evader that
steers hard over when the pursuer is near is never caught, so the classical evader isn't the best,
and a likeness is no merit. What each robot can do shows against classical opponents.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar

from fuzzyrs._fuzzyrs import (
    Control,
    DaiTraining,
    FuzzyController,
    OneOnOne,
    QLambdaTraining,
    QlbgflcTraining,
    QlfisTraining,
    RewardGaTraining,
    Trained,
)
from fuzzyrs.experiments.crossplay import MEASURES, CrossPlay, Start, cross_play
from fuzzyrs.experiments.experiment import Experiment, median_seed, published
from fuzzyrs.experiments.figures import draw_games, named, seeds_of
from fuzzyrs.experiments.result import Result, Row, Value, total
from fuzzyrs.experiments.statistics import share_fits
from fuzzyrs.experiments.strips import by_columns, draw_strips
from fuzzyrs.experiments.trained import train
from fuzzyrs.experiments.tuned import TunedController
from fuzzyrs.experiments.verdict import RANKED, judge_claim, judge_smallest, unchecked
from fuzzyrs.recording import Recording

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Pair = tuple[Any, Any]


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
    reward_ga: Pair = field(default_factory=lambda: (RewardGaTraining(), RewardGaTraining()))
    qlbgflc: Pair = field(default_factory=lambda: (_qlbgflc(11), _qlbgflc(21)))
    qlfis: Pair = field(default_factory=lambda: (QlfisTraining(), QlfisTraining()))
    dai: Pair = field(default_factory=lambda: (DaiTraining(), DaiTraining()))

    def techniques(self, names: Sequence[str]) -> dict[str, Pair]:
        """Return the settings of techniques, whose names may end in the pairing of individuals."""
        found = {}
        for name in names:
            technique, _, pairing = name.partition(" by ")
            pair = getattr(self, technique)
            changes = {"pairing": pairing} if pairing else {}
            found[name] = tuple(type(one)(**{**one.to_dict(), **changes}) for one in pair)
        return found

    def train(self, pair: Pair, seed: int, control: Control) -> tuple[Trained, float]:
        """Let both robots learn, and tell how many seconds it took."""
        return train(self.game, pair[0], seed, control, evader=pair[1])


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
            trained, outcome["seconds"][name] = settings.train(pair, seed, control)
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
                per_seed=[[*CrossPlay(**one).measures(self.settings.max_time)] for one in each],
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

    def games(
        self, outcomes: Sequence[dict[str, Any]], seeds: Sequence[int]
    ) -> Iterator[Recording]:
        """Play from the last start: classical robots, and those of each technique's median seed."""
        settings, start = self.settings, self.settings.starts[-1]
        for name, pair in settings.techniques(self.names).items():
            chosen = median_seed([_likeness(outcome[name]) for outcome in outcomes])
            trained, _ = settings.train(pair, seeds[chosen], Control())
            players = {
                "classical": ("classical", "classical"),
                "learned": (trained.controller, trained.evader),
            }
            for label, (one, other) in players.items():
                yield Recording.of(
                    settings.game.play(one, other, evader_start=start, max_time=settings.max_time),
                    label=label,
                    panel=f"{named(name)} (seed {seeds[chosen]})",
                    capture_radius=settings.game.capture_radius,
                )

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the paths of each technique, and what all seeds reached."""
        x, y = self.settings.starts[-1]
        title = f"Both learned; evader from ({x:g}, {y:g}) m"
        yield f"{self.id}-paths", draw_games(result.games, title, columns=3)
        rows = [row for row in result.rows if row.columns == list(MEASURES)]
        title = (
            f"Learned beside classical robots, worst of six starts, {seeds_of(len(result.seeds))}"
        )
        yield f"{self.id}-measures", draw_strips(by_columns(rows), title)


def _likeness(outcome: Mapping[str, Any]) -> list[float]:
    return [*outcome["pursuer_distance"], *outcome["evader_distance"]]


#: By what techniques are ranked: measures, added up.
PATHS = ("distance of both paths [m]", ("pursuer's path [m]", "evader's path [m]"))
LOSS = ("pursuer's loss [s]", ("pursuer's loss [s]",))


def ranking(rows: Mapping[str, Row], by: tuple[str, Sequence[str]]) -> Row:
    """Lay out the sum of some measures, technique by technique."""
    name, measures = by
    indices = [MEASURES.index(measure) for measure in measures]

    def one(row: Row, seed: int) -> Value:
        return total([row.per_seed[seed][index] for index in indices])

    seeds = range(len(next(iter(rows.values())).per_seed))
    return Row(
        name=name,
        columns=list(rows),
        published=[None] * len(rows),
        per_seed=[[one(row, seed) for row in rows.values()] for seed in seeds],
        digits=2,
    )


def _named(row: Row, best: str) -> Row:
    return replace(row, name=f"{row.name}: {best} least")


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
    cost: ClassVar[float] = 1.1
    quick_seeds: ClassVar[int] = 1
    title: ClassVar[str] = "both robots learn: cross-play, paths and learning times"
    claim: ClassVar[str] = (
        "QLBGFLC is nearest to the classical paths at the least learning time; the reward-based GA "
        "gets worse."
    )
    source: ClassVar[str] = "Table 6.7 and Figures 6.14-6.16, section 6.5.4"
    page: ClassVar[str] = "about pp. 118-119"
    expected: ClassVar[str] = f"The technique that is claimed to be best: {RANKED}."
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
        claims = [
            judge_smallest(
                _named(ranking(measured, by), "qlbgflc" + pairing),
                "qlbgflc" + pairing,
                than=["q_lambda", "reward_ga" + pairing],
            )
            for by in (PATHS, LOSS)
            for pairing in ("", BY_PLACE)
        ]
        times = self.learning_times(outcomes)
        fastest = judge_smallest(times, "qlbgflc", than=["q_lambda", "reward_ga"])
        return [*rows, *claims, fastest]


class Table76(BothLearn):
    """Table 7.6 and Figures 7.7 to 7.11."""

    id: ClassVar[str] = "table-7-6"
    cost: ClassVar[float] = 0.45
    title: ClassVar[str] = "both robots learn, five techniques: cross-play, paths, learning times"
    claim: ClassVar[str] = (
        "QLBGFLC and QLFIS are about equal and the best; QLBGFLC learns in the least time."
    )
    source: ClassVar[str] = "Table 7.6 and Figures 7.7-7.11, section 7.3.3"
    page: ClassVar[str] = "about pp. 136-138"
    expected: ClassVar[str] = (
        f"The technique that is claimed to be best: {RANKED}. "
        "QLFIS on 95 % of the seeds: no escape, "
        + ", ".join(f"{measure} at most {most:g}" for measure, most in QLFIS_BANDS.items())
        + "."
    )
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
        claims = [
            judge_smallest(_named(ranking(measured, by), one), one, than=than)
            for by in (PATHS, LOSS)
            for one, than in (("qlbgflc", others), ("qlfis", [*others, "qlbgflc"]))
        ]
        times = self.learning_times(outcomes)
        fastest = judge_smallest(times, "qlbgflc", than=[*others, "qlfis"])
        return [*rows, *claims, fastest]


class TunedTogether(TunedController):
    """A robot's controller after both learned."""

    claim: ClassVar[str] = "None; the table and the figure show one run's controller."
    #: Of `BothLearnConfig`.
    technique: ClassVar[str]

    def __init__(self, config: BothLearnConfig | None = None) -> None:
        self.settings = config or BothLearnConfig()

    def config(self) -> dict[str, Any]:
        """Return the game and the settings of both robots."""
        pursuer, evader = getattr(self.settings, self.technique)
        return {
            "game": self.settings.game.to_dict(),
            "pursuer": pursuer.to_dict(),
            "evader": evader.to_dict(),
        }

    def learn(self, seed: int, control: Control) -> tuple[FuzzyController, list[Value]]:
        """Let both robots learn with this seed, and let this one play a classical opponent."""
        settings = self.settings
        trained, _ = settings.train(getattr(settings, self.technique), seed, control)
        own: Any = trained.controller if self.robot == "pursuer" else trained.evader
        players = (own, "classical") if self.robot == "pursuer" else ("classical", own)
        played = settings.game.play_many(
            *players, evader_starts=settings.starts, max_time=settings.max_time
        )
        return own, [float(duration) for duration in played.duration]


class Table65(TunedTogether):
    """Table 6.5 and Figure 6.12."""

    id: ClassVar[str] = "table-6-5"
    cost: ClassVar[float] = 0.11
    title: ClassVar[str] = "the pursuer tuned by QLBGFLC while both learn"
    source: ClassVar[str] = "Table 6.5 and Figure 6.12, section 6.5.4"
    page: ClassVar[str] = "about p. 116"
    includes: ClassVar[tuple[str, ...]] = ("figure-6-12",)
    robot: ClassVar[str] = "pursuer"
    technique: ClassVar[str] = "qlbgflc"


class Table66(TunedTogether):
    """Table 6.6 and Figure 6.13."""

    id: ClassVar[str] = "table-6-6"
    cost: ClassVar[float] = 0.002
    title: ClassVar[str] = "the evader tuned by QLBGFLC while both learn"
    source: ClassVar[str] = "Table 6.6 and Figure 6.13, section 6.5.4"
    page: ClassVar[str] = "about p. 117"
    includes: ClassVar[tuple[str, ...]] = ("figure-6-13",)
    robot: ClassVar[str] = "evader"
    technique: ClassVar[str] = "qlbgflc"


class Table74(TunedTogether):
    """Table 7.4 and Figure 7.5."""

    id: ClassVar[str] = "table-7-4"
    cost: ClassVar[float] = 0.13
    title: ClassVar[str] = "the pursuer tuned by QLFIS while both learn"
    source: ClassVar[str] = "Table 7.4 and Figure 7.5, section 7.3.3"
    page: ClassVar[str] = "about p. 135"
    includes: ClassVar[tuple[str, ...]] = ("figure-7-5",)
    robot: ClassVar[str] = "pursuer"
    technique: ClassVar[str] = "qlfis"


class Table75(TunedTogether):
    """Table 7.5 and Figure 7.6."""

    id: ClassVar[str] = "table-7-5"
    cost: ClassVar[float] = 0.002
    title: ClassVar[str] = "the evader tuned by QLFIS while both learn"
    source: ClassVar[str] = "Table 7.5 and Figure 7.6, section 7.3.3"
    page: ClassVar[str] = "about p. 136"
    includes: ClassVar[tuple[str, ...]] = ("figure-7-6",)
    robot: ClassVar[str] = "evader"
    technique: ClassVar[str] = "qlfis"


CHAPTER_6: tuple[type[Experiment], ...] = (Table65, Table66, Table67)
CHAPTER_7: tuple[type[Experiment], ...] = (Table74, Table75, Table76)
