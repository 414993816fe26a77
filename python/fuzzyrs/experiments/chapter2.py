"""Chapter 2: what the other chapters are made of, shown by figures without numbers.

The scan lost the curves; the equations beside them are legible, and the library is compared with
them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

import fuzzyrs._fuzzyrs as native
from fuzzyrs._fuzzyrs import Control
from fuzzyrs.experiments.experiment import Experiment, published
from fuzzyrs.experiments.figures import legend_below, panels
from fuzzyrs.experiments.result import Result, Row
from fuzzyrs.experiments.verdict import judge_claim, judge_exact, unchecked

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Basics(Experiment):
    """Something without chance."""

    values: ClassVar[str] = "degrees"
    default_seeds: ClassVar[int] = 1
    quick_seeds: ClassVar[int] = 1
    settings: Any

    def config(self) -> dict[str, Any]:
        """Return the parameters."""
        return asdict(self.settings)


def _curve(degree: native.MembershipFunction, low: float, high: float) -> dict[str, list[float]]:
    x = np.linspace(low, high, 121)
    return {"x": x.round(6).tolist(), "degree": degree(x).round(6).tolist()}


@dataclass(frozen=True)
class TrapezoidConfig:
    """The corners of (2.1); they are ours, the figure has letters only."""

    a: float = 1.0
    b: float = 2.0
    c: float = 4.0
    d: float = 6.0


class Figure22(Basics):
    """Figure 2.2: a trapezoidal membership function."""

    id: ClassVar[str] = "figure-2-2"
    cost: ClassVar[float] = 0.001
    title: ClassVar[str] = "trapezoidal membership function"
    claim: ClassVar[str] = "It is piecewise linear, as (2.1) says."
    source: ClassVar[str] = "Figure 2.2 and (2.1), section 2.2.1"
    page: ClassVar[str] = "p. 17"
    expected: ClassVar[str] = "Every degree is that of (2.1)."

    def __init__(self, config: TrapezoidConfig | None = None) -> None:
        self.settings = config or TrapezoidConfig()

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Evaluate the function where (2.1) changes, and halfway between."""
        del seed, control
        a, b, c, d = corners = list(asdict(self.settings).values())
        degree = native.trapezoidal(*corners)
        halfway = [(low + high) / 2 for low, high in ((a, b), (b, c), (c, d))]
        places = sorted([a - 1, *corners, *halfway, d + 1])
        return {
            "degrees": degree(places).tolist(),
            "curve": _curve(degree, a - 1, d + 1),
            "seconds": {},
        }

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the degrees beside those of (2.1)."""
        printed = published(self.id)
        degrees = [outcome["degrees"] for outcome in outcomes]
        row = Row("degree", printed["columns"], printed["degrees"], degrees, digits=2)
        return [judge_exact(row)]

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the function."""
        figure, (axes,) = panels([""], height=2.0)
        curve = result.outcomes[0]["curve"]
        axes.plot(curve["x"], curve["degree"])
        corners = [result.config[name] for name in "abcd"]
        axes.set_xticks(corners, list("abcd"))
        axes.set(xlabel="x", ylabel="degree", ylim=(0, 1.05))
        yield self.id, figure


@dataclass(frozen=True)
class GaussianConfig:
    """The parameters of (2.2); they are ours, the figure has letters only."""

    mean: float = 0.0
    deviation: float = 1.0


