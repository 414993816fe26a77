"""Chapter 5: model-building Q-learning with eligibility traces, and what its theorems claim.

The thesis proves and shows no numbers: no process, no run, no figure. Everything here is ours,
on random processes (Garnet) and on a textbook's gridworld whose optimum is known. What can be
judged is each claim. `docs/chapter-5.md` tells what was found.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar

from fuzzyrs.experiments.experiment import Experiment
from fuzzyrs.experiments.figures import draw_curve, legend_below, panels, seeds_of
from fuzzyrs.experiments.result import Result, Row, infinite
from fuzzyrs.experiments.statistics import share_fits
from fuzzyrs.experiments.tabular import (
    EXACT,
    LEARNERS,
    MODEL,
    MORE_LEARNERS,
    NAIVE,
    ONE_STEP,
    RANDOM,
    Case,
    Options,
    TabularExperiment,
    median,
    nearer,
)
from fuzzyrs.experiments.verdict import judge_claim, unchecked
from fuzzyrs.plot import COLOURS

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Convergence(TabularExperiment):
    """How fast learners approach the optimum."""

    claim: ClassVar[str] = (
        "Model-building Q(λ) converges to Q*; the proof carries over to model-free Q(λ)."
    )

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the errors by steps; each learner's beside the claim about it."""
        rows = []
        for name, case in self.cases.items():
            row = self._errors(name, outcomes)
            if name.startswith(NAIVE):
                near, count = self._near(row), len(row.per_seed)
                reason = (
                    f"model-free traces without a cut come near on {near} of {count} seeds in "
                    "these steps: the proof does not carry over, their TD errors are other pairs'"
                )
                held = share_fits(near, count, least=0.95)
                judged = judge_claim(row, held=held, reason=reason, chance=True)
                rows.append(replace(judged, digits=0))
            elif name.startswith("model") and case.process == RANDOM:
                rows.append(self._judge_convergence(row, self._against_one_step(name, outcomes)))
            else:
                other = "for comparison" if case.process == RANDOM else "no expectation was set"
                rows.append(unchecked(row, other))
        return rows

    def _against_one_step(self, name: str, outcomes: Sequence[dict[str, Any]]) -> str:
        """Tell how often a learner ends nearer than one-step Q-learning."""
        other = name.replace(name.split(" on ")[0], ONE_STEP)
        if other not in self.cases:
            return ""
        count = nearer(name, other, outcomes)
        return f"; nearer than one-step Q-learning at the end on {count} of {len(outcomes)}"


