"""What the report begins with: all verdicts at a glance, the claims, how to read the rest."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from fuzzyrs._fuzzyrs import __version__
from fuzzyrs._html import Html, element, theme_switch
from fuzzyrs.experiments.claims import Finding, Judged
from fuzzyrs.experiments.figures import named
from fuzzyrs.experiments.verdict import VERDICTS
from fuzzyrs.report.entries import Entry
from fuzzyrs.report.sections import CHAPTERS, by_chapter, readable
from fuzzyrs.report.tables import row_anchor, scrolled
from fuzzyrs.report.verdicts import MEANINGS, badge, bar, counts, sign, style, summary

THESIS = (
    "S. F. Desouky, doctoral thesis, Carleton University, 2010; journal versions: Desouky and "
    "Schwartz, Robotics and Autonomous Systems 59, 2011, 22–33, and Int. J. Adapt. Control Signal "
    "Process. 2011, "
)
DOI = "10.1002/acs.1249"


def header() -> Html:
    """Return what stands above everything."""
    return element(
        "header",
        element("a", "Skip the contents", href="#overview", class_="skip"),
        element("p", "fuzzyrs ", __version__, theme_switch(), class_="running-head"),
        element("h1", "A thesis on fuzzy controllers that learn, reproduced"),
        element(
            "p",
            THESIS,
            element("a", f"doi {DOI}", href=f"https://doi.org/{DOI}"),
            ".",
            class_="source",
        ),
        class_="page-head",
    )


def navigation(entries: Sequence[Entry]) -> Html:
    """Return the list of all sections, for wide windows."""
    parts = [
        element("li", element("a", "Overview", href="#overview")),
        element("li", element("a", "Claims", href="#claims")),
        element("li", element("a", "How to read this", href="#reading")),
    ]
    for chapter, some in by_chapter(entries).items():
        links = [element("li", sign(summary(entry.verdicts)), " ", _link(entry)) for entry in some]
        head = element("a", f"Chapter {chapter}", href=f"#chapter-{chapter}")
        parts.append(element("li", head, element("ul", *links)))
    return element("nav", element("ul", *parts), aria_label="Sections", class_="contents")


def overview(entries: Sequence[Entry], claims: Sequence[Judged]) -> Iterable[Html]:
    """Yield the overview, the claims and how to read the rest."""
    verdicts = [verdict for entry in entries for verdict in entry.verdicts]
    run = sum(entry.result is not None for entry in entries)
    which = "All" if run == len(entries) else f"{run} of {len(entries)}"
    rows = [row for entry in entries if entry.result is not None for row in entry.result.rows]
    yield element(
        "section",
        element("h2", "Overview"),
        element(
            "p",
            "The thesis's tables and figures, computed anew, over several seeds each. "
            "Our numbers stand beside the printed ones, and every row has a verdict. "
            f"{which} experiments were run; they have {len(rows)} rows with "
            f"{sum(len(row.columns) for row in rows)} numbers.",
        ),
        bar(verdicts),
        counts(verdicts),
        *_cells(entries),
        id="overview",
        class_="overview",
    )
    yield _claims(claims, entries)
    yield _reading()


def _cells(entries: Sequence[Entry]) -> Iterable[Html]:
    """Yield each chapter's experiments as cells with the sign of their verdict."""
    for chapter, some in by_chapter(entries).items():
        title = f" {CHAPTERS[chapter]}" if chapter in CHAPTERS else ""
        yield element("h3", f"Chapter {chapter}", element("span", title, class_="soft"))
        yield element("ul", *map(_cell, some), class_="cells")


def _cell(entry: Entry) -> Html:
    verdict = summary(entry.verdicts)
    link = element(
        "a",
        sign(verdict),
        element("span", readable(entry.id), class_="cell-name"),
        bar(entry.verdicts),
        href=f"#{entry.id}",
        class_=f"cell {style(verdict)}",
        title=entry.experiment.title,
    )
    return element("li", link)


def _link(entry: Entry) -> Html:
    return element("a", readable(entry.id), href=f"#{entry.id}")


def _claims(claims: Sequence[Judged], entries: Sequence[Entry]) -> Html:
    anchors = {
        (entry.id, row.name): row_anchor(entry.id, index)
        for entry in entries
        if entry.result is not None
        for index, row in enumerate(entry.result.rows)
    }
    heads = [
        element("th", text, scope="col", role="columnheader")
        for text in ("no.", "claim", "verdict", "rests on")
    ]
    # Narrow windows show it as a list, which it stays a table in for those who hear it.
    whole = element(
        "table",
        element("caption", "What the thesis says in words, and the rows that speak to it."),
        element("thead", element("tr", *heads, role="row"), role="rowgroup"),
        element("tbody", *(_claim(judged, anchors) for judged in claims), role="rowgroup"),
        class_="claims",
        role="table",
    )
    return element(
        "section",
        element("h2", "Claims"),
        counts([judged.verdict for judged in claims]),
        scrolled(whole, "Claims"),
        id="claims",
    )


def _claim(judged: Judged, anchors: Mapping[tuple[str, str], str]) -> Html:
    claim = judged.claim
    said = [claim.text, " ", element("span", claim.source, class_="soft")]
    if claim.remark:
        said.append(element("p", f"With 100 seeds: {claim.remark}", class_="remark"))
    deciding = [_finding(each, anchors) for each in judged.findings if each.decides]
    beside = [_finding(each, anchors) for each in judged.findings if not each.decides]
    rows: list[str] = [element("ul", *deciding)]
    if beside:
        rows.append(element("details", element("summary", "and beside"), element("ul", *beside)))
    return element(
        "tr",
        element("th", str(claim.number), scope="row", role="rowheader"),
        element("td", *said, role="cell"),
        element("td", badge(judged.verdict), role="cell"),
        element("td", *rows, class_="evidence", role="cell"),
        id=f"claim-{claim.number}",
        role="row",
    )


def _finding(finding: Finding, anchors: Mapping[tuple[str, str], str]) -> Html:
    anchor = anchors.get((finding.experiment, finding.row), finding.experiment)
    name = f"{readable(finding.experiment)}, {named(finding.row)}"
    link = element("a", name, href=f"#{anchor}")
    reason = element("span", finding.reason, class_="reason")
    return element("li", sign(finding.verdict), element("span", link, ": ", reason))


def _reading() -> Html:
    meanings = [
        part
        for verdict in VERDICTS
        for part in (element("dt", badge(verdict)), element("dd", f"{MEANINGS[verdict]}."))
    ]
    return element(
        "section",
        element("h2", "How to read this"),
        element(
            "p",
            "A verdict compares the sample with an expectation that was fixed beforehand from "
            "other seeds, and rejects it only where chance would do so in one of twenty samples. "
            "An experiment's cell above has the worst verdict of its rows that could be checked; "
            "its bar has the share of each.",
        ),
        element("dl", *meanings),
        element(
            "p",
            "Of each number the tables give the print, our median over the seeds with the least "
            "and the largest, and the mean of the middle half of the seeds with its 95 % bootstrap "
            "interval. A seed without a value, as when an evader escapes, counts as larger than "
            "all others; a dash is such a value, or one that is not printed. Where there is no "
            "range all are the same, to so many digits.",
        ),
        id="reading",
    )
