"""Chapter 4's printed settings: the decision tables and the genetic search."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from fuzzyrs._fuzzyrs import TSK, Control, FuzzyController, IgbflcTraining, Variable
from fuzzyrs.experiments.chapter4 import TERMS, TRAINED, PursuitConfig
from fuzzyrs.experiments.experiment import Experiment, published
from fuzzyrs.experiments.figures import draw_controller
from fuzzyrs.experiments.printed_settings import PrintedSettings, judge_settings
from fuzzyrs.experiments.result import Result, Row, Value
from fuzzyrs.experiments.tuned import controller_of
from fuzzyrs.experiments.verdict import unchecked

if TYPE_CHECKING:
    from matplotlib.figure import Figure


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


EXPERIMENTS: tuple[type[Experiment], ...] = (Table41, Table42, Table43)