class Figure51(Convergence):
    """Error by steps of every learner on random processes."""

    id: ClassVar[str] = "figure-5-1"
    cost: ClassVar[float] = 0.1
    title: ClassVar[str] = "relative error by steps on random processes"
    page: ClassVar[str] = "pp. 76-86"
    cases: ClassVar[Mapping[str, Case]] = {name: Case(how) for name, how in LEARNERS.items()}
    curves: ClassVar[bool] = True
    #: Where the axis ends.
    top: ClassVar[float] = 3.0

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the medians by steps, with the range over the seeds of some."""
        figure = _draw_medians(self, result, shaded={ONE_STEP, MODEL, EXACT})
        figure.axes[0].set_ylim(None, self.top)
        figure.axes[0].set_title(
            f"medians of {seeds_of(len(result.seeds))}, shaded from least to largest;\n"
            f"naive Q(λ) leaves the axis, which ends at {self.top:g}"
        )
        yield self.id, figure


class Table51(Convergence):
    """Error by steps on three kinds of processes."""

    id: ClassVar[str] = "table-5-1"
    cost: ClassVar[float] = 0.26
    title: ClassVar[str] = "relative error after some steps, on three kinds of processes"
    page: ClassVar[str] = "pp. 76-86"
    cases: ClassVar[Mapping[str, Case]] = {
        f"{name} on {process}": Case(how, process)
        for process in (RANDOM, "garnet 50x5x5", "grid 5x5")
        for name, how in LEARNERS.items()
    } | {f"{name} on {RANDOM}": Case(how) for name, how in MORE_LEARNERS.items()}


class Figure52(TabularExperiment):
    """The bound at every step."""

    id: ClassVar[str] = "figure-5-2"
    cost: ClassVar[float] = 0.001
    title: ClassVar[str] = "the largest |Q| and the bound M(1 + γ + … + γᵗ)"
    claim: ClassVar[str] = "Q stays below the bound of (5.5), for all pairs and at all times."
    source: ClassVar[str] = "Theorem 5.1, section 5.3; no numbers are printed, these are ours"
    page: ClassVar[str] = "pp. 78-81"
    expected: ClassVar[str] = "No value beyond the bound at any step, on every seed."
    values: ClassVar[str] = "largest |Q| over the bound of its time, and steps beyond it"
    cases: ClassVar[Mapping[str, Case]] = {
        name: Case(LEARNERS[name]) for name in (MODEL, EXACT, "Watkins Q(0.9)", NAIVE)
    }
    curves: ClassVar[bool] = True

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out how near the values came to the bound."""
        rows = []
        for name in self.cases:
            found = [outcome[name] for outcome in outcomes]
            row = Row(
                name=name,
                columns=["largest |Q| / bound", "steps beyond"],
                published=[None, None],
                per_seed=[[f["closest"]["used"], float(f["violations"]["used"])] for f in found],
                digits=2,
            )
            rows.append(judge_bound(name, row, column=1))
        return rows

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the largest |Q| of the first seed beside the bound."""
        steps, found = self.steps, result.outcomes[0]
        figure, (axes,) = panels([f"{RANDOM} (seed {result.seeds[0]})"], height=3.6)
        for name in self.cases:
            axes.plot(steps, list(map(infinite, found[name]["largest"])), label=name)
        bounds = [infinite(value) for value in found[MODEL]["bounds"]]
        axes.plot(steps, bounds, "k-", linewidth=2, label="bound of model building")
        optimum = found[MODEL]["optimum"]
        axes.axhline(optimum, color="0.6", linewidth=0.8, linestyle="-", label="largest |Q*|")
        axes.set(xscale="log", yscale="log", xlabel="steps", ylabel="largest |Q|")
        legend_below(figure, columns=2)
        yield self.id, figure


def judge_bound(name: str, row: Row, column: int) -> Row:
    """Judge whether a learner stays within the bound, which a column counts the breaks of."""
    count = len(row.per_seed)
    kept = sum(values[column] == 0 for values in row.per_seed)
    reason = f"within the bound at every step on {kept} of {count} seeds"
    if name.startswith("model"):
        return judge_claim(row, held=kept == count, reason=reason, chance=True)
    if name.startswith(NAIVE):
        more = "; the remark after Theorem 5.3 extends the analysis to these traces"
        return judge_claim(row, held=kept == count, reason=reason + more, chance=True)
    return unchecked(row, f"{reason}; the theorem is about model building")


#: First values, and the noise of rewards, that tell the readings of M apart.
CONDITIONS: dict[str, tuple[Options, float | None]] = {
    "Q0 = 0": ({}, None),
    "Q0 = -5": ({"first_values": (-5.0, -5.0)}, None),
    "Q0 in [-5, 5]": ({"first_values": (-5.0, 5.0)}, None),
    "noise 3": ({}, 3.0),
}


class Table52(TabularExperiment):
    """Breaks of the bound in three readings of M."""

    id: ClassVar[str] = "table-5-2"
    cost: ClassVar[float] = 0.24
    title: ClassVar[str] = "steps after which a value is beyond the bound, by reading of M"
    claim: ClassVar[str] = "Q stays below the bound of (5.5), with M as in (5.7) and (5.8)."
    source: ClassVar[str] = "Theorem 5.1, section 5.3; no numbers are printed, these are ours"
    page: ClassVar[str] = "pp. 78-81"
    expected: ClassVar[str] = "No value beyond the bound at any step, on every seed."
    values: ClassVar[str] = "steps beyond the bound, of 30 000"
    cases: ClassVar[Mapping[str, Case]] = {
        f"{name}; {what}": Case({**LEARNERS[name], **changes}, noise=noise)
        for name in (MODEL, EXACT, ONE_STEP, "Watkins Q(0.9)", NAIVE)
        for what, (changes, noise) in CONDITIONS.items()
    }
    readings: ClassVar[Mapping[str, str]] = {
        "used": "sup of means, |Q0|",
        "printed": "Q0 without bars",
        "true_means": "true means",
    }

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the breaks by the reading of M."""
        rows = []
        for name in self.cases:
            broken = [outcome[name]["violations"] for outcome in outcomes]
            row = Row(
                name=name,
                columns=list(self.readings.values()),
                published=[None] * len(self.readings),
                per_seed=[[float(b[reading]) for reading in self.readings] for b in broken],
                digits=0,
            )
            judged = judge_bound(name, row, column=0)
            others = ", ".join(
                f"{what} broken on {sum(b[reading] > 0 for b in broken)}"
                for reading, what in list(self.readings.items())[1:]
            )
            rows.append(replace(judged, reason=f"{judged.reason}; {others}"))
        return rows


