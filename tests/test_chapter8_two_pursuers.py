"""Section 8.4: the experiments, and what the robots reach over many seeds.

The bounds come from repeated experiments with other seeds. Run the heavier ones with
`-m reproduction`; an unlucky set of seeds is possible but rare.
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np
import pytest

import fuzzyrs as fz
from fuzzyrs import experiments
from fuzzyrs.experiments.chapter8_two_pursuers import (
    LEARNED,
    LITERAL,
    PREDICTION,
    SIGHT,
    Figure84,
    Figure87,
    Table81,
    TwoPursuersConfig,
)

FIRST_SEED = 20_000
ROUNDING = 1e-9
CLASSICAL = {
    SIGHT: np.array([27.2, 18.7, 21.8, 23.9, 20.5, 28.2]),
    PREDICTION: np.array([26.9, 16.2, 19.9, 23.8, 16.8, 28.0]),
}

PHASE = {"iterations": 4, "population": 20, "crossover": 0.2, "mutation": 0.3}
SMALL = TwoPursuersConfig(
    qlbgflc=fz.TwoPursuersQlbgflcTraining(
        phase_1=fz.TwoPursuersQLambdaTraining(episodes=15, steps=600),
        stage_1=PHASE,
        stage_2={**PHASE, "population": 10},
        steps=100,
    )
)


def test_the_figures_lay_out_all_times_and_the_claims(tmp_path, drawn):
    experiment = Figure87(SMALL)
    result = experiments.reproduce(experiment, [1, 2], tmp_path)
    names = [row.name for row in result.rows]
    assert names[0] == "classical"
    assert {LEARNED, LITERAL} < set(names)
    by_name = {row.name: row for row in result.rows}
    assert by_name["classical"].per_seed[0] == CLASSICAL[PREDICTION].tolist()
    assert by_name[LEARNED].published == [23.8, 14.8, 19.2, 21.6, 16.7, 28.2]
    assert by_name["classical"].published == [None] * 6
    # What chance has no hand in has a verdict after any number of seeds.
    sure = [row for row in result.rows if row.verdict == "reproduced"]
    assert [row.name for row in sure] == [
        "claim: prediction shortens the capture [s saved], classical"
    ]
    assert sure[0].per_seed[0] == [0.3, 2.5, 1.9, 0.1, 3.7, 0.2]
    assert sure[0].published == [2.6, 5.9, 3.0, 4.1, 4.6, 0.2]
    again = experiments.reproduce(experiment, [2, 1], tmp_path, threads=1)
    assert again.rows[1].per_seed == result.rows[1].per_seed[::-1]
    figures = drawn(experiment, tmp_path)
    assert [path.name for path in figures] == ["figure-8-7-paths.svg", "figure-8-7-times.svg"]
    assert all(path.stat().st_size > 10_000 for path in figures)


def test_other_starts_are_not_compared_with_the_print(tmp_path):
    config = TwoPursuersConfig(starts=(((2.0, 1.0), (-1.0, 3.0)),), qlbgflc=SMALL.qlbgflc)
    for figure in (Figure84, Figure87):
        result = experiments.reproduce(figure(config), [1], tmp_path)
        assert all(row.published == [None] * len(row.columns) for row in result.rows)


def test_table_8_1_is_what_the_training_is_set_to():
    rows = Table81().rows([{}])
    assert [row.verdict for row in rows] == ["reproduced"] * 2
    assert rows[1].published == [500, None, 0.4, 0.2, 600]
    assert rows[1].per_seed == [[500, 10, 0.4, 0.2, 600]]
    other = fz.TwoPursuersQlbgflcTraining(steps=300)
    assert Table81(other).rows([{}])[1].verdict == "differs"


@cache
def learned(aim: str, starts: int, count: int) -> np.ndarray:
    """The capture times of robots that learned together, a row for each seed."""
    config = TwoPursuersConfig()
    game = config.aiming(aim)
    settings = fz.TwoPursuersQlbgflcTraining(starts_per_generation=starts)

    def run(seed):
        trained = fz.train(game, settings, seed=seed)
        played = game.play_many(trained.pursuers, trained.evader, pursuer_starts=config.starts)
        return np.where(np.isnan(played.capture_time), np.inf, played.capture_time)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return np.array(list(pool.map(run, range(FIRST_SEED, FIRST_SEED + count))))


def off(aim: str, times: np.ndarray) -> np.ndarray:
    """How far the times of each seed are from classical, on average over the starts [s]."""
    return abs(times - CLASSICAL[aim]).mean(axis=1)


@pytest.mark.reproduction
@pytest.mark.parametrize(("aim", "most"), [(SIGHT, 1.5), (PREDICTION, 1.0)])
def test_three_robots_learn_to_play_like_the_classical_ones(aim, most):
    times = learned(aim, 4, 40)
    assert (times < 60).all()
    assert (off(aim, times) < most).mean() >= 0.95


@pytest.mark.reproduction
def test_prediction_shortens_the_capture():
    plain, predicted = (learned(aim, 4, 40) for aim in (SIGHT, PREDICTION))
    assert (predicted.mean(axis=1) < plain.mean(axis=1) + ROUNDING).mean() >= 0.95
    starts = [1, 2, 4]  # (b), (c) and (e)
    assert (predicted < plain)[:, starts].all(axis=1).mean() >= 0.95


@pytest.mark.reproduction
def test_from_one_start_a_generation_all_still_capture():
    times = learned(SIGHT, 1, 40)
    assert (times < 60).all()
    assert (off(SIGHT, times) < 3.5).mean() >= 0.75


@pytest.mark.reproduction
@pytest.mark.xfail(strict=True, reason="about 35 of 40 seeds are within 3.5 s, not 38")
def test_from_one_start_a_generation_all_play_like_the_classical_ones():
    assert (off(SIGHT, learned(SIGHT, 1, 40)) < 3.5).mean() >= 0.95
