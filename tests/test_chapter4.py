"""Chapter 4 over many seeds, as expected before these were run; and small versions of it."""

from __future__ import annotations

import json
import os
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np
import pytest

import fuzzyrs as fz
from fuzzyrs.experiments import find, reproduce
from fuzzyrs.experiments.chapter4 import TRAINED, UNSEEN, PursuitConfig, first_pass

CONFIG = PursuitConfig()
STARTS = (*TRAINED, *UNSEEN)
CLASSICAL = np.array([7.0, 8.7, 9.2, 9.3, 10.7, 11.5, 7.6, 13.0])
PD = np.array([18.8, 21.5, 21.3, 22.0, 23.1, 24.3, 19.2, 24.4])
IANFIS = np.array([7.5, 10.1, 10.0, 10.5, 11.6, 12.9, 7.9, 13.1])
ROUNDING = 1e-9
SEEDS = range(30_000, 30_020)


def times(pursuer):
    """Capture times from the eight starts, infinite for an escape."""
    played = (CONFIG.play(pursuer, start).capture_time for start in STARTS)
    return np.array([np.inf if time is None else time for time in played])


@cache
def learned(technique, seeds):
    """Capture times, a row for each seed."""
    settings = CONFIG.trainings()[technique]

    def run(seed):
        return times(fz.train(CONFIG.game, settings, seed=seed, evader=CONFIG.evader).controller)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return np.array(list(pool.map(run, seeds)))


def share_within(ours, expected, margin):
    """The share of seeds all of whose cells are within a margin of what is expected."""
    return (abs(ours - expected) <= margin + ROUNDING).all(axis=1).mean()


def test_the_rows_without_learning_are_the_published_ones():
    assert times("bang-bang").tolist() == CLASSICAL.tolist()
    assert times(fz.PD(1.98, 0.04)).tolist() == IANFIS.tolist()
    pd = times(CONFIG.expert)
    assert (abs(pd - PD) <= 0.5).all()
    assert (pd > 15).all()


def test_the_pd_misses_by_one_to_three_centimetres_at_first():
    missed = [first_pass(CONFIG.play(CONFIG.expert, start)) for start in STARTS]
    assert all(0.10 < distance < 0.13 for distance in missed), missed


SMALL = range(3, 5)


def test_ianfis_has_the_published_row_and_its_first_stage_the_teachers():
    assert share_within(learned("ianfis", SMALL), IANFIS, 0.2) == 1
    assert share_within(learned("anfis", SMALL), times(CONFIG.expert), 0.2) == 1


def test_the_expert_alone_as_target_teaches_nothing_more():
    assert (learned("ianfis_target_expert", SMALL) > 15).all()


@pytest.mark.reproduction
def test_every_seed_of_ianfis_has_the_published_row():
    assert share_within(learned("ianfis", SEEDS), IANFIS, 0.2) == 1
    assert share_within(learned("anfis", SEEDS), times(CONFIG.expert), 0.2) == 1


@pytest.mark.reproduction
def test_no_seed_has_it_without_the_sum_as_target():
    assert share_within(learned("ianfis_target_expert", SEEDS), IANFIS, 0.5) == 0


@pytest.mark.reproduction
@pytest.mark.xfail(reason="18 of the seeds 0-19 have it, 16 of these: fewer than expected")
def test_igbflc_with_modern_operators_has_the_published_row():
    assert share_within(learned("igbflc", SEEDS), IANFIS, 0.5) >= 0.95


@pytest.mark.reproduction
def test_igbflc_with_modern_operators_mostly_has_it():
    assert share_within(learned("igbflc", SEEDS), IANFIS, 0.5) >= 0.7


@pytest.mark.reproduction
def test_igbflc_with_the_thesiss_operators_mostly_misses_it():
    assert share_within(learned("igbflc_thesis_operators", SEEDS), IANFIS, 0.5) <= 0.5


def test_figure_4_5_bears_its_claim_out(tmp_path, drawn):
    experiment = find("figure-4-5")()
    result = reproduce(experiment, [0], tmp_path)
    assert result.rows[0].verdict == "reproduced"
    assert [path.name for path in drawn(experiment, tmp_path)] == ["figure-4-5.svg"]


@pytest.mark.parametrize("name", ["table-4-4", "table-4-5", "table-4-6", "table-4-7"])
def test_tables_run_and_draw(name, tmp_path, drawn):
    few = fz.IgbflcTraining(iterations=5)
    experiment = find(name)(PursuitConfig(igbflc=few))
    seeds = [3, 4]
    result = reproduce(experiment, seeds, tmp_path)
    written = json.loads((tmp_path / f"{name}.json").read_text(encoding="utf-8"))
    assert written["config"]["igbflc"]["iterations"] == 5
    for path in drawn(experiment, tmp_path):
        assert path.stat().st_size > 1000
    rows = {row.name: row for row in experiment.rows(result.outcomes * 10)}
    if name in {"table-4-6", "table-4-7"}:
        assert {rows[n].verdict for n in ("classical", "pd_doubled", "ianfis")} == {"reproduced"}
        assert rows["pd"].verdict == "close"
    if name == "table-4-4":
        assert rows["capture times [s]"].verdict == "reproduced"


def test_training_refuses_what_makes_no_sense():
    def train(settings):
        return fz.train(CONFIG.game, settings, evader=CONFIG.evader)

    bad = fz.errors.InvalidValueError
    with pytest.raises(bad, match="jitter must be from 0 to below 1"):
        train(fz.IanfisTraining(jitter=1.0))
    with pytest.raises(bad, match="number of starting positions must be at least 1"):
        train(fz.IanfisTraining(lessons=fz.Lessons(starts=np.empty((0, 2)))))
    with pytest.raises(bad, match="steps must be at least 1"):
        train(fz.IgbflcTraining(lessons=fz.Lessons(steps=0)))
    with pytest.raises(bad, match="samples of a lesson, starts times steps must be at most 1e7"):
        train(fz.IgbflcTraining(lessons=fz.Lessons(steps=2**32 - 1)))
    with pytest.raises(bad, match="proportional gain must be finite"):
        train(fz.IgbflcTraining(lessons=fz.Lessons(expert=(np.nan, 0))))
    with pytest.raises(ValueError, match='the expert saw as "angle"'):
        train(fz.IanfisTraining(lessons=fz.Lessons(starts=[(3, 0)], steps=2)))
    with pytest.raises(fz.errors.UnknownNameError, match='did you mean "averaging"'):
        fz.IgbflcTraining(operators="average")
    with pytest.raises(fz.errors.UnknownNameError, match="target of stage 2"):
        fz.Lessons(target="both")