class Schedules(TabularExperiment):
    """Model building under several learning rates."""

    #: What a case shows: whether it should converge, None for no expectation, and why.
    theory: ClassVar[Mapping[str, tuple[bool | None, str]]]

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the errors by steps."""
        rows = []
        for name in self.cases:
            row = self._errors(name, outcomes)
            converges, why = self.theory[name]
            near, count = self._near(row), len(row.per_seed)
            reason = f"near on {near} of {count} seeds; {why}"
            if converges is None:
                rows.append(unchecked(row, reason))
            else:
                held = share_fits(near, count, least=0.95)
                rows.append(judge_claim(row, held=held, reason=reason, chance=True))
        return rows


def _rate(decay: float, rate: float = 1.0, per: str = "visit") -> Case:
    options = {"learning_rate": rate, "learning_rate_decay": decay, "per": per}
    return Case({**LEARNERS[MODEL], **options})


class Figure53(Schedules):
    """Learning-rate schedules."""

    id: ClassVar[str] = "figure-5-3"
    cost: ClassVar[float] = 0.31
    title: ClassVar[str] = "relative error by steps under nine learning rates"
    claim: ClassVar[str] = "It converges if the rates sum to infinity and their squares do not."
    source: ClassVar[str] = "Theorem 5.3, section 5.4; no numbers are printed, these are ours"
    page: ClassVar[str] = "pp. 82-86"
    curves: ClassVar[bool] = True
    #: n counts visits of a pair, t steps, i episodes of 1000 steps.
    cases: ClassVar[Mapping[str, Case]] = {
        "n^-0.51": _rate(0.51),
        "n^-0.7": _rate(0.7),
        "n^-1": _rate(1.0),
        "n^-2": _rate(2.0),
        "constant 0.1": _rate(0.0, 0.1),
        "constant 1": _rate(0.0),
        "i^-0.7": _rate(0.7, per="episode"),
        "t^-0.7": _rate(0.7, per="step"),
        "t^-1": _rate(1.0, per="step"),
    }
    theory: ClassVar[Mapping[str, tuple[bool | None, str]]] = {
        "n^-0.51": (True, "both sums are as the theorem asks"),
        "n^-0.7": (True, "both sums are as the theorem asks"),
        "n^-1": (None, "both sums are as the theorem asks, but it is slow"),
        "n^-2": (None, "the rates sum to a finite number, so values stop short"),
        "constant 0.1": (None, "the squares sum to infinity: that does no harm"),
        "constant 1": (None, "the squares sum to infinity: that does no harm"),
        "i^-0.7": (None, "in 30 episodes"),
        "t^-0.7": (None, "both sums are as the theorem asks, but it is too slow to see"),
        "t^-1": (None, "both sums are as the theorem asks, but it is too slow to see"),
    }

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the medians by steps."""
        yield self.id, _draw_medians(self, result)


