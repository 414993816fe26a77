"""Tables of capture times: techniques that teach a pursuer, tested from a few starts."""

from __future__ import annotations

import json
from abc import abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from fuzzyrs._fuzzyrs import Control, FuzzyController, OneOnOne, Trajectory
from fuzzyrs.experiments.experiment import Experiment, median_seed, published
from fuzzyrs.experiments.figures import draw_games, named, pursuits, seeds_of
from fuzzyrs.experiments.result import Result, Row, Value, total
from fuzzyrs.experiments.strips import by_columns, draw_strips
from fuzzyrs.experiments.trained import train
from fuzzyrs.experiments.tuned import controller_of
from fuzzyrs.recording import Recording

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Times = list[Value]


@dataclass(frozen=True)
class CaptureConfig:
    """Section 6.5.2: the evader flees along the line of sight.

    The techniques' own defaults are the thesis's values; their pages are beside each in the
    documentation of the settings.
    """

    #: The game of section 6.5.2.
    game: OneOnOne = field(default_factory=OneOnOne)
    #: Starts of the evader [m], Tables 6.3 and 7.3.
    starts: tuple[tuple[float, float], ...] = ((-6.0, 7.0), (-7.0, -7.0), (2.0, 4.0), (3.0, -8.0))
    #: When a test game is given up [s]; ours, about four times the longest published capture.
    max_time: float = 60.0

    def to_dict(self) -> dict[str, Any]:
        """Return the game and the tests as plain values."""
        return {
            "game": self.game.to_dict(),
            "starts": [list(start) for start in self.starts],
            "max_time": self.max_time,
        }

    def times(self, pursuer: Any) -> Times:
        """Return the capture times of a pursuer from the starts."""
        limit = self.max_time
        outcomes = self.game.play_many(pursuer, evader_starts=self.starts, max_time=limit)
        return [None if np.isnan(t) else float(t) for t in outcomes.capture_time]

    @property
    def columns(self) -> list[str]:
        """The starts, as the columns of tables."""
        return [f"({x:g},{y:g})" for x, y in self.starts]


class CaptureTable(Experiment):
    """Capture times of the techniques from each start, and how long they learn."""

    #: Whose paths are drawn.
    drawn: ClassVar[str]
    settings: CaptureConfig

    @abstractmethod
    def trainings(self) -> Mapping[str, Any]:
        """Return the settings of every technique by its name."""

    def config(self) -> dict[str, Any]:
        """Return the game and the settings of all techniques."""
        trainings = {name: training.to_dict() for name, training in self.trainings().items()}
        return {**self.settings.to_dict(), **trainings}

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Train every technique with this seed and play from the starts."""
        settings = self.settings
        outcome: dict[str, Any] = {
            "classical": {"times": settings.times("classical")},
            "seconds": {},
        }
        for name, training in self.trainings().items():
            trained, outcome["seconds"][name] = train(settings.game, training, seed, control)
            outcome[name] = {
                "times": settings.times(trained.controller),
                "learning_time": round(trained.learning_time, 6),
            }
            if isinstance(trained.controller, FuzzyController):
                outcome[name]["controller"] = json.loads(trained.controller.to_json())
        return outcome

    def captures(self, outcomes: Sequence[dict[str, Any]]) -> dict[str, Row]:
        """Lay out the capture times beside the printed ones."""
        printed, rows = published(self.id), {}
        for name in ("classical", *self.trainings()):
            at_start: dict[str, Value] = {}
            if name in printed:
                at_start = dict(zip(printed["columns"], printed[name], strict=True))
            rows[name] = Row(
                name=name,
                columns=self.settings.columns,
                published=[at_start.get(column) for column in self.settings.columns],
                per_seed=[outcome[name]["times"] for outcome in outcomes],
            )
        return rows

    def learning_times(self, outcomes: Sequence[dict[str, Any]], names: Sequence[str]) -> Row:
        """Lay out the simulated learning times beside the printed ones of a computer."""
        printed = published(self.id)["learning_time"]
        return Row(
            name="learning_time",
            columns=list(names),
            published=[printed.get(name) for name in names],
            per_seed=[[outcome[name]["learning_time"] for name in names] for outcome in outcomes],
        )

    def _pursuer(
        self, outcomes: Sequence[dict[str, Any]], seeds: Sequence[int]
    ) -> tuple[FuzzyController, int]:
        """Return the pursuer of the median seed, and the seed."""
        chosen = median_seed([outcome[self.drawn]["times"] for outcome in outcomes])
        return controller_of(outcomes[chosen][self.drawn]), seeds[chosen]

    def games(
        self, outcomes: Sequence[dict[str, Any]], seeds: Sequence[int]
    ) -> Iterator[Recording]:
        """Play from each start: the classical pursuer, and the median seed's."""
        settings = self.settings
        pursuer, seed = self._pursuer(outcomes, seeds)
        players: dict[str, Any] = {
            "classical": "classical",
            f"{named(self.drawn)} (seed {seed})": pursuer,
        }

        def play(player: Any, start: tuple[float, float]) -> Trajectory:
            return settings.game.play(player, evader_start=start, max_time=settings.max_time)

        yield from pursuits(play, players, settings.starts, settings.game.capture_radius)

    def controllers(self, result: Result) -> Iterator[tuple[str, FuzzyController]]:
        """Yield the pursuer of the median seed."""
        yield f"{self.id}-pursuer", self._pursuer(result.outcomes, result.seeds)[0]

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the paths from each start, and the capture times of all seeds."""
        yield f"{self.id}-paths", draw_games(result.games, "Pursuits of section 6.5.2")
        rows = [row for row in result.rows if row.name in {"classical", *self.trainings()}]
        title = f"Capture times by start of the evader, {seeds_of(len(result.seeds))}"
        yield f"{self.id}-times", draw_strips(by_columns(rows, "time [s]"), title)


def told_near(name: str, near: tuple[float, Mapping[str, Any]]) -> str:
    """Return in words what `judge_near` expects of a technique."""
    share, how = near
    medians = ", ".join(f"{median:g}" for median in how["medians"])
    return (
        f"{named(name)}: 95 % of the seeds at most {how['margin']:g} s above classical, medians "
        f"within {how['within']:g} s of {medians}, less in sum than Q(λ) on {share:.0%}"
    )


def sums(captures: Mapping[str, Row], names: Sequence[str]) -> Row:
    """Lay out the sums of each technique's capture times, by which it is ranked."""
    each = [[total(times) for times in captures[name].per_seed] for name in names]
    return Row(
        name="sum of the times",
        columns=list(names),
        published=[total(captures[name].published) for name in names],
        per_seed=[list(seed) for seed in zip(*each, strict=True)],
    )
