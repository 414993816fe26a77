"""Learners on processes whose optimum is known: what the experiments of chapter 5 share."""

from __future__ import annotations

import math
import statistics
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, ClassVar

from fuzzyrs._fuzzyrs import MDP, Control, MDPTrial, learn_mdp
from fuzzyrs.experiments.experiment import Experiment
from fuzzyrs.experiments.result import Row, Value, infinite
from fuzzyrs.experiments.statistics import share_fits
from fuzzyrs.experiments.trained import once
from fuzzyrs.experiments.verdict import judge_claim

#: What `learn_mdp` takes.
Options = Mapping[str, Any]

#: One-step Q-learning, Watkins's and naive Q(λ), and model building (5.2).
LEARNERS: dict[str, Options] = {
    "one-step Q": {"learner": "q_lambda", "trace_decay": 0.0},
    "Watkins Q(0.9)": {"learner": "q_lambda", "trace_decay": 0.9, "cut": "watkins"},
    "naive Q(0.9)": {"learner": "q_lambda", "trace_decay": 0.9},
    "model, λ 0": {"trace_decay": 0.0},
    "model, λ 0.3": {"trace_decay": 0.3},
    "model, λ 0.9": {"trace_decay": 0.9},
    "model, λ 0.9, exact": {"trace_decay": 0.9, "counts": "exact"},
}
NAIVE, MODEL, EXACT, ONE_STEP = (
    "naive Q(0.9)",
    "model, λ 0.9",
    "model, λ 0.9, exact",
    "one-step Q",
)

#: What tells more: traces as the other chapters have them, and model building with full steps.
MORE_LEARNERS: dict[str, Options] = {
    "one-step Q, γ 0.5": {**LEARNERS[ONE_STEP], "discount": 0.5},
    "naive Q(0.3), γ 0.5": {"learner": "q_lambda", "trace_decay": 0.3, "discount": 0.5},
    "model, λ 0, α 1": {"trace_decay": 0.0, "learning_rate_decay": 0.0},
}

#: An error that is small, and less than this share of the first one.
SMALL, LESS = 0.15, 0.5

RANDOM = "garnet 20x3x5"


@dataclass(frozen=True)
class TabularConfig:
    """Processes and learners; all values are ours, as the chapter has none."""

    discount: float = 0.9
    #: Rewards are spread this far about their means.
    reward_noise: float = 1.0
    #: Of the gridworld: the probability of a random move.
    slip: float = 0.1
    #: α = 1/nᵈᵉᶜᵃʸ at the n-th visit of a pair; 0.7 is the thesis's in other chapters.
    learning_rate_decay: float = 0.7
    #: When values are looked at [steps].
    checkpoints: tuple[int, ...] = (1000, 3000, 10_000, 30_000)
    #: When else for curves [steps].
    curve: tuple[int, ...] = (10, 30, 100, 200, 300, 500, 2000, 5000, 20_000)

    def process(self, name: str, seed: int, noise: float | None = None) -> MDP:
        """Return a process by its name; the seed draws random ones."""
        noise = self.reward_noise if noise is None else noise
        if name == "grid 5x5":
            return MDP.gridworld(slip=self.slip, reward_noise=noise)
        states, actions, branching = map(int, name.removeprefix("garnet ").split("x"))
        return MDP.garnet(states, actions, branching, reward_noise=noise, seed=seed)


@dataclass(frozen=True)
class Case:
    """What a row is about: a learner, where it learns, and what is unusual about it."""

    options: Options
    process: str = RANDOM
    noise: float | None = None


