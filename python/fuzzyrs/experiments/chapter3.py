"""Chapter 3: a robot that follows a wall, and IGBFLC.

The thesis doesn't say what its wall was, nor how the robot sensed it, nor the time step; figures
and errors can't be compared in numbers. The walls here are ours (`fz.Wall`), chosen so that errors
stay within the axes of Figures 3.8 to 3.13. What can be compared is each claim.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

import fuzzyrs._fuzzyrs as native
from fuzzyrs._fuzzyrs import PD, Control, FuzzyRegulator, Wall, WallFollowing, WallRun
from fuzzyrs.experiments.experiment import Experiment, published
from fuzzyrs.experiments.figures import (
    by_panel,
    head,
    legend_below,
    panels,
    times_of,
    wall_distance,
)
from fuzzyrs.experiments.result import Result, Row, Value
from fuzzyrs.experiments.trained import once
from fuzzyrs.experiments.verdict import judge_claim, judge_exact, unchecked
from fuzzyrs.recording import Recording

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WALLS = {"poly": Wall.poly, "jog": Wall.jog, "sin": Wall.sin}

#: The distance from the wall that is wanted [m].
WANTED = 1.0

#: The expert, section 3.4.
EXPERT = PD(1.2, 1.5)


@dataclass(frozen=True)
class WallConfig:
    """Runs along walls: 600 s as in Figures 3.8 to 3.13; the rest is ours."""

    #: Of the simulation [s].
    time_step: float = 0.1
    #: Of each run [s].
    duration: float = 600.0
    #: First distance from the wall [m]: 0.45 m too far, as the figures' axes go to -0.5 m.
    first_distance: float = 1.45

    def plant(self, wall: str) -> WallFollowing:
        """Return the robot along one of our walls."""
        return WallFollowing(WALLS[wall](), time_step=self.time_step)

    def play(self, wall: str, regulator: Any) -> WallRun:
        """Follow a wall."""
        start = (0.0, self.first_distance)
        return self.plant(wall).play(regulator, start=start, duration=self.duration)

    def record(self, wall: str, regulator: Any, label: str, panel: str) -> Recording:
        """Return a run along a wall as figures and animations show it, a pose each second."""
        run = self.play(wall, regulator)
        game = Recording.of(run, label=label, panel=panel, wall=WALLS[wall]().points)
        return game.thinned(max(1, round(1.0 / self.time_step)))

    def training(self, **settings: Any) -> native.WallIgbflcTraining:
        """Return IGBFLC with these runs."""
        start = (0.0, self.first_distance)
        return native.WallIgbflcTraining(start=start, duration=self.duration, **settings)


def ratios(run: WallRun, expert: WallRun) -> tuple[Value, Value]:
    """Return the integral of the absolute error and the mean squared one over the expert's.

    None for both if the robot was lost.
    """
    if run.lost:
        return None, None
    own, others = run.measures(), expert.measures()
    return own["iae"] / others["iae"], own["mse"] / others["mse"]


class WallExperiment(Experiment):
    """An experiment along walls."""

    missing: ClassVar[str] = "the robot was lost"
    settings: WallConfig

    def __init__(self, config: WallConfig | None = None) -> None:
        self.settings = config or WallConfig()

    def config(self) -> dict[str, Any]:
        """Return what is simulated."""
        return asdict(self.settings)


#: Less overshoot than this is none [%].
NO_OVERSHOOT = 0.01


@dataclass(frozen=True)
class StepConfig(WallConfig):
    """Steps of section 3.4."""

    #: The chosen gains, and others around them; those are ours.
    gains: tuple[tuple[float, float], ...] = (
        (1.2, 1.5),
        (1.2, 1.0),
        (1.2, 2.0),
        (0.6, 1.5),
        (2.0, 1.5),
    )
    #: Size of the step [m]; ours, small enough that the steering limit plays no part.
    step: float = 0.1
    #: Time shown [s], as in the figure.
    shown: float = 10.0


class Figure36(WallExperiment):
    """Figure 3.6: step responses of PD controllers."""

    id: ClassVar[str] = "figure-3-6"
    cost: ClassVar[float] = 0.001
    title: ClassVar[str] = "step response of PD controllers along a straight wall"
    claim: ClassVar[str] = "kp = 1.2 and kd = 1.5 give a fast response without overshoot."
    source: ClassVar[str] = "Figure 3.6, section 3.4"
    page: ClassVar[str] = "about p. 50"
    expected: ClassVar[str] = (
        f"No overshoot (less than {NO_OVERSHOOT:g} %), and no others faster without one."
    )
    values: ClassVar[str] = "time to 95 % in seconds, overshoot in per cent"
    default_seeds: ClassVar[int] = 1
    quick_seeds: ClassVar[int] = 1

    settings: StepConfig

    def __init__(self, config: StepConfig | None = None) -> None:
        super().__init__(config or StepConfig())

    def _response(self, gains: tuple[float, float]) -> tuple[np.ndarray[Any, Any], WallRun]:
        """Return the way covered as a share of the step, and the run."""
        plant = WallFollowing(Wall.straight(), time_step=self.settings.time_step)
        run = plant.play(
            PD(*gains), start=(0.0, 1.0 - self.settings.step), duration=self.settings.shown
        )
        return 1.0 - run.error / self.settings.step, run

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Measure every response; no chance is involved."""
        del seed, control
        outcome: dict[str, Any] = {"seconds": {}, "responses": [], "curves": []}
        for gains in self.settings.gains:
            response, run = self._response(gains)
            near = np.flatnonzero(np.abs(response - 1.0) > 0.05)[-1] + 1
            time = float(run.time[near]) if near < len(response) else None
            outcome["responses"].append([time, 100.0 * max(float(response.max()) - 1.0, 0.0)])
            outcome["curves"].append(response.round(4).tolist())
        return outcome

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out one row for each pair of gains."""
        responses = outcomes[0]["responses"]
        rows = [
            Row(
                name=f"kp {kp:g}, kd {kd:g}",
                columns=["to 95 %", "overshoot"],
                published=[None, None],
                per_seed=[outcome["responses"][index] for outcome in outcomes],
                digits=2,
            )
            for index, (kp, kd) in enumerate(self.settings.gains)
        ]
        (time, overshoot), *others = responses
        none = NO_OVERSHOOT
        faster = [t for t, over in others if over < none and t is not None and t < time]
        reason = f"overshoot {overshoot:.2f} %; faster without overshoot: {len(faster)} of 4 others"
        chosen = judge_claim(rows[0], held=overshoot < none and not faster, reason=reason)
        return [chosen, *(unchecked(row, "shown beside the choice") for row in rows[1:])]

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the responses."""
        figure, (axes,) = panels([f"step of {self.settings.step:g} m"], height=2.6)
        for (kp, kd), curve in zip(self.settings.gains, result.outcomes[0]["curves"], strict=True):
            times = self.settings.time_step * np.arange(len(curve))
            axes.plot(times, curve, label=f"$k_p$ = {kp:g}, $k_d$ = {kd:g}")
        axes.set(xlabel="time [s]", ylabel="share of the step", xlim=(0, self.settings.shown))
        axes.legend(loc="lower right")
        yield self.id, figure