class Figure23(Basics):
    """Figure 2.3: a Gaussian membership function."""

    id: ClassVar[str] = "figure-2-3"
    cost: ClassVar[float] = 0.001
    title: ClassVar[str] = "Gaussian membership function"
    claim: ClassVar[str] = "It is smooth, and 1 at its mean."
    source: ClassVar[str] = "Figure 2.3 and (2.2), section 2.2.1"
    page: ClassVar[str] = "p. 18"
    expected: ClassVar[str] = (
        "The degree is 1 at the mean, the same on both sides, and falls with the distance."
    )

    #: With the half of the standard deviation, and without, as the thesis's gradients have it.
    forms: ClassVar[dict[str, Any]] = {
        "exp(-(x-m)²/2s²)": native.gaussian,
        "exp(-(x-m)²/s²)": native.gaussian_width,
    }
    #: Where degrees are compared, in deviations from the mean.
    places: ClassVar[tuple[int, ...]] = (-2, -1, 0, 1, 2)

    def __init__(self, config: GaussianConfig | None = None) -> None:
        self.settings = config or GaussianConfig()

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Evaluate both forms."""
        del seed, control
        mean, deviation = self.settings.mean, self.settings.deviation
        outcome: dict[str, Any] = {"seconds": {}}
        for name, form in self.forms.items():
            degree = form(mean, deviation)
            at = [mean + place * deviation for place in self.places]
            outcome[name] = {
                "degrees": degree(at).tolist(),
                **_curve(degree, mean - 3 * deviation, mean + 3 * deviation),
            }
        return outcome

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the degrees; the scan does not tell whether (2.2) has the half."""
        rows = []
        for name in self.forms:
            degrees = [outcome[name]["degrees"] for outcome in outcomes]
            columns = [f"m {place:+d} s" if place else "m" for place in self.places]
            row = Row(name, columns, [None] * len(columns), degrees, digits=4)
            middle = len(columns) // 2
            falling = degrees[0][middle:]
            held = (
                falling[0] == 1.0
                and falling == degrees[0][middle::-1]
                and all(np.diff(falling) < 0)
            )
            reason = "1 at the mean, the same on both sides, falling; the half is hardly legible"
            rows.append(judge_claim(row, held=held, reason=reason))
        return rows

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw both forms."""
        figure, (axes,) = panels([""], height=2.4)
        for name in self.forms:
            axes.plot(result.outcomes[0][name]["x"], result.outcomes[0][name]["degree"], label=name)
        mean, deviation = result.config["mean"], result.config["deviation"]
        axes.set_xticks([mean - deviation, mean, mean + deviation], ["m - s", "m", "m + s"])
        axes.set(xlabel="x", ylabel="degree", ylim=(0, 1.05))
        legend_below(figure)
        yield self.id, figure


@dataclass(frozen=True)
class TraceConfig:
    """When a pair is visited, and how its trace decays; ours, the figure has no numbers."""

    discount: float = 0.9
    trace_decay: float = 0.9
    steps: int = 24
    #: Steps in which the pair is visited.
    visits: tuple[int, ...] = (2, 3, 4, 8, 15, 16)
    #: Steps in which its state is visited with another action.
    others: tuple[int, ...] = (20,)
    #: Of the learner whose values the traces are read from.
    learning_rate: float = 0.01


TraceKind = Literal["replacing", "replacing_state", "accumulating"]

#: What (2.46), (2.47) and the trace that accumulates are called.
TRACES: dict[TraceKind, str] = {
    "replacing": "replacing (2.46)",
    "replacing_state": "replacing, other actions cut (2.47)",
    "accumulating": "accumulating, for comparison",
}


class Figure28(Basics):
    """Figure 2.8: a replacing trace over visits."""

    id: ClassVar[str] = "figure-2-8"
    cost: ClassVar[float] = 0.001
    title: ClassVar[str] = "eligibility trace of a pair over the visits of it"
    claim: ClassVar[str] = "A visit sets the trace to 1, and from there it decays by λγ."
    source: ClassVar[str] = "Figure 2.8, (2.46) and (2.47), section 2.5.2"
    page: ClassVar[str] = "p. 36"
    expected: ClassVar[str] = "The traces are those of (2.46) and (2.47) at every step."
    values: ClassVar[str] = "trace of the pair after the step"

    def __init__(self, config: TraceConfig | None = None) -> None:
        self.settings = config or TraceConfig()

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Read the traces off a learner's values: a step changes them by α, error and trace."""
        del seed, control
        settings = self.settings
        outcome: dict[str, Any] = {"seconds": {}}
        for kind in TRACES:
            agent = native.QLambda(
                2, 2, discount=settings.discount, trace_decay=settings.trace_decay, trace=kind
            )
            traces = []
            for step in range(settings.steps):
                state, action = self._visited(step)
                before = float(agent.values[0, 0])
                error = agent.learn(state, action, 1.0, 1, settings.learning_rate)
                change = float(agent.values[0, 0]) - before
                traces.append(round(change / (settings.learning_rate * error), 6))
            outcome[kind] = traces
        return outcome

    def _visited(self, step: int) -> tuple[int, int]:
        """Return the state and the action of a step; the pair is (0, 0)."""
        if step in self.settings.visits:
            return 0, 0
        return (0, 1) if step in self.settings.others else (1, 0)

    def _traces(self, *, cut: bool) -> list[float]:
        """Return the traces of (2.46), or of (2.47), which cuts those of other actions."""
        decay = self.settings.discount * self.settings.trace_decay
        traces, trace = [], 0.0
        for step in range(self.settings.steps):
            state, action = self._visited(step)
            if state == 0 and (action == 0 or cut):
                trace = 1.0 - action
            else:
                trace *= decay
            traces.append(trace)
        return traces

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the traces where something happens."""
        settings = self.settings
        shown = sorted({*settings.visits, *settings.others, settings.steps - 1})
        rows = []
        for kind, name in TRACES.items():
            row = Row(
                name,
                [f"step {step}" for step in shown],
                [None] * len(shown),
                [[outcome[kind][step] for step in shown] for outcome in outcomes],
                digits=3,
            )
            if kind == "accumulating":
                rows.append(unchecked(row, "for comparison"))
                continue
            expected = self._traces(cut=kind == "replacing_state")
            held = bool(np.allclose(outcomes[0][kind], expected, atol=1e-5))
            reason = f"{'as' if held else 'not as'} the equation says at all {settings.steps} steps"
            rows.append(judge_claim(row, held=held, reason=reason))
        return rows

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the traces over the steps, and mark the visits."""
        figure, (axes,) = panels([""], height=3.0)
        for kind, name in TRACES.items():
            traces = result.outcomes[0][kind]
            axes.step(range(len(traces)), traces, where="post", label=name)
        visits = result.config["visits"]
        axes.plot(visits, [0.0] * len(visits), "k^", clip_on=False, label="visit of the pair")
        others = result.config["others"]
        axes.plot(
            others, [0.0] * len(others), "kv", clip_on=False, fillstyle="none", label="of the state"
        )
        axes.set(xlabel="step", ylabel="trace of the pair", ylim=(0, None))
        legend_below(figure, columns=1)
        yield self.id, figure


EXPERIMENTS: tuple[type[Experiment], ...] = (Figure22, Figure23, Figure28)
