"""The systems that pyfuzzylite ships, with the outputs that it ships, through fuzzyrs.

Nothing of the package is imported or copied: its files are read where pip has put them.
"""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import fll

INSTALL = "the tables are missing: pip install --no-deps pyfuzzylite==8.0.6"


def examples() -> Path | None:
    package = importlib.util.find_spec("fuzzylite")
    return Path(package.origin).parent / "examples" if package else None


FOLDER = examples()
PATHS = sorted(FOLDER.rglob("*.fll")) if FOLDER else []
NAMES = [path.relative_to(FOLDER).with_suffix("").as_posix() for path in PATHS]


@dataclass(frozen=True)
class Allowance:
    """Where a system may differ, and why."""

    reason: str
    tolerance: float = 1e-6
    without: frozenset[str] = frozenset()
    """Outputs that are not compared."""
    skipped: tuple[int, ...] = ()
    """Rows that are not."""


ALLOWANCES = {
    "terms/discrete": Allowance(
        "the table was made from points with more digits than the file has; pyfuzzylite itself "
        "comes no nearer to it than 7.6e-5",
        tolerance=1e-4,
    ),
    "takagi_sugeno/approximation": Allowance(
        "diffFx is a formula of the other outputs; in the first row sin(x)/x is 0/0",
        without=frozenset({"diffFx"}),
        skipped=(0,),
    ),
    "tsukamoto/tsukamoto": Allowance(
        "a rule of strength 1 concludes the infinite inverse of a sigmoid, for which fuzzyrs takes "
        "the largest degree below 1",
        skipped=(0, 511, 512, 1023),
    ),
}


def test_all_examples_are_there():
    assert FOLDER is not None, INSTALL
    tables = [table(path)[1] for path in PATHS]
    assert (len(PATHS), sum(map(len, tables))) == (61, 60_746)


def table(path: Path) -> tuple[list[str], np.ndarray]:
    """Return the names and the numbers of the columns."""
    text = path.with_suffix(".fld").read_text(encoding="utf-8")
    names, *rows = text.splitlines()
    return names.split(), np.array([row.split() for row in rows], dtype=float)


@pytest.mark.parametrize("path", PATHS, ids=NAMES)
def test_outputs_are_those_of_fuzzylite(path):
    allowance = ALLOWANCES.get(path.relative_to(FOLDER).with_suffix("").as_posix(), Allowance(""))
    engine = fll.Engine(path.read_text(encoding="utf-8"), allowance.without)
    names, rows = table(path)
    rows = np.delete(rows, allowance.skipped, axis=0)
    assert {*names} == {*engine.inputs, *engine.outputs, *allowance.without}
    inputs = rows[:, [names.index(name) for name in engine.inputs]]
    expected = rows[:, [names.index(name) for name in engine.outputs]]
    outputs = engine.system(inputs).reshape(expected.shape)
    np.testing.assert_allclose(outputs, expected, rtol=0, atol=allowance.tolerance)