class Table31(WallExperiment):
    """Table 3.1: the decision table that the rules begin with."""

    id: ClassVar[str] = "table-3-1"
    cost: ClassVar[float] = 0.001
    title: ClassVar[str] = "fuzzy decision table, terms from -2 (HN) to 2 (HP)"
    claim: ClassVar[str] = "The concluded term is the sum of the inputs' terms."
    source: ClassVar[str] = "Table 3.1, section 3.2.3"
    page: ClassVar[str] = "about p. 45"
    expected: ClassVar[str] = "Every legible cell is equal."
    values: ClassVar[str] = "numbers of terms"
    default_seeds: ClassVar[int] = 1
    quick_seeds: ClassVar[int] = 1

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Read the table off the shipped controller's rules."""
        del seed, control
        terms = ["HN", "LN", "Z", "LP", "HP"]
        system = FuzzyRegulator.thesis().system
        assert isinstance(system, native.System)
        concluded = [terms.index(str(rule).rsplit(" ", 1)[1]) - 2 for rule in system.rules]
        table = [[float(n) for n in concluded[5 * row : 5 * row + 5]] for row in range(5)]
        return {"seconds": {}, "table": table}

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out a row for each term of the error; what the scan lost isn't compared."""
        printed = published(self.id)
        rows = []
        for index, name in enumerate(printed["rows"]):
            legible = printed["values"][index]
            ours = [outcome["table"][index] for outcome in outcomes]
            row = Row(name, printed["columns"], legible, ours, digits=0)
            kept = [
                [None if cell is None else value for value, cell in zip(own, legible, strict=True)]
                for own in ours
            ]
            judged = judge_exact(replace(row, per_seed=kept))
            rows.append(replace(row, verdict=judged.verdict, reason=judged.reason))
        return rows


