"""Tables of tuned controllers: the print shows the consequents of one run."""

from __future__ import annotations

import json
from abc import abstractmethod
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from fuzzyrs import plot
from fuzzyrs._fuzzyrs import TSK, Control, FuzzyController
from fuzzyrs.experiments.experiment import Experiment, median_seed, published
from fuzzyrs.experiments.figures import draw_controller
from fuzzyrs.experiments.result import Row, Value
from fuzzyrs.experiments.verdict import unchecked

TERMS = ("N", "Z", "P")


class TunedController(Experiment):
    """A tuned controller of nine rules: its consequents beside the print, its terms as a figure."""

    values: ClassVar[str] = "consequents in radians, by the term of the angle and of its rate"
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

    def draw(
        self, outcomes: Sequence[dict[str, Any]], seeds: Sequence[int], folder: Path
    ) -> Iterator[Path]:
        """Save the controller of the median seed, its terms and its surface."""
        yield from draw_tuned(self, self.robot, outcomes, seeds, folder)


def draw_tuned(
    experiment: Experiment,
    robot: str,
    outcomes: Sequence[dict[str, Any]],
    seeds: Sequence[int],
    folder: Path,
) -> Iterator[Path]:
    """Save a robot's controller of the median seed, its terms and its surface."""
    chosen = median_seed([outcome["times"] for outcome in outcomes])
    controller = controller_of(outcomes[chosen])
    path = folder / f"{experiment.id}-{robot}.json"
    controller.save(path)
    yield path
    plot.require_matplotlib()
    title = f"{experiment.title} (seed {seeds[chosen]})"
    yield draw_controller(controller.system, title, folder / f"{experiment.id}.png")


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
