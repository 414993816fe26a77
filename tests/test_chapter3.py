"""Chapter 3 over many seeds, as expected before these were run; and small versions of it."""

from __future__ import annotations

import json
import os
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np
import pytest

import fuzzyrs as fz
from fuzzyrs.experiments import find, reproduce
from fuzzyrs.experiments.chapter3 import WallConfig
from fuzzyrs.experiments.chapter3_igbflc import FitnessConfig, StopConfig

FIRST_SEED = 20_000
SEEDS = range(FIRST_SEED, FIRST_SEED + 20)
SINUS = fz.WallFollowing(fz.Wall.sin())
STOP_RULE = fz.WallIgbflcTraining(repetitions=10, until_better=True)


@cache
def trained(training_kind, seeds):
    settings = {"two": fz.WallIgbflcTraining(), "stop": STOP_RULE}[training_kind]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(lambda seed: fz.train(SINUS, settings, seed=seed), seeds))


def expert_iae():
    return SINUS.play(fz.PD(1.2, 1.5)).measures()["iae"]


@pytest.mark.reproduction
def test_with_the_stop_rule_every_seed_beats_its_expert_along_the_sinus_wall():
    assert all(t.stages[t.best].beats_expert for t in trained("stop", SEEDS))


@pytest.mark.reproduction
def test_after_two_repetitions_the_usual_error_is_smaller_along_the_sinus_wall():
    iae = [t.stages[2].iae or np.inf for t in trained("two", SEEDS)]
    assert np.median(iae) < 0.9 * expert_iae()


@pytest.mark.reproduction
def test_half_of_the_rules_are_kept():
    kept = [t.stages[2].controller.rules_kept for t in trained("two", SEEDS)]
    assert 12 <= np.mean(kept) <= 15


def test_a_seed_with_the_stop_rule_beats_its_expert():
    (one,) = trained("stop", range(1, 2))
    assert one.stages[one.best].beats_expert
    assert len(one.stages) <= 11


@pytest.mark.parametrize("name", ["figure-3-6", "table-3-1", "table-3-2"])
def test_experiments_without_chance_bear_the_claims_out(name, tmp_path, drawn):
    experiment = find(name)()
    result = reproduce(experiment, [0], tmp_path)
    verdicts = {row.verdict for row in result.rows}
    assert "reproduced" in verdicts
    assert "differs" not in verdicts
    assert json.loads((tmp_path / f"{name}.json").read_text())["id"] == name
    paths = {path.name for path in drawn(experiment, tmp_path)}
    assert (
        paths
        == {
            "figure-3-6": {"figure-3-6.svg"},
            "table-3-1": set(),
            "table-3-2": {"table-3-2-terms.svg", "table-3-2-errors.svg"},
        }[name]
    )


SMALL = {
    "figure-3-7": FitnessConfig(duration=20.0, populations=(20, 40)),
    "figure-3-8": WallConfig(duration=20.0),
    "figure-3-14": StopConfig(duration=20.0, repetitions=2),
    "table-3-6": WallConfig(duration=20.0),
}


@pytest.mark.parametrize("name", SMALL)
def test_experiments_with_chance_run_and_draw(name, tmp_path, drawn):
    experiment = find(name)(SMALL[name])
    seeds = [3, 4]
    result = reproduce(experiment, seeds, tmp_path)
    assert all(row.verdict == "can't be checked" for row in result.rows)
    assert all(len(row.per_seed) == 2 for row in result.rows)
    for path in drawn(experiment, tmp_path):
        assert path.stat().st_size > 1000
    with_more = experiment.rows(result.outcomes * 10)
    assert {row.verdict for row in with_more} & {"reproduced", "differs"}
