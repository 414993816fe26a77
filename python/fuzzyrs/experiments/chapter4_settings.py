"""Chapter 4's settings: the expert's gains, the decision tables and the genetic search."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from fuzzyrs._fuzzyrs import (
    PD,
    TSK,
    Control,
    FuzzyController,
    IgbflcTraining,
    OneOnOne,
    Variable,
    Vehicle,
)
from fuzzyrs.experiments.chapter4 import TERMS, TRAINED, PursuitConfig, Start
from fuzzyrs.experiments.experiment import Experiment, published
from fuzzyrs.experiments.figures import draw_controller, panels
from fuzzyrs.experiments.printed_settings import PrintedSettings, judge_settings
from fuzzyrs.experiments.result import Result, Row, Value
from fuzzyrs.experiments.tuned import controller_of
from fuzzyrs.experiments.verdict import judge_claim, unchecked

if TYPE_CHECKING:
    from matplotlib.figure import Figure


#: Less overshoot than this is none [%].
NO_OVERSHOOT = 0.01


@dataclass(frozen=True)
class TurnConfig:
    """Turns of section 4.5."""

    pursuit: PursuitConfig = field(default_factory=PursuitConfig)
    #: The printed gains, and others around them; those are ours.
    gains: tuple[Start, ...] = ((0.99, 0.02), (0.5, 0.02), (2.0, 0.02), (0.99, 0.5))
    #: The angle to turn by [rad]; ours, within the steering limit.
    angle: float = 0.5
    #: Time shown [s].
    shown: float = 12.0

    def to_dict(self) -> dict[str, Any]:
        """Return the pursuer, the gains and the turn as plain values."""
        return {
            "pursuer": self.pursuit.game.pursuer.to_dict(),
            "gains": [list(pair) for pair in self.gains],
            "angle": self.angle,
            "shown": self.shown,
        }


class Figure45(Experiment):
    """Figure 4.5: how PD controllers turn to a target far away."""

    id: ClassVar[str] = "figure-4-5"
    cost: ClassVar[float] = 0.001
    title: ClassVar[str] = "step response of PD controllers turning to a far target"
    claim: ClassVar[str] = "kp = 0.99 and kd = 0.02 give a fast response without overshoot."
    source: ClassVar[str] = "Figure 4.5, section 4.5"
    page: ClassVar[str] = "about p. 67"
    expected: ClassVar[str] = f"No overshoot (less than {NO_OVERSHOOT:g} %) of the chosen gains."
    values: ClassVar[str] = "time to 95 % in seconds, overshoot in per cent"
    default_seeds: ClassVar[int] = 1
    quick_seeds: ClassVar[int] = 1

    def __init__(self, config: TurnConfig | None = None) -> None:
        self.settings = config or TurnConfig()

    def config(self) -> dict[str, Any]:
        """Return the pursuer, the gains and the turn."""
        return self.settings.to_dict()

    def _response(self, gains: Start) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
        """Return the times and the share of the turn that is done."""
        target = Vehicle(0.0, 1.0, 1.0)
        game = OneOnOne(self.settings.pursuit.game.pursuer, target)
        far = (1e6 * math.cos(self.settings.angle), 1e6 * math.sin(self.settings.angle))
        path = game.play(PD(*gains), evader_start=far, max_time=self.settings.shown)
        return path.time, path.pursuer[:, 2] / self.settings.angle

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Measure every response; no chance is involved."""
        del seed, control
        measured, curves = [], []
        for gains in self.settings.gains:
            time, done = self._response(gains)
            there = np.flatnonzero(np.abs(done - 1) > 0.05)[-1] + 1
            settled = float(time[there]) if there < len(time) else None
            measured.append([settled, 100 * max(0.0, float(done.max()) - 1)])
            curves.append(done.round(4).tolist())
        return {"measured": measured, "curves": curves, "seconds": {}}

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the time to 95 % and the overshoot of each."""
        rows = []
        for index, gains in enumerate(self.settings.gains):
            row = Row(
                name=f"kp = {gains[0]:g}, kd = {gains[1]:g}",
                columns=["time to 95 %", "overshoot"],
                published=[None, None],
                per_seed=[outcome["measured"][index] for outcome in outcomes],
            )
            if index:
                rows.append(unchecked(row, "for comparison"))
            else:
                overshoot = outcomes[0]["measured"][0][1]
                reason = f"overshoots by {overshoot:.2f} %; the figure is lost in the scan"
                rows.append(judge_claim(row, held=overshoot < NO_OVERSHOOT, reason=reason))
        return rows

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the responses."""
        figure, (axes,) = panels([f"turn by {self.settings.angle:g} rad"], height=2.6)
        step = self.settings.pursuit.game.time_step
        for (kp, kd), curve in zip(self.settings.gains, result.outcomes[0]["curves"], strict=True):
            axes.plot(step * np.arange(len(curve)), curve, label=f"$k_p$ = {kp:g}, $k_d$ = {kd:g}")
        axes.set(xlabel="time [s]", ylabel="share of the turn", xlim=(0, self.settings.shown))
        axes.legend(loc="lower right")
        yield self.id, figure


@dataclass(frozen=True)
class DecisionConfig:
    """A pursuer of 25 rules before learning (section 4.4)."""

    #: By how much a conclusion grows from term to term [rad], Table 4.2.
    step: float = 0.2
    #: Universes of the angle [rad] and of its rate [rad/s]; the thesis's follow from its data.
    angle: tuple[float, float] = (-2.0, 2.0)
    rate: tuple[float, float] = (-3.0, 3.0)

    def inputs(self, shape: Any = "gaussian") -> list[Variable]:
        """Return the angle and its rate, each with five terms."""
        universes = {"angle": self.angle, "rate": self.rate}
        return [Variable.evenly(name, each, TERMS, shape) for name, each in universes.items()]

    def consequents(self) -> list[list[float]]:
        """Return what the rules conclude at first, by the terms of the angle and of the rate."""
        places = range(-2, 3)
        return [[round(self.step * (i + j), 9) for j in places] for i in places]


