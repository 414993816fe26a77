"""Rows as a table: the print and ours side by side, a line for each column of a row."""

from __future__ import annotations

from fuzzyrs._html import Html, element
from fuzzyrs.experiments.experiment import Experiment
from fuzzyrs.experiments.figures import named
from fuzzyrs.experiments.result import Result, Row, Value
from fuzzyrs.report.verdicts import badge, style

NOTHING = "–"


def row_anchor(identifier: str, index: int) -> str:
    """Return what links to a row of an experiment lead to."""
    return f"{identifier}--{index + 1}"


def table(experiment: Experiment, result: Result) -> Html:
    """Return the table of all rows."""
    count = len(result.seeds)
    lost = any(row.missing(index) for row in result.rows for index in range(len(row.columns)))
    seeds = f"{count} seed" if count == 1 else f"{count} seeds"
    heads = ["", "print", "median [least, largest]", "interquartile mean [95 %]"]
    head = [element("th", text, scope="col") for text in heads]
    if lost:
        head.append(element("th", experiment.missing, scope="col"))
    bodies = [_body(experiment.id, index, row, lost=lost) for index, row in enumerate(result.rows)]
    whole = element(
        "table",
        element("caption", element("div", f"{_capital(experiment.values)}; {seeds}.")),
        element("thead", element("tr", *head)),
        *bodies,
    )
    return scrolled(whole, f"The rows of {experiment.title}")


def scrolled(whole: Html, name: str) -> Html:
    """Return a table in a box of its own, which scrolls if the table is wider than the page."""
    return element("div", whole, class_="scrolled", tabindex=0, role="region", aria_label=name)


def _body(identifier: str, index: int, row: Row, *, lost: bool) -> Html:
    # What stands in it stays in sight while a narrow window scrolls the numbers.
    said = element(
        "div",
        element("span", named(row.name), class_="row-name"),
        " ",
        badge(row.verdict),
        " ",
        element("span", row.reason, class_="reason"),
    )
    head = element("th", said, scope="rowgroup", colspan=5 if lost else 4)
    columns = zip(
        row.columns,
        row.published,
        zip(row.median, row.low, row.high, strict=True),
        zip(row.interquartile_mean, *zip(*row.interval, strict=True), strict=True),
        strict=True,
    )
    lines = []
    for place, (name, printed, range_, interval) in enumerate(columns):
        cells = [_number(printed, row), _spread(range_, row), _spread(interval, row)]
        if lost:
            cells.append(str(row.missing(place) or NOTHING))
        head_cell = element("th", name, scope="row")
        lines.append(element("tr", head_cell, *(element("td", cell) for cell in cells)))
    return element(
        "tbody",
        element("tr", head, class_="row-head"),
        *lines,
        id=row_anchor(identifier, index),
        class_=style(row.verdict),
    )


def _number(value: Value, row: Row) -> str:
    """Return a value with as many digits as its row is worth."""
    return NOTHING if value is None else f"{value:.{row.digits}f}".replace("-", "−")


def _spread(values: tuple[Value, Value, Value], row: Row) -> str:
    """Return a value and the range around it, if it is one."""
    middle, low, high = (_number(value, row) for value in values)
    return middle if low == high else f"{middle} [{low}, {high}]"


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
