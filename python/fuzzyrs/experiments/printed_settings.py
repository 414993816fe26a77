"""Printed tables of settings, which several chapters have."""

from __future__ import annotations

from typing import Any, ClassVar

from fuzzyrs._fuzzyrs import Control, QlbgflcTraining, TwoPursuersQlbgflcTraining
from fuzzyrs.experiments.experiment import Experiment
from fuzzyrs.experiments.result import Row
from fuzzyrs.experiments.verdict import judge_claim, unchecked


class PrintedSettings(Experiment):
    """What something is set to: no chance is involved, the settings say it all."""

    values: ClassVar[str] = "numbers and shares"
    missing: ClassVar[str] = "no games, or lost in the scan"
    default_seeds: ClassVar[int] = 1
    quick_seeds: ClassVar[int] = 1
    expected: ClassVar[str] = "Every legible cell is equal; where one is not, the reason is told."

    def run_seed(self, seed: int, control: Control) -> dict[str, Any]:
        """Do nothing."""
        del seed, control
        return {"seconds": {}}


def judge_settings(row: Row, why: str = "not as printed") -> Row:
    """Judge settings that should be the printed ones; `why` tells why they are not.

    What the scan lost can't be compared.
    """
    legible = [index for index, value in enumerate(row.published) if value is not None]
    if not legible:
        return unchecked(row, f"lost in the scan; {why}")
    same = all(row.per_seed[0][index] == row.published[index] for index in legible)
    cells = "every cell" if len(legible) == len(row.published) else "every legible cell"
    return judge_claim(row, held=same, reason=f"equal in {cells}" if same else why)


def settings_rows(
    settings: QlbgflcTraining | TwoPursuersQlbgflcTraining, printed: dict[str, Any], seeds: int
) -> list[Row]:
    """Lay out the sizes of both genetic searches of QLBGFLC beside a printed table of them."""
    rows = []
    for name, steps in (("stage_1", None), ("stage_2", settings.steps)):
        phase = getattr(settings, name).to_dict()
        values = [phase.get(column, steps) for column in printed["columns"]]
        row = Row(
            name=name.replace("_", " "),
            columns=printed["columns"],
            published=printed[name],
            per_seed=[values] * seeds,
        )
        rows.append(judge_settings(row))
    return rows
