"""QLFIS and its rivals over seeds that nothing was chosen by, as expected before these were run."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np
import pytest

import fuzzyrs as fz
from fuzzyrs.experiments.crossplay import MEASURES, cross_play
from fuzzyrs.experiments.statistics import share_fits

STARTS = [(-6, 7), (-7, -7), (2, 4), (3, -8)]
CLASSICAL = np.array([9.6, 10.4, 4.5, 8.5])
FIRST_SEED = 10_000
ROUNDING = 1e-9


def dai(**changes):
    """Dai et al.'s technique with other settings of the learning."""
    return fz.DaiTraining(learning={**fz.DaiTraining().learning.to_dict(), **changes})


TECHNIQUES = {
    "qlfis": fz.QlfisTraining(),
    "qlfis, Dai's noise": fz.QlfisTraining(noise=0.1, noise_decay=1),
    "qlfis, rates exchanged": fz.QlfisTraining(critic_rate=(0.01, 0.001), actor_rate=(0.1, 0.01)),
    "dai": fz.DaiTraining(),
    "dai, QLFIS's noise": dai(noise=0.08, noise_decay=0),
    "q_lambda": fz.QLambdaTraining(),
    "reward_ga": fz.RewardGaTraining(),
}


def over_seeds(run, count):
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(run, range(FIRST_SEED, FIRST_SEED + count)))


@cache
def learned(technique, count):
    """Capture times (infinite for an escape) and learning times, a row for each seed."""
    game = fz.OneOnOne()

    def run(seed):
        trained = fz.train(game, TECHNIQUES[technique], seed=seed)
        times = game.play_many(trained.controller, evader_starts=STARTS).capture_time
        return np.where(np.isnan(times), np.inf, times), trained.learning_time

    times, learning = zip(*over_seeds(run, count), strict=True)
    return np.array(times), np.array(learning)


@cache
def learned_together(count):
    """The measures of QLFIS when both robots learn, a row for each seed."""
    game, settings = fz.OneOnOne(), fz.QlfisTraining()

    def run(seed):
        trained = fz.train(game, settings, evader=settings, seed=seed)
        players = trained.controller, trained.evader
        return cross_play(game, *players, [*STARTS, (6, 7), (5, 8)], 60.0).measures(60.0)

    return {
        measure: np.array(values)
        for measure, *values in zip(MEASURES, *over_seeds(run, count), strict=True)
    }


def share_within(times, margin):
    """The share of seeds that catch from every start within a margin of the classical time."""
    return (times <= CLASSICAL + margin + ROUNDING).all(axis=1).mean()


def faster(one, other, count):
    """How often a run of one technique has a smaller sum of times than a run of another."""
    ours, theirs = (learned(technique, count)[0].sum(axis=1) for technique in (one, other))
    return (ours[:, None] < theirs).mean()


def test_the_first_controller_never_catches():
    game = fz.OneOnOne()
    first = fz.train(game, fz.QlfisTraining(episodes=0)).controller
    assert first.system.consequents.ravel().tolist() == [
        -0.5,
        -0.25,
        0,
        -0.25,
        0,
        0.25,
        0,
        0.25,
        0.5,
    ]
    assert not game.play_many(first, evader_starts=STARTS).captured.any()


def test_qlfis_comes_near_the_classical_pursuer_on_most_of_a_few_seeds():
    times, _ = learned("qlfis", 10)
    assert share_within(times, 1.0) >= 0.8
    assert (abs(np.median(times, axis=0) - [9.7, 10.4, 4.5, 8.6]) <= 0.3 + ROUNDING).all()


def test_a_faster_actor_than_critic_learns_nothing():
    times, _ = learned("qlfis, rates exchanged", 8)
    assert share_within(times, 10.0) <= 0.25


def test_both_may_learn_by_qlfis():
    measured = learned_together(8)
    assert np.median(measured["escapes [%]"]) == 0
    assert np.median(measured["pursuer's loss [s]"]) <= 1


@pytest.mark.reproduction
def test_qlfis_comes_near_the_classical_pursuer():
    times, learning = learned("qlfis", 150)
    assert share_within(times, 1.0) >= 0.95
    assert (abs(np.median(times, axis=0) - [9.7, 10.4, 4.5, 8.6]) <= 0.2 + ROUNDING).all()
    assert np.median(learning) / np.median(learned("reward_ga", 60)[1]) < 0.03


@pytest.mark.reproduction
def test_qlfis_is_faster_than_q_lambda_and_the_falling_noise():
    assert faster("qlfis", "q_lambda", 100) >= 0.9
    assert faster("qlfis", "dai", 100) >= 0.85


@pytest.mark.reproduction
def test_what_makes_qlfis_better_than_dai_is_the_noise():
    assert faster("dai, QLFIS's noise", "qlfis, Dai's noise", 60) >= 0.85


@pytest.mark.reproduction
def test_exchanged_rates_fail():
    times, _ = learned("qlfis, rates exchanged", 60)
    assert np.isinf(times).any(axis=1).mean() >= 0.9


@pytest.mark.reproduction
def test_both_learners_stay_near_the_classical_game():
    measured = learned_together(100)
    held = measured["escapes [%]"] == 0
    held &= measured["pursuer's loss [s]"] <= 0.6 + ROUNDING
    held &= (measured["pursuer's path [m]"] <= 0.7) & (measured["evader's path [m]"] <= 1.1)
    assert share_fits(int(held.sum()), 100, least=0.95), held.mean()
