"""All experiments by their ids."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from fuzzyrs.errors import from_kind
from fuzzyrs.experiments import (
    both_learn,
    chapter2,
    chapter3,
    chapter3_igbflc,
    chapter4,
    chapter4_settings,
    chapter5,
    chapter6,
    chapter6_ablation,
    chapter6_agile,
    chapter6_studies,
    chapter7,
    chapter8_couplings,
    chapter8_many,
    chapter8_minimax,
    chapter8_settings,
    chapter8_two_pursuers,
)
from fuzzyrs.experiments.experiment import Experiment

_ALL: tuple[type[Experiment], ...] = (
    *chapter2.EXPERIMENTS,
    *chapter3.EXPERIMENTS,
    *chapter3_igbflc.EXPERIMENTS,
    *chapter4_settings.EXPERIMENTS,
    *chapter4.EXPERIMENTS,
    *chapter5.EXPERIMENTS,
    *chapter6.EXPERIMENTS,
    *chapter6_studies.EXPERIMENTS,
    *chapter6_agile.EXPERIMENTS,
    *chapter6_ablation.EXPERIMENTS,
    *both_learn.CHAPTER_6,
    *chapter7.EXPERIMENTS,
    *both_learn.CHAPTER_7,
    *chapter8_minimax.EXPERIMENTS,
    *chapter8_two_pursuers.EXPERIMENTS,
    *chapter8_settings.EXPERIMENTS,
    *chapter8_couplings.EXPERIMENTS,
    *chapter8_many.EXPERIMENTS,
)
_EXPERIMENTS = {experiment.id: experiment for experiment in _ALL}
#: Where the tables and figures are that have no experiment of their own.
_INCLUDED = {other: experiment.id for experiment in _ALL for other in experiment.includes}


def ids() -> list[str]:
    """Return the ids of all experiments."""
    return list(_EXPERIMENTS)


def select(names: Iterable[str]) -> list[type[Experiment]]:
    """Return the experiments that ids, "chapter-N" and "all" name, each once, chapter by chapter.

    Raises
    ------
    UnknownNameError
        If a name means nothing; it names the nearest.
    """
    wanted: set[type[Experiment]] = set()
    for name in names:
        group = [kind for kind in _EXPERIMENTS.values() if name in ("all", _chapter(kind))]
        wanted.update(group or [find(name)])
    return [kind for kind in _EXPERIMENTS.values() if kind in wanted]


def _chapter(kind: type[Experiment]) -> str:
    return f"chapter-{kind.chapter()}"


def find(experiment: str) -> type[Experiment]:
    """Return the experiment with an id, or the one that shows the table or figure.

    Raises
    ------
    UnknownNameError
        If there is none; it names the nearest.
    """
    identifier = _INCLUDED.get(experiment, experiment)
    if identifier in _EXPERIMENTS:
        return _EXPERIMENTS[identifier]
    groups = ["all", *map(_chapter, _EXPERIMENTS.values())]
    nearest = difflib.get_close_matches(experiment, [*_EXPERIMENTS, *_INCLUDED, *groups], n=1)
    hint = f"did you mean {nearest[0]!r}?" if nearest else "'fuzzyrs list' shows all"
    raise from_kind("unknown_name", f"unknown experiment {experiment!r}; {hint}")