class Figure54(TabularExperiment):
    """The counts as printed, and exact ones."""

    id: ClassVar[str] = "figure-5-4"
    cost: ClassVar[float] = 0.078
    title: ClassVar[str] = "relative error by steps with the counts as printed and exact"
    page: ClassVar[str] = "pp. 76-77"
    claim: ClassVar[str] = "Steps 4 to 7 estimate the mean reward and the probabilities."
    curves: ClassVar[bool] = True
    cases: ClassVar[Mapping[str, Case]] = {
        f"λ {decay:g}, {counts}": Case({"trace_decay": decay, "counts": counts})
        for decay in (0.0, 0.3, 0.9)
        for counts in ("thesis", "exact")
    }

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the errors by steps."""
        rows = []
        for name in self.cases:
            row = self._errors(name, outcomes)
            if name.endswith("thesis"):
                exact = name.replace("thesis", "exact")
                ahead = nearer(exact, name, outcomes)
                reason = f"; exact counts end nearer on {ahead} of {len(outcomes)}"
                rows.append(self._judge_convergence(row, reason))
            else:
                rows.append(unchecked(row, "for comparison"))
        return rows

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the medians by steps."""
        yield self.id, _draw_medians(self, result)


def _draw_medians(
    experiment: TabularExperiment, result: Result, shaded: Collection[str] = ()
) -> Figure:
    """Draw the medians of all cases by steps, and the ranges of some."""
    figure, (axes,) = panels([f"medians of {seeds_of(len(result.seeds))}"], height=3.8)
    for index, name in enumerate(experiment.cases):
        each = zip(*(outcome[name]["errors"] for outcome in result.outcomes), strict=True)
        columns = [list(map(infinite, values)) for values in each]
        band: Any = (list(map(min, columns)), list(map(max, columns))) if name in shaded else ()
        # Beyond the colours, a marker tells curves apart.
        style: Any = {"label": name, "marker": "o" if index >= len(COLOURS) else ""}
        draw_curve(axes, experiment.steps, [median(c) for c in columns], *band, **style)
    axes.set(xscale="log", yscale="log", xlabel="steps", ylabel="max |Q - Q*| / max |Q*|")
    legend_below(figure, columns=2)
    return figure


class Table53(Schedules):
    """The conditions of Theorem 5.3, one by one."""

    id: ClassVar[str] = "table-5-3"
    cost: ClassVar[float] = 0.032
    title: ClassVar[str] = "relative error with and without the conditions of Theorem 5.3"
    claim: ClassVar[str] = (
        "It converges if the process is finite, the rates sum to infinity and their squares do "
        "not, and rewards have a finite variance."
    )
    source: ClassVar[str] = "Theorem 5.3, section 5.4; no numbers are printed, these are ours"
    page: ClassVar[str] = "pp. 82-86"
    cases: ClassVar[Mapping[str, Case]] = {
        "all hold, every pair is visited": _rate(0.7),
        "all hold, greedy": Case({**LEARNERS[MODEL], "exploration": 0.0}),
        "all hold, greedy, exact": Case({**LEARNERS[EXACT], "exploration": 0.0}),
        "rates sum to a finite number": _rate(2.0),
        "squares sum to infinity": _rate(0.0, 0.1),
    }
    theory: ClassVar[Mapping[str, tuple[bool | None, str]]] = {
        "all hold, every pair is visited": (True, "as the theorem says"),
        "all hold, greedy": (True, "the theorem lacks a condition: infinite visits of every pair"),
        "all hold, greedy, exact": (True, "the same with exact counts"),
        "rates sum to a finite number": (None, "the condition is needed"),
        "squares sum to infinity": (None, "the condition is not needed here"),
    }


EXPERIMENTS: tuple[type[Experiment], ...] = (
    Figure51,
    Figure52,
    Figure53,
    Figure54,
    Table51,
    Table52,
    Table53,
)
