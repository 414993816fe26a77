"""Section 8.5's settings: what its games and learners are made of, beside the printed tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

import fuzzyrs._fuzzyrs as native
from fuzzyrs._fuzzyrs import CoupledRobotsTraining
from fuzzyrs.experiments.chapter8_couplings import CHOICES, ManyConfig, three, two
from fuzzyrs.experiments.experiment import Experiment, published
from fuzzyrs.experiments.printed_settings import PrintedSettings, judge_settings
from fuzzyrs.experiments.result import Row, Value


class Table82(PrintedSettings):
    """Tables 8.2 to 8.8 and 8.10 to 8.12: what the games and learners are set to."""

    id: ClassVar[str] = "table-8-2"
    cost: ClassVar[float] = 0.017
    title: ClassVar[str] = "the robots, actions, tables and parameters of section 8.5"
    claim: ClassVar[str] = "None; the games and settings have the printed values but where told."
    source: ClassVar[str] = "Tables 8.2-8.8 and 8.10-8.12, section 8.5"
    page: ClassVar[str] = "about pp. 166-173"
    includes: ClassVar[tuple[str, ...]] = tuple(
        f"table-8-{number}" for number in (3, 4, 5, 6, 7, 8, 10, 11, 12)
    )
    values: ClassVar[str] = "numbers, m/s and rad"

    def config(self) -> dict[str, Any]:
        """Return both games."""
        return {"two": two().to_dict(), "three": three().to_dict()}

    def rows(self, outcomes: Sequence[dict[str, Any]]) -> list[Row]:
        """Lay out the settings beside the print."""
        printed, rows = published(self.id), []
        for name, config in (("two", two()), ("three", three())):
            for what, values in _settings_of(config).items():
                own, columns = list(values.values()), list(values)
                row = Row(
                    f"{what} ({name})",
                    columns,
                    printed[name][what],
                    [own] * len(outcomes),
                    digits=2,
                )
                rows.append(judge_settings(row, DIFFERENT.get(what, "not as printed")))
        return rows


#: What is not as printed, and why.
DIFFERENT = {
    "discount": "with 0.5 the coupling is found as often; the scan has 'Oi' for two, 0.8 or 0.9",
    "temperature's decay": (
        "a temperature of 1 in all episodes leaves the robots nearly random: they catch nobody"
    ),
    "Q_CF": "by episodes a coupling that is first tried late hardly learns",
    "generations of stage 2": (
        "one start decides more about the time than a controller does, and mutants drawn anew that "
        "were lucky replace good controllers"
    ),
}


def _settings_of(config: ManyConfig) -> dict[str, dict[str, Value]]:
    """Return what the tables list, from the objects that are used."""
    robots = {
        f"{who}{index}": robot
        for who, side in (("P", config.game.pursuers), ("E", config.game.evaders))
        for index, robot in enumerate(side, start=1)
    }
    learning = CoupledRobotsTraining(**config.coupling.robots.to_dict())
    phases = {"stage 1": config.stage_1, "stage 2": config.stage_2}
    couplings = native.couplings(len(config.game)) + 1
    return {
        "speed": {name: robot.speed for name, robot in robots.items()},
        "steering limit": {name: robot.max_steering for name, robot in robots.items()},
        "wheelbase": {name: robot.wheelbase for name, robot in robots.items()},
        "actions": {
            name: float(len(robot.steering_angles(learning.action_step)))
            for name, robot in robots.items()
        },
        "states": {"of each": float(learning.points**2)},
        "couplings": {
            choice: float("".join(map(str, coupling)))
            for choice, coupling in zip(CHOICES, couplings.tolist(), strict=False)
        },
        "learning": {
            "episodes": float(config.coupling.episodes),
            "steps": float(config.coupling.steps),
            "λ": learning.trace_decay,
            "T [s]": config.game.time_step,
            "α's decay": learning.learning_rate_decay,
            "θ": learning.exploration,
            "θ_CF": config.coupling.temperature,
        },
        "discount": {"γ": learning.discount},
        "temperature's decay": {"power of 1/m": learning.exploration_decay},
        **{
            name: {
                "iterations": float(phase.iterations),
                "population": float(phase.population),
                "crossover": phase.crossover,
                "mutation": phase.mutation,
            }
            for name, phase in phases.items()
        },
        "Q_CF": {"α counts episodes": float(config.coupling.rate_count == "episodes")},
        "generations of stage 2": {
            "starts": float(config.starts_per_generation),
            "mutants drawn anew": float(config.stage_2.fresh_mutants),
        },
        "steps of stage 2": {
            "steps": float(config.training(config.game.pursuers[0], (1, 1)).steps)
        },
    }


EXPERIMENTS: tuple[type[Experiment], ...] = (Table82,)
