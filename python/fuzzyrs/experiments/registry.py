"""All experiments by their ids."""

from __future__ import annotations

import difflib

from fuzzyrs.errors import from_kind
from fuzzyrs.experiments import chapter3, chapter3_igbflc, chapter4, chapter5
from fuzzyrs.experiments.chapter6 import Table63
from fuzzyrs.experiments.experiment import Experiment

_ALL: tuple[type[Experiment], ...] = (
    *chapter3.EXPERIMENTS,
    *chapter3_igbflc.EXPERIMENTS,
    *chapter4.EXPERIMENTS,
    *chapter5.EXPERIMENTS,
    Table63,
)
_EXPERIMENTS = {experiment.id: experiment for experiment in _ALL}


def ids() -> list[str]:
    """Return the ids of all experiments."""
    return list(_EXPERIMENTS)


def find(experiment: str) -> type[Experiment]:
    """Return the experiment with an id.

    Raises
    ------
    UnknownNameError
        If there is none; it names the nearest.
    """
    if experiment in _EXPERIMENTS:
        return _EXPERIMENTS[experiment]
    nearest = difflib.get_close_matches(experiment, _EXPERIMENTS, n=1)
    hint = f"did you mean {nearest[0]!r}?" if nearest else "'fuzzyrs list' shows all"
    raise from_kind("unknown_name", f"unknown experiment {experiment!r}; {hint}")