class DecisionTable(PrintedSettings):
    """A decision table of 25 rules."""

    values: ClassVar[str] = "numbers of rules"

    def __init__(self, config: DecisionConfig | None = None) -> None:
        self.settings = config or DecisionConfig()

    def config(self) -> dict[str, Any]:
        """Return the universes and the step of the conclusions."""
        return asdict(self.settings)

    def table_rows(self, name: str, outcomes: Sequence[dict[str, Any]], digits: int) -> list[Row]:
        """Lay out a table beside the print."""
        return [
            judge_settings(
                Row(
                    name=f"{name} {term}",
                    columns=list(TERMS),
                    published=published(self.id)["values"][index],
                    per_seed=[outcome["table"][index] for outcome in outcomes],
                    digits=digits,
                )
            )
            for index, term in enumerate(TERMS)
        ]


class Table41(DecisionTable):
    """Table 4.1: which rule has which terms."""

    id: ClassVar[str] = "table-4-1"
    cost: ClassVar[float] = 0.001
    title: ClassVar[str] = "decision table: the numbers of the rules"
    claim: ClassVar[str] = "The 25 rules are numbered, those of one term of the angle together."
    source: ClassVar[str] = "Table 4.1, section 4.2.3"
    page: ClassVar[str] = "about p. 64"

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Let each rule conclude its number, and ask where it alone fires."""
        del seed, control
        inputs = self.settings.inputs("triangular")
        system = TSK(inputs, np.arange(1.0, 26.0))
        angles, rates = (np.linspace(*variable.universe, len(TERMS)) for variable in inputs)
        table = [[round(float(system(angle, rate)), 9) for angle in angles] for rate in rates]
        return {"table": table, "seconds": {}}

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the numbers, a row for each term of the rate."""
        return self.table_rows("rate", outcomes, digits=0)


class Table42(DecisionTable):
    """Table 4.2: what the rules conclude before learning."""

    id: ClassVar[str] = "table-4-2"
    cost: ClassVar[float] = 0.001
    title: ClassVar[str] = "decision table before learning"
    claim: ClassVar[str] = (
        "None; least squares replaces these conclusions before anything else is learned."
    )
    source: ClassVar[str] = "Table 4.2, section 4.4"
    page: ClassVar[str] = "about p. 68"
    values: ClassVar[str] = "consequents in radians, by the term of the angle and of its rate"
    missing: ClassVar[str] = "not caught"

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Make the controller, and let it play as it is."""
        del seed, control
        pursuit, table = PursuitConfig(), self.settings.consequents()
        controller = FuzzyController(TSK(self.settings.inputs(), table))
        return {
            "table": table,
            "times": [pursuit.play(controller, start).capture_time for start in TRAINED],
            "controller": json.loads(controller.to_json()),
            "seconds": {},
        }

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the conclusions, and how such a pursuer plays."""
        times = Row(
            name="capture times [s]",
            columns=[f"({x:g},{y:g})" for x, y in TRAINED],
            published=[None] * len(TRAINED),
            per_seed=[outcome["times"] for outcome in outcomes],
        )
        reason = "not printed; the terms' places are ours"
        return [*self.table_rows("angle", outcomes, digits=1), unchecked(times, reason)]

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the terms and the surface."""
        yield self.id, draw_controller(controller_of(result.outcomes[0]).system, self.title)


@dataclass(frozen=True)
class SearchConfig:
    """The genetic search of section 4.4."""

    igbflc: IgbflcTraining = field(default_factory=IgbflcTraining)


class Table43(PrintedSettings):
    """Table 4.3: what the genetic search is set to."""

    id: ClassVar[str] = "table-4-3"
    cost: ClassVar[float] = 0.001
    title: ClassVar[str] = "sizes of IGBFLC's genetic search"
    claim: ClassVar[str] = "None; `IgbflcTraining` has the printed sizes unless told otherwise."
    source: ClassVar[str] = "Table 4.3, section 4.4"
    page: ClassVar[str] = "about p. 68"
    missing: ClassVar[str] = "not a setting"

    def __init__(self, config: SearchConfig | None = None) -> None:
        self.settings = config or SearchConfig()

    def config(self) -> dict[str, Any]:
        """Return the settings of IGBFLC."""
        return {"igbflc": self.settings.igbflc.to_dict()}

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the sizes, and the shares that belong to the printed operators."""
        printed, count = published(self.id), len(outcomes)
        sizes, shares = ["iterations", "population"], ["crossover", "mutation"]
        igbflc = self.settings.igbflc
        ours: list[Value] = [float(igbflc.iterations), float(igbflc.population)]
        reason = (
            "0.40 is the reading of the scan's 0.1? with which half of the population is kept; "
            'operators="averaging" have these shares, the modern ones have others'
        )
        nothing: list[Value] = [None] * len(shares)
        return [
            judge_settings(Row("sizes", sizes, [printed[n] for n in sizes], [ours] * count)),
            unchecked(
                Row("shares", shares, [printed[n] for n in shares], [nothing] * count, digits=2),
                reason,
            ),
        ]


EXPERIMENTS: tuple[type[Experiment], ...] = (Figure45, Table41, Table42, Table43)