@dataclass(frozen=True)
class TunedConfig(WallConfig):
    """The tuned controller of section 3.5."""

    #: Where the robot starts [m from the wall]; ours.
    starts: tuple[float, ...] = (1.0, 1.2, 1.45)


class Table32(WallExperiment):
    """Tables 3.2 to 3.5: the thesis's own controller at work."""

    id: ClassVar[str] = "table-3-2"
    cost: ClassVar[float] = 0.1
    title: ClassVar[str] = "the thesis's tuned controller along our walls, relative to its expert"
    claim: ClassVar[str] = "The tuned controller performs better than the PD controller."
    source: ClassVar[str] = "Tables 3.2 to 3.6, section 3.5"
    page: ClassVar[str] = "about pp. 57-58"
    expected: ClassVar[str] = (
        "The printed terms and factors exactly; both errors below the expert's from every start."
    )
    includes: ClassVar[tuple[str, ...]] = ("table-3-3", "table-3-4", "table-3-5")
    values: ClassVar[str] = "errors over the expert's"
    default_seeds: ClassVar[int] = 1
    quick_seeds: ClassVar[int] = 1

    settings: TunedConfig
    #: 25 rules; 14 as the first reading of Table 3.6; true jumps; the minimum as operator.
    readings: ClassVar[tuple[str, ...]] = ("25 rules", "14 rules", "25 rules, minimum")

    def __init__(self, config: TunedConfig | None = None) -> None:
        super().__init__(config or TunedConfig())

    def _controller(self, name: str) -> FuzzyRegulator:
        if name == "14 rules":
            return FuzzyRegulator.thesis_pruned()
        thesis = FuzzyRegulator.thesis()
        if name == "25 rules":
            return thesis
        return FuzzyRegulator.from_json(thesis.to_json().replace('"product"', '"min"'))

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Read the controller's numbers, and drive along every wall; no chance is involved, so once
        does for all seeds.
        """
        del seed, control
        return once([self.id, self.config()], self._at_work)

    def _at_work(self) -> dict[str, Any]:
        """Return the numbers, and how every reading compares with the expert."""
        thesis = FuzzyRegulator.thesis()
        gains = [thesis.error_gain, thesis.rate_gain, thesis.output_gain]
        outcome: dict[str, Any] = {"seconds": {}, "gains": gains, "terms": _terms_of(thesis)}
        for name in self.readings:
            tuned = self._controller(name)
            outcome[name] = {}
            for wall in WALLS:
                pairs = []
                for start in self.settings.starts:
                    settings = replace(self.settings, first_distance=start)
                    pairs.append(ratios(settings.play(wall, tuned), settings.play(wall, EXPERT)))
                outcome[name][wall] = [value for pair in pairs for value in pair]
        return outcome

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the controller beside the print, and IAE and MSE for each start."""
        return [*self._printed(outcomes), *self._driven(outcomes)]

    def _printed(self, outcomes: Sequence[dict[str, Any]]) -> Iterator[Row]:
        """Lay out the terms and the scaling factors, whose print is legible."""
        corners = published(self.id)["columns"]
        for table, variable in zip(
            (self.id, *self.includes[:2]), outcomes[0]["terms"], strict=True
        ):
            printed = published(table)["values"]
            for index, (term, _) in enumerate(outcomes[0]["terms"][variable].items()):
                ours = [outcome["terms"][variable][term] for outcome in outcomes]
                row = Row(f"{variable} is {term}", corners, printed[index], ours, digits=4)
                yield judge_exact(row)
        factors = published(self.includes[-1])
        ours = [outcome["gains"] for outcome in outcomes]
        row = Row("scaling factors", factors["columns"], factors["values"], ours, digits=4)
        yield judge_exact(row)

    def _driven(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        columns = [f"{m} from {y:g} m" for y in self.settings.starts for m in ("IAE", "MSE")]
        rows = []
        for name in self.readings:
            for wall in WALLS:
                ours = [outcome[name][wall] for outcome in outcomes]
                row = Row(f"{name}, {wall}", columns, [None] * len(columns), ours, digits=2)
                if name == "25 rules, minimum":
                    rows.append(unchecked(row, "another reading of the operators, for comparison"))
                    continue
                values = [value for value in ours[0] if value is not None]
                held = len(values) == len(columns) and max(values) < 1.0
                reason = f"at most {max(values, default=math.nan):.2f} of the expert's"
                rows.append(judge_claim(row, held=held, reason=reason))
        return rows

    def games(
        self, outcomes: Sequence[dict[str, Any]], seeds: Sequence[int]
    ) -> Iterator[Recording]:
        """Drive along every wall from the farthest start."""
        del outcomes, seeds
        settings = replace(self.settings, first_distance=self.settings.starts[-1])
        for wall in WALLS:
            yield settings.record(wall, EXPERT, "PD", wall)
            for name in self.readings[:2]:
                yield settings.record(wall, self._controller(name), name, wall)

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the terms of the controller and the errors along the walls."""
        yield f"{self.id}-terms", _draw_terms(result.outcomes[0]["terms"])
        yield f"{self.id}-errors", draw_errors(result.games, self.title)


#: Corners of each term of each variable.
Terms = dict[str, dict[str, list[float]]]


def _terms_of(regulator: FuzzyRegulator) -> Terms:
    """Return the corners of all terms, of the inputs and of the output."""
    system = regulator.system
    assert isinstance(system, native.System)
    variables = [*system.inputs, *(output.variable for output in system.outputs)]
    return {
        variable.name: {
            name: list(term.parameters.values()) for name, term in variable.terms.items()
        }
        for variable in variables
        if variable is not None
    }


def _draw_terms(terms: Terms) -> Figure:
    """Draw the terms of each variable."""
    figure, axes = panels(list(terms), columns=3, height=2.2, sharey=True)
    for cell, each in zip(axes, terms.values(), strict=True):
        for name, corners in each.items():
            cell.plot(corners, [0, 1, 1, 0], label=name)
        cell.set(xlabel="scaled value", ylim=(0, 1.05))
    axes[0].set_ylabel("degree")
    head(figure, "The tuned controller's terms (Tables 3.2 to 3.4)")
    legend_below(figure, columns=5)
    return figure


def draw_errors(games: Sequence[Recording], title: str, *, columns: int = 1) -> Figure:
    """Draw the errors of runs along walls over time, a panel for what is driven along."""
    shown = by_panel(games)
    from matplotlib.ticker import NullLocator

    figure, axes = panels(
        list(shown), columns=columns, height=1.7, wide=True, sharex=True, sharey=True
    )
    for cell, each in zip(axes, shown.values(), strict=True):
        for game in each:
            cell.plot(times_of(game), WANTED - wall_distance(game), label=game.label, linewidth=0.8)
        cell.axhline(0.0, color="0.8", linewidth=0.5, zorder=0)
        # Linear up to some centimetres, where the runs differ; the first error is far beyond.
        cell.set_yscale("symlog", linthresh=0.02, linscale=2)
        cell.yaxis.set_major_formatter("{x:g}")
        cell.set(ylim=(-0.6, 0.6), yticks=[-0.5, -0.1, -0.02, 0, 0.02, 0.1, 0.5])
        cell.yaxis.set_minor_locator(NullLocator())
    for cell in axes[-columns:]:
        cell.set_xlabel("time [s]")
    for cell in axes[::columns]:
        cell.set_ylabel("error [m]")
    head(figure, title)
    legend_below(figure)
    return figure


EXPERIMENTS: tuple[type[Experiment], ...] = (Figure36, Table31, Table32)
