"""Tables of tuned controllers: the print shows the consequents of one run."""

from __future__ import annotations

import json
from abc import abstractmethod
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from fuzzyrs._fuzzyrs import TSK, Control, FuzzyController
from fuzzyrs.experiments.experiment import Experiment, median_seed, published
from fuzzyrs.experiments.figures import draw_controller
from fuzzyrs.experiments.result import Result, Row, Value
from fuzzyrs.experiments.verdict import unchecked

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TERMS = ("N", "Z", "P")


class TunedController(Experiment):
    """A tuned controller of nine rules: its consequents beside the print, its terms as a figure."""

    values: ClassVar[str] = "consequents in radians, by the term of the angle and of its rate"
    expected: ClassVar[str] = "Nothing: the scan lost the terms, without which nothing compares."
    #: Whose controller it is.
    robot: ClassVar[str] = "pursuer"

    @abstractmethod
    def learn(self, seed: int, control: Control) -> tuple[FuzzyController, list[Value]]:
        """Return what was learned, and capture times by which seeds are ranked."""

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Learn with this seed."""
        controller, times = self.learn(seed, control)
        return {"times": times, "controller": json.loads(controller.to_json()), "seconds": {}}

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the consequents, the terms in rising order of their means."""
        printed = published(self.id)["values"]
        tables = np.array([rule_table(controller_of(outcome).system) for outcome in outcomes])
        median = np.median(tables, axis=0)
        from_print = float(np.abs(tables - np.array(printed)).mean())
        among_us = float(np.abs(tables - median).mean())
        signs = int((np.sign(median) == np.sign(printed)).sum())
        reason = (
            f"without the terms, which the scan lost, the printed {self.robot} cannot be run; a "
            f"consequent is {from_print:.2f} rad from the print's on average, {among_us:.2f} from "
            f"our median; {signs} of {median.size} medians have the print's sign"
        )
        return [
            unchecked(
                Row(
                    name=f"angle {term}",
                    columns=[f"rate {other}" for other in TERMS],
                    published=printed[index],
                    per_seed=tables[:, index].tolist(),
                    digits=3,
                ),
                reason,
            )
            for index, term in enumerate(TERMS)
        ]

    def controllers(self, result: Result) -> Iterator[tuple[str, FuzzyController]]:
        """Yield the controller of the median seed."""
        yield f"{self.id}-{self.robot}", tuned_controller(result)[0]

    def figures(self, result: Result) -> Iterator[tuple[str, Figure]]:
        """Draw the terms and the surface of the median seed's controller."""
        yield self.id, draw_tuned(self, result)


def tuned_controller(result: Result) -> tuple[FuzzyController, int]:
    """Return the controller of the median seed, and the seed."""
    chosen = median_seed([outcome["times"] for outcome in result.outcomes])
    return controller_of(result.outcomes[chosen]), result.seeds[chosen]


def draw_tuned(experiment: Experiment, result: Result) -> Figure:
    """Draw the terms and the surface of the median seed's controller."""
    controller, seed = tuned_controller(result)
    return draw_controller(controller.system, f"{experiment.title} (seed {seed})")


def controller_of(outcome: dict[str, Any]) -> FuzzyController:
    """Return the controller that an outcome holds as plain values."""
    return FuzzyController.from_json(json.dumps(outcome["controller"]))


def rule_table(system: TSK) -> np.ndarray[Any, Any]:
    """Return the consequents by the terms of the angle and of the rate, in order of their means.

    A genetic search may leave the term called N to the right of the one called P.
    """
    order = [
        np.argsort([term.parameters["mean"] for term in variable.terms.values()])
        for variable in system.inputs
    ]
    return np.reshape(system.consequents, [len(rows) for rows in order])[np.ix_(*order)]
