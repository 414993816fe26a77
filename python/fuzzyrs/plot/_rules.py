"""The rule viewer: every rule at one point."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from fuzzyrs._fuzzyrs import TSK
from fuzzyrs.plot._axes import COLOURS, colour, new_grid
from fuzzyrs.plot._membership import places

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from fuzzyrs._fuzzyrs import Explanation, System, Variable

# The input, what it is to be, and the degrees of that.
_Premise = tuple[str, str, "NDArray[np.float64]"]

_POINTS = 201
_SMALL = 8
# The most characters above a cell.
_WIDEST = 34
_INPUT, _POINT, _OUTPUT = COLOURS[0], COLOURS[1], COLOURS[2]


def rules(
    system: System | TSK, x: ArrayLike | Mapping[str, float], *, most: int = 12
) -> NDArray[Any]:
    """Draw what every rule makes of one point.

    Each row is a rule: for each input the membership function that it asks for, hedges included,
    filled up to the degree of the point; for each output the set or the number that it concludes,
    as high as it fires. The last row has all terms of the inputs, and the outputs: the aggregated
    set or all conclusions together, and the value.

    Parameters
    ----------
    system : System or TSK
        Whose rules.
    x : array_like of float, or dict of str to float
        The point.
    most : int, optional
        How many rules are drawn: the strongest. If that leaves out any, it leaves out all that
        don't fire.

    Returns
    -------
    numpy.ndarray of matplotlib.axes.Axes
        A row for each rule and the last one; a column for each input and then each output.
    """
    named = isinstance(x, Mapping)
    explanation = system.explain(**x) if named else system.explain(x)  # type: ignore[arg-type]
    shown = _shown(explanation, most)
    outputs = list(explanation.outputs)
    rows, columns = len(shown) + 1, len(system.inputs) + len(outputs)
    size = (1.0 + 2.1 * columns, 0.9 + 0.95 * rows)
    cells = new_grid(rows, columns, figsize=size, sharex="col")
    samples = _samples(system, explanation)
    for row, rule in zip(cells, shown, strict=False):
        strength = explanation.strengths[rule]
        row[0].set_ylabel(f"rule {rule + 1}\n{strength:.3g}", rotation=0, ha="right", va="center")
        premises = _premises(system, rule, samples)
        for cell, variable, column in zip(row, system.inputs, samples.T, strict=False):
            own = [premise for premise in premises if premise[0] == variable.name]
            _draw_premises(cell, column, own)
        for cell, output in zip(row[len(system.inputs) :], outputs, strict=True):
            _draw_conclusion(cell, system, explanation, rule, output)
    _draw_last(cells[-1], system, explanation, shown)
    for cell in cells.ravel():
        cell.set(ylim=(0, max(1.05, cell.get_ylim()[1])), yticks=[])
        cell.tick_params(labelsize=_SMALL)
    cells[0, 0].figure.suptitle(_title(system, explanation, shown))
    return cells


def _shown(explanation: Explanation, most: int) -> list[int]:
    shown = explanation.strongest(most)
    if len(shown) == len(explanation.rules):
        return shown
    return [rule for rule in shown if explanation.strengths[rule] > 0]


def _title(system: System | TSK, explanation: Explanation, shown: list[int]) -> str:
    count = len(explanation.rules)
    if len(shown) == count:
        return system.name
    return f"{system.name}: the strongest {len(shown)} of {count} rules"


def _samples(system: System | TSK, explanation: Explanation) -> NDArray[np.float64]:
    """Return numbers along each input in columns of one length; the last row is the point."""
    along = [places(v.universe, v.terms.values(), _POINTS) for v in system.inputs]
    length = max(map(len, along))
    padded = [np.pad(x, (0, length - len(x)), mode="edge") for x in along]
    return np.vstack([np.column_stack(padded), list(explanation.inputs.values())])


def _premises(system: System | TSK, rule: int, samples: NDArray[np.float64]) -> list[_Premise]:
    if not isinstance(system, TSK):
        return system.premises(rule, samples)
    terms = np.unravel_index(rule, [len(variable) for variable in system.inputs])
    return [
        (variable.name, name, variable.terms[name](column))
        for variable, term, column in zip(system.inputs, terms, samples.T, strict=True)
        for name in [list(variable)[term]]
    ]


def _draw_premises(cell: Axes, column: NDArray[np.float64], premises: list[_Premise]) -> None:
    """Draw what a rule asks for about one input; the last number of the column is the point."""
    x, point = column[:-1], column[-1]
    for index, (_, _, degrees) in enumerate(premises):
        hue = _INPUT if index == 0 else colour(index + 2)
        cell.plot(x, degrees[:-1], color=hue, linewidth=1.2)
        cell.fill_between(x, np.minimum(degrees[:-1], degrees[-1]), color=hue, alpha=0.35)
    if not premises:
        _hide(cell)
        return
    cell.axvline(point, color=_POINT, linewidth=1.2)
    words = " / ".join(words for _, words, _ in premises)
    _head(cell, f"{premises[0][0]} is {words}")


def _draw_conclusion(
    cell: Axes, system: System | TSK, explanation: Explanation, rule: int, output: str
) -> None:
    """Draw what a rule concludes about one output."""
    text = explanation.conclusions[rule].get(output)
    if text is None:
        _hide(cell)
        return
    _head(cell, text)
    strength = float(explanation.strengths[rule])
    if not isinstance(system, TSK) and (whole := system.implied_set(rule, output, 1)):
        implied = system.implied_set(rule, output, strength)
        cell.plot(*whole, color=_OUTPUT, linewidth=1.2)
        cell.fill_between(*(implied or whole), color=_OUTPUT, alpha=0.35)
    else:
        _stem(cell, explanation.concluded[output][rule], strength)


def _draw_last(
    row: NDArray[Any], system: System | TSK, explanation: Explanation, shown: list[int]
) -> None:
    """Draw the inputs with all their terms, and the outputs."""
    row[0].set_ylabel("all", rotation=0, ha="right", va="center")
    for cell, variable in zip(row, system.inputs, strict=False):
        value = explanation.inputs[variable.name]
        _draw_input(cell, variable, value)
        cell.set_xlabel(f"{variable.name} = {value:.5g}", fontsize=_SMALL + 1)
    for cell, (output, value) in zip(
        row[len(system.inputs) :], explanation.outputs.items(), strict=True
    ):
        if output in explanation.sets:
            cell.fill_between(*explanation.sets[output], color=_OUTPUT, alpha=0.6)
        for rule in shown:
            _stem(cell, explanation.concluded[output][rule], explanation.strengths[rule])
        if np.isfinite(value):
            cell.axvline(value, color=_POINT, linewidth=1.8)
        silent = "" if explanation.fires[output] else " (no rule fires)"
        cell.set_xlabel(f"{output} = {value:.5g}{silent}", fontsize=_SMALL + 1)
        universe = _universe(system, output)
        if universe is not None:
            cell.set_xlim(universe)


def _draw_input(cell: Axes, variable: Variable, value: float) -> None:
    x = places(variable.universe, variable.terms.values(), _POINTS)
    cell.plot(x, variable.degrees(x), color=_INPUT, linewidth=0.8)
    cell.axvline(value, color=_POINT, linewidth=1.2)
    low, high = variable.universe
    cell.set_xlim(min(low, value), max(high, value))


def _universe(system: System | TSK, output: str) -> tuple[float, float] | None:
    if isinstance(system, TSK):
        return None
    (variable,) = (own.variable for own in system.outputs if own.name == output)
    return None if variable is None else variable.universe


def _stem(cell: Axes, place: float, height: float) -> None:
    """Draw a number that is concluded with some strength; nothing if there is none."""
    if np.isfinite(place):
        cell.plot([place, place], [0, height], color=_OUTPUT, linewidth=2.5)
        cell.plot(place, height, "o", color=_OUTPUT, markersize=5, clip_on=False)


def _head(cell: Axes, text: str) -> None:
    # No name has a point in it, so these are numbers.
    text = re.sub(r"\d+\.\d+(e-?\d+)?", lambda number: f"{float(number[0]):.4g}", text)
    text = text if len(text) <= _WIDEST else f"{text[: _WIDEST - 1]}…"
    cell.set_title(text, fontsize=_SMALL, loc="left", pad=2)


def _hide(cell: Axes) -> None:
    """Leave a cell empty, but for a label beside it."""
    cell.tick_params(left=False, bottom=False, labelbottom=False)
    cell.patch.set_visible(False)
    for spine in cell.spines.values():
        spine.set_visible(False)
