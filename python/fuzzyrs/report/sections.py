"""A section for each chapter, and in it one for each experiment."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from fuzzyrs._html import Html, data_uri, element
from fuzzyrs.animation.player import player
from fuzzyrs.experiments.result import Result
from fuzzyrs.report.entries import Entry
from fuzzyrs.report.tables import table
from fuzzyrs.report.verdicts import counts

#: What the thesis's chapters are called.
CHAPTERS = {
    2: "Survey on different learning algorithms",
    3: "Iterative genetic based fuzzy logic controller",
    4: "Iterative adaptive network fuzzy inference system",
    5: "On the convergence of model-building Q-learning with eligibility traces",
    6: "Q(λ)-learning based genetic fuzzy logic controller",
    7: "Q(λ)-learning fuzzy inference system",
    8: "Learning in multi-player pursuit-evasion games",
}

#: A vector graphic that is larger is shown as PNG [bytes].
LARGEST_SVG = 300_000

#: A list of settings that fits into so many characters stays on one line.
LINE = 88


def readable(identifier: str) -> str:
    """Return an id as it is printed: "table-6-3" is Table 6.3."""
    words = identifier.split("-")
    number = ".".join(word for word in words if word.isdigit())
    kind, *rest = [word for word in words if not word.isdigit()] or [""]
    return " ".join(part for part in (kind.capitalize(), number, *rest) if part)


def by_chapter(entries: Iterable[Entry]) -> dict[int, list[Entry]]:
    """Return the experiments of each chapter."""
    found: dict[int, list[Entry]] = {}
    for entry in entries:
        found.setdefault(entry.experiment.chapter(), []).append(entry)
    return dict(sorted(found.items()))


def chapters(entries: Iterable[Entry]) -> Iterable[Html]:
    """Yield the sections of the chapters."""
    for chapter, some in by_chapter(entries).items():
        head = [f"Chapter {chapter}"]
        if chapter in CHAPTERS:
            head.append(element("span", CHAPTERS[chapter], class_="chapter-title"))
        yield element(
            "section",
            element("h2", *head),
            *map(_experiment, some),
            id=f"chapter-{chapter}",
            class_="chapter",
        )


def _experiment(entry: Entry) -> Html:
    experiment, result = entry.experiment, entry.result
    shows = "".join(f" · {readable(name)}" for name in experiment.includes)
    title = element("span", experiment.title, class_="title")
    parts = [
        element("h3", f"{readable(entry.id)}{shows}", title),
        element(
            "p", "; ".join(filter(None, [experiment.source, experiment.page])), class_="source"
        ),
        element("p", element("b", "Claim."), " ", experiment.claim, class_="claim"),
    ]
    if experiment.expected:
        expected = [element("b", "Expected."), " ", experiment.expected]
        parts.append(element("p", *expected, class_="expected"))
    if entry.problem:
        parts.append(element("p", entry.problem, class_="problem"))
    if result is None:
        command = f"fuzzyrs reproduce {entry.id}"
        parts.append(element("p", "No result to show. This makes one:", class_="soft"))
        parts.append(_command(command))
    else:
        parts += [counts(entry.verdicts), table(experiment, result)]
        parts += [_figure(entry, path) for path in entry.figures]
        if result.games:
            parts.append(player(result.games, f"{readable(entry.id)}, {experiment.title}"))
        parts += _provenance(entry.id, result)
    return element("article", *parts, id=entry.id, class_="experiment")


def _figure(entry: Entry, path: Path) -> Html:
    """Return a figure that lies in the page: as vectors, unless these are too large."""
    vector, pixels = (path.with_name(f"{path.name}.{form}") for form in ("svg", "png"))
    size = vector.stat().st_size if vector.exists() else None
    if size is not None and (size <= LARGEST_SVG or not pixels.exists()):
        source = data_uri("image/svg+xml", vector.read_bytes())
    else:
        source = data_uri("image/png", pixels.read_bytes())
    about = path.name.removeprefix(entry.id).strip("-").replace("-", " ")
    name = f"{readable(entry.id)}: {entry.experiment.title}" + (f" ({about})" if about else "")
    picture = element("img", src=source, alt=name, loading="lazy", decoding="async")
    return element("figure", picture, element("figcaption", name))


def _provenance(identifier: str, result: Result) -> list[Html]:
    """Return where the numbers come from, and the command that makes them again."""
    run = result.run
    where = [
        f"{run['seconds']:g} s" if isinstance(run.get("seconds"), (int, float)) else "",
        f"on {run['threads']} threads" if "threads" in run else "",
        *(str(run[name]) for name in ("machine", "processor") if run.get(name)),
        f"Python {run['python']}" if "python" in run else "",
    ]
    facts = [
        element("dt", "seeds"),
        element("dd", _seeds(result.seeds)),
        element("dt", "run"),
        element("dd", ", ".join(filter(None, where))),
        element("dt", "settings"),
        element("dd", element("pre", element("code", _pretty(result.config)), tabindex=0)),
    ]
    return [
        _command(_reproducing(identifier, result.seeds)),
        element(
            "details",
            element("summary", "Seeds, settings, machine"),
            element("dl", *facts),
            class_="provenance",
        ),
    ]


def _command(command: str) -> Html:
    button = element("button", "copy", type="button", class_="copy", hidden=True)
    return element("p", element("code", command), button, class_="command")


def _reproducing(identifier: str, seeds: Sequence[int]) -> str:
    """Return what makes a result again."""
    first, count = seeds[0], len(seeds)
    if list(seeds) != list(range(first, first + count)):
        return (
            f'experiments.reproduce(experiments.find("{identifier}")(), {list(seeds)}, '
            'Path("results"))'
        )
    begin = f" --seed {first}" if first else ""
    return f"fuzzyrs reproduce {identifier} --seeds {count}{begin}"


def _seeds(seeds: Sequence[int]) -> str:
    first, last = seeds[0], seeds[-1]
    if len(seeds) > 2 and list(seeds) == list(range(first, last + 1)):
        return f"{first} to {last}"
    return ", ".join(map(str, seeds))


def _pretty(value: Any, indent: str = "") -> str:
    """Return values as JSON; what fits stays on a line."""
    line = json.dumps(value, ensure_ascii=False)
    if not isinstance(value, (dict, list)) or len(indent) + len(line) <= LINE:
        return line
    inner = f"{indent}  "
    if isinstance(value, dict):
        parts = [f"{json.dumps(key)}: {_pretty(each, inner)}" for key, each in value.items()]
    else:
        parts = [_pretty(each, inner) for each in value]
    opening, closing = "{}" if isinstance(value, dict) else "[]"
    return f"{opening}\n{inner}" + f",\n{inner}".join(parts) + f"\n{indent}{closing}"
