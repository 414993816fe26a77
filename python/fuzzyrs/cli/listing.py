"""`fuzzyrs list` and `fuzzyrs show`: which experiments there are, and what each is about."""

from __future__ import annotations

import argparse
import json
from typing import Any

from fuzzyrs import experiments
from fuzzyrs.experiments.experiment import Experiment, published


def add_parser(commands: Any) -> None:
    """Add both commands."""
    listing = commands.add_parser("list", help="list the experiments")
    listing.add_argument("--json", action="store_true", help="for machines")
    listing.set_defaults(run=_list)
    show = commands.add_parser("show", help="show an experiment's claim, source and config")
    show.add_argument("id", metavar="ID", help="such as table-6-3")
    show.add_argument("--json", action="store_true", help="for machines")
    show.set_defaults(run=_show)


def _list(options: argparse.Namespace) -> int:
    kinds = [experiments.find(identifier) for identifier in experiments.ids()]
    if options.json:
        print(json.dumps([_brief(kind) for kind in kinds], indent=2, ensure_ascii=False))
        return 0
    width = max(len(kind.id) for kind in kinds)
    for chapter in dict.fromkeys(kind.chapter() for kind in kinds):
        print(f"chapter-{chapter}")
        for kind in kinds:
            if kind.chapter() == chapter:
                print(f"  {kind.id:<{width}} {kind.title} ({kind.source})")
    return 0


def _show(options: argparse.Namespace) -> int:
    experiment = experiments.find(options.id)()
    if options.json:
        print(json.dumps(describe(experiment), indent=2, ensure_ascii=False))
        return 0
    about, most = describe(experiment), experiment.most_seeds
    shown = {
        "": f"{experiment.id}: {experiment.title}",
        "also": ", ".join(about["includes"]),
        "source": f"{about['source']}; {about['page']}" if about["page"] else about["source"],
        "claim": about["claim"],
        "expected": about["expected"],
        "values": about["values"],
        "seeds": f"{experiment.default_seeds}, with --quick {experiment.quick_seeds}"
        + (f", in a chapter or all {most} at most" if most else "")
        + f"; about {experiment.cost:.2g} s of a core for each",
        "reproduce": f"fuzzyrs reproduce {experiment.id}",
    }
    for name, text in shown.items():
        if text:
            print(f"{name + ':':<11}{text}" if name else text)
    print("published:")
    print(_indented(about["published"]) if about["published"] else "  nothing")
    print("config:")
    print(_indented(about["config"]))
    return 0


def _brief(kind: type[Experiment]) -> dict[str, Any]:
    return {
        "id": kind.id,
        "chapter": kind.chapter(),
        "title": kind.title,
        "source": kind.source,
        "page": kind.page,
        "includes": list(kind.includes),
        "claim": kind.claim,
        "expected": kind.expected,
        "values": kind.values,
        "default_seeds": kind.default_seeds,
        "quick_seeds": kind.quick_seeds,
        "most_seeds": kind.most_seeds,
        "cost": kind.cost,
    }


def describe(experiment: Experiment) -> dict[str, Any]:
    """Return all that is known of an experiment before it is run."""
    return {
        **_brief(type(experiment)),
        "published": published(experiment.id),
        "config": experiment.config(),
    }


def _indented(values: dict[str, Any]) -> str:
    """Return values as indented lines; lists and small objects stay on one line."""
    lines = []
    for key, value in values.items():
        if isinstance(value, dict) and len(json.dumps(value)) > 80:
            lines += [f"  {key}:", *("  " + line for line in _indented(value).splitlines())]
        else:
            lines.append(f"  {key}: {json.dumps(value, ensure_ascii=False)}")
    return "\n".join(lines)