class TabularExperiment(Experiment):
    """Learners on processes whose optimum is known."""

    source: ClassVar[str] = "sections 5.2 to 5.4; the chapter shows no numbers, these are ours"
    values: ClassVar[str] = "largest |Q - Q*| over the largest |Q*|, by steps"
    missing: ClassVar[str] = "beyond all numbers"
    expected: ClassVar[str] = (
        f"The last error below {SMALL:g} and {LESS:g} of the first on 95 % of the seeds."
    )
    #: What is run, by the names of the rows.
    cases: ClassVar[Mapping[str, Case]]
    #: Whether values are looked at often enough for curves.
    curves: ClassVar[bool] = False

    def __init__(self, config: TabularConfig | None = None) -> None:
        self.settings = config or TabularConfig()

    def config(self) -> dict[str, Any]:
        """Return the settings and what every case changes about them."""
        cases = {name: asdict(case) for name, case in self.cases.items()}
        return {**asdict(self.settings), "cases": cases}

    @property
    def steps(self) -> list[int]:
        """The steps after which values are looked at."""
        more = self.settings.curve if self.curves else ()
        return sorted({*self.settings.checkpoints, *more})

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Let every learner learn on this seed's process."""
        learned = {name: self._learn(case, seed, control) for name, case in self.cases.items()}
        return {"seconds": {}, **learned}

    def _learn(self, case: Case, seed: int, control: Control) -> dict[str, Any]:
        """Return what came of a case: values are looked at as for curves, and kept as asked."""
        settings = self.settings
        steps = sorted({*settings.checkpoints, *settings.curve})
        options = {
            "discount": settings.discount,
            "learning_rate_decay": settings.learning_rate_decay,
            "checkpoints": steps,
            **case.options,
        }
        noise = settings.reward_noise if case.noise is None else case.noise

        def learn() -> dict[str, Any]:
            process = settings.process(case.process, seed, noise)
            return _plain(learn_mdp(process, seed=seed, control=control, **options))

        trial = once(["mdp", case.process, settings.slip, noise, options, seed], learn)
        places = [steps.index(step) for step in self.steps]
        by_step = {name: [trial[name][at] for at in places] for name in BY_STEP}
        return {**trial, **by_step}

    def _errors(self, name: str, outcomes: Sequence[dict[str, Any]]) -> Row:
        shown = self.settings.checkpoints
        places = [self.steps.index(step) for step in shown]
        return Row(
            name=name,
            columns=[f"{step} steps" for step in shown],
            published=[None] * len(shown),
            per_seed=[[outcome[name]["errors"][at] for at in places] for outcome in outcomes],
            digits=3,
        )

    def _near(self, row: Row) -> int:
        """Count the seeds whose last error is below 0.15 and half of the first in the row."""
        ends = [(infinite(errors[0]), infinite(errors[-1])) for errors in row.per_seed]
        return sum(last < min(SMALL, LESS * first) for first, last in ends)

    def _judge_convergence(self, row: Row, more: str = "") -> Row:
        """Judge whether values approach the optimum, as they should on 95 % of the seeds."""
        count, near = len(row.per_seed), self._near(row)
        reason = f"below {SMALL:g} and half of the first error on {near} of {count} seeds"
        held = share_fits(near, count, least=0.95)
        return judge_claim(row, held=held, reason=reason + more, chance=True)


#: What an outcome has for each of the steps after which values are looked at.
BY_STEP = ("errors", "largest", "bounds")


def _plain(trial: MDPTrial) -> dict[str, Any]:
    """Return what a trial found as JSON has it: errors relative, the infinite as None."""
    size = float(abs(trial.optimum).max())
    return {
        "errors": [_finite(error / size) for error in trial.errors],
        "largest": [_finite(value) for value in trial.largest],
        "bounds": [_finite(value) for value in trial.bounds],
        "violations": trial.violations,
        "closest": {name: _finite(value) for name, value in trial.closest.items()},
        "optimum": size,
    }


def _finite(value: float) -> Value:
    return float(value) if math.isfinite(value) else None


def nearer(name: str, other: str, outcomes: Sequence[dict[str, Any]]) -> int:
    """Count the seeds on which a case ends nearer to the optimum than another."""
    ends = [(infinite(o[name]["errors"][-1]), infinite(o[other]["errors"][-1])) for o in outcomes]
    return sum(own < theirs for own, theirs in ends)


def median(values: Sequence[Value]) -> float:
    """Return the median; what is missing counts as infinite."""
    return statistics.median(map(infinite, values))
