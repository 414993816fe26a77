"""How verdicts look: a colour never without its sign, and never without a word nearby."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from fuzzyrs._html import Html, element
from fuzzyrs.experiments.claims import NOT_RUN
from fuzzyrs.experiments.verdict import CLOSE, DIFFERS, REPRODUCED, UNCHECKED, VERDICTS

SIGNS = {REPRODUCED: "✓", CLOSE: "≈", DIFFERS: "✗", UNCHECKED: "?", NOT_RUN: "○"}

MEANINGS = {
    REPRODUCED: (
        "the sample fits the expectation, and the print, where there is one, lies within our range"
    ),
    CLOSE: (
        "the sample fits, but the print lies outside our range; of bands of means and medians also "
        "the reverse"
    ),
    DIFFERS: "anything else",
    UNCHECKED: "too few seeds, lost in the scan, not printed, or no statement",
}


def style(verdict: str) -> str:
    """Return the class of a verdict; words of a file that are none count as unchecked."""
    names = {REPRODUCED: "reproduced", CLOSE: "close", DIFFERS: "differs", NOT_RUN: "not-run"}
    return f"verdict-{names.get(verdict, 'unchecked')}"


def sign(verdict: str) -> Html:
    """Return the sign of a verdict, which those who hear the page are told as its word."""
    mark = SIGNS.get(verdict, SIGNS[UNCHECKED])
    return element(
        "span", mark, class_=f"sign {style(verdict)}", role="img", aria_label=verdict, title=verdict
    )


def badge(verdict: str) -> Html:
    """Return the sign of a verdict and its word."""
    mark = element("span", SIGNS.get(verdict, SIGNS[UNCHECKED]), aria_hidden="true")
    return element("span", mark, f" {verdict}", class_=f"badge {style(verdict)}")


def counts(verdicts: Iterable[str]) -> Html:
    """Return how many there are of each verdict, in words."""
    number = Counter(verdicts)
    parts = [
        element("li", badge(verdict), f" {number[verdict]}", data_verdict=verdict)
        for verdict in (*VERDICTS, NOT_RUN)
        if number[verdict]
    ]
    return element("ul", *parts, class_="counts")


def summary(verdicts: Sequence[str]) -> str:
    """Return the one verdict that an experiment is marked with: the worst of those it has.

    Rows that can't be checked count only where there are no others.
    """
    for verdict in (DIFFERS, CLOSE, REPRODUCED):
        if verdict in verdicts:
            return verdict
    return UNCHECKED if verdicts else NOT_RUN


def bar(verdicts: Sequence[str]) -> Html:
    """Return a bar with the share of each verdict; counts beside it say the same in words."""
    number, total, left = Counter(verdicts), len(verdicts), 0.0
    parts = []
    for verdict in VERDICTS:
        width = round(100 * number[verdict] / max(total, 1), 3)
        if width:
            parts.append(
                element("rect", class_=style(verdict), x=round(left, 3), width=width, height=10)
            )
        left += width
    return element(
        "svg",
        *parts,
        class_="bar",
        viewBox="0 0 100 10",
        preserveAspectRatio="none",
        aria_hidden="true",
    )
