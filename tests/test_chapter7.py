"""QLFIS and its rivals over seeds that nothing was chosen by, as expected before these were run."""

from __future__ import annotations

import json
import os
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np
import pytest

import fuzzyrs as fz
from fuzzyrs.experiments import find, reproduce
from fuzzyrs.experiments.both_learn import BothLearnConfig
from fuzzyrs.experiments.chapter7 import Figure74Config, Table73Config
from fuzzyrs.experiments.crossplay import MEASURES, CrossPlay, cross_play
from fuzzyrs.experiments.statistics import share_fits
from fuzzyrs.experiments.trained import train

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


def test_both_may_learn_by_qlfis():
    measured = learned_together(8)
    assert np.median(measured["escapes [%]"]) == 0
    assert np.median(measured["pursuer's loss [s]"]) <= 1


def test_a_training_that_diverges_hands_over_what_was_learned():
    game, wild = fz.OneOnOne(), dai(critic_rate=(1.0, 1.0), discount=1.0, trace_decay=1.0)
    with pytest.raises(fz.errors.DivergedError, match="what was learned before is kept") as caught:
        fz.train(game, wild, seed=1)
    learned = caught.value.so_far
    assert isinstance(learned.controller, fz.FuzzyController)
    assert np.isfinite(learned.controller.system.parameters).all()
    assert game.play(learned.controller, evader_start=(2, 4)).duration > 0
    with pytest.raises(fz.errors.DivergedError) as caught:
        fz.train(game, wild, evader=wild, seed=1)
    assert isinstance(caught.value.so_far.evader, fz.FuzzyController)


def test_parameters_that_are_held_within_bounds_are_told():
    game, held = fz.OneOnOne(), "parameters held within their bounds"
    wide = fz.QlfisTraining(episodes=30, narrowest=0.2)
    assert fz.train(game, wide, seed=1).history[held][0] > 0
    assert len(fz.train(game, wide, evader=wide, seed=1).history[held]) == 2
    assert held not in fz.train(game, FEW["q_lambda"], seed=1).history


SEARCH = fz.GeneticPhase(iterations=3, population=20)
GAMES = fz.QLambdaTraining(episodes=4, steps=100)
FEW = {
    "q_lambda": GAMES,
    "reward_ga": fz.RewardGaTraining(genetic=SEARCH, steps=50),
    "qlbgflc": fz.QlbgflcTraining(
        phase_1=GAMES,
        stage_1=SEARCH,
        stage_2=fz.GeneticPhase(iterations=2, population=10),
        steps=50,
    ),
    "qlfis": fz.QlfisTraining(episodes=10, steps=100),
    "dai": dai(episodes=10, steps=100),
}
TOGETHER = BothLearnConfig(**{name: (settings, settings) for name, settings in FEW.items()})
PURSUIT = Table73Config(max_time=20.0, **FEW)
CONFIGS = {
    "table-6-5": TOGETHER,
    "table-6-6": TOGETHER,
    "table-6-7": TOGETHER,
    "table-7-1": PURSUIT,
    "table-7-2": PURSUIT,
    "table-7-3": PURSUIT,
    "figure-7-4": Figure74Config(starts=((2.0, 4.0), (3.0, -8.0)), **FEW),
    "table-7-4": TOGETHER,
    "table-7-5": TOGETHER,
    "table-7-6": TOGETHER,
}


@pytest.mark.parametrize("name", CONFIGS)
def test_tables_run_and_draw(name, tmp_path, drawn):
    experiment, seeds = find(name)(CONFIGS[name]), [3, 4]
    result = reproduce(experiment, seeds, tmp_path)
    written = json.loads((tmp_path / f"{name}.json").read_text(encoding="utf-8"))
    assert written["config"] == json.loads(json.dumps(experiment.config()))
    for path in drawn(experiment, tmp_path):
        assert path.stat().st_size > 500
    # With enough seeds every row has a verdict or says why not.
    assert all(row.verdict and row.reason for row in experiment.rows(result.outcomes * 10))
    for included in experiment.includes:
        assert find(included) is type(experiment)


def test_a_training_is_done_once():
    game, settings, control = fz.OneOnOne(), FEW["qlfis"], fz.Control()
    first, seconds = train(game, settings, 5, control)
    assert train(fz.OneOnOne(), fz.QlfisTraining(episodes=10, steps=100), 5, control) == (
        first,
        seconds,
    )
    others = [
        train(game, settings, 6, control),
        train(game, settings, 5, control, evader=settings),
        train(game, settings, 5, control, evader=fz.EvasiveTurn(0.5)),
        train(fz.OneOnOne(capture_radius=0.2), settings, 5, control),
        train(game, fz.QlfisTraining(episodes=11, steps=100), 5, control),
    ]
    assert all(other[0] is not first for other in others)


def test_classical_robots_lose_and_gain_nothing():
    played = cross_play(fz.OneOnOne(), "classical", "classical", STARTS, 60.0)
    assert played.classical == CLASSICAL.tolist()
    assert played.measures(60.0) == [0.0] * len(MEASURES)


def test_an_escape_counts_as_a_capture_at_the_limit():
    played = CrossPlay([5.0, 8.0], [None, 7.0], [6.0, None], [4.0, 30.0], [0.5, 1.5], [1, 3])
    assert played.measures(60.0) == [52.0, -1.0, 50.0, 1.0, 2.0]


@pytest.mark.parametrize("technique", ["q_lambda", "reward_ga", "qlbgflc", "qlfis", "dai"])
def test_both_robots_learn_and_the_same_seed_gives_the_same(technique):
    game, settings = fz.OneOnOne(), FEW[technique]
    first, again = (fz.train(game, settings, evader=settings, seed=8) for _ in range(2))
    starts = {"evader_starts": STARTS, "max_time": 20}
    ours, theirs = (game.play_many(t.controller, t.evader, **starts) for t in (first, again))
    np.testing.assert_array_equal(ours.miss_distance, theirs.miss_distance)
    assert first.evader is not None
    assert fz.train(game, settings, seed=8).evader is None
    assert "against" in repr(first)


REFUSED_TOGETHER = {
    "of the evader's settings, as of the pursuer's": (
        FEW["qlfis"],
        fz.QlfisTraining(episodes=11, steps=100),
    ),
    "give both the same starts": (
        FEW["qlfis"],
        fz.QlfisTraining(episodes=10, steps=100, starts=[(1, 1)]),
    ),
    "settings of the pursuer's kind, QlfisTraining": (FEW["qlfis"], FEW["q_lambda"]),
    "population of the evader, which meets others place by place": (
        fz.RewardGaTraining(genetic=SEARCH, steps=50, pairing="place"),
        fz.RewardGaTraining(genetic=fz.GeneticPhase(iterations=3, population=30), steps=50),
    ),
    "phase 1 is done by both robots or by none": (
        FEW["qlbgflc"],
        fz.QlbgflcTraining(**{**FEW["qlbgflc"].to_dict(), "prepared": False}),
    ),
}


@pytest.mark.parametrize("message", REFUSED_TOGETHER)
def test_robots_that_learn_together_need_the_same_games(message):
    pursuer, evader = REFUSED_TOGETHER[message]
    with pytest.raises((ValueError, TypeError), match=message):
        fz.train(fz.OneOnOne(), pursuer, evader=evader)


def test_settings_that_make_no_sense_are_refused():
    def learn(**settings):
        fz.train(fz.OneOnOne(), fz.QlfisTraining(**{"episodes": 1, **settings}))

    bad = fz.errors.InvalidValueError
    for settings, message in {
        ("discount", 1.5): "discount must be between 0 and 1",
        ("trace_decay", -0.1): "trace decay of the critic must be between 0 and 1",
        ("critic_rate", (1.2, 0.1)): "learning rate of the critic",
        ("actor_rate", (0.0, 0.0)): "learning rate of the actor",
        ("noise", 0.0): "noise must be positive",
        ("noise", np.nan): "noise must be finite",
        ("narrowest", 0.0): "narrowest width",
        ("width", -1.0): "width",
        ("rate_limit", 0.0): "rate limit must be positive",
        ("angle_limit", np.nan): "angle limit must be finite",
        ("steps", 0): "steps must be at least 1",
    }.items():
        name, value = settings
        with pytest.raises(bad, match=message):
            learn(**{name: value})
    with pytest.raises(fz.errors.UnknownNameError, match='did you mean "all"'):
        fz.QlfisTraining(tune="al")
    with pytest.raises(bad, match="hidden"):
        fz.train(fz.OneOnOne(), fz.DaiTraining(hidden=0))


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


def share_of_losers():
    """The share of seeds that miss from some start after the two rates were exchanged."""
    times, _ = learned("qlfis, rates exchanged", 60)
    return np.isinf(times).any(axis=1).mean()


@pytest.mark.reproduction
def test_exchanged_rates_fail_on_many_seeds():
    assert share_of_losers() >= 0.4
    assert not np.isinf(learned("qlfis", 150)[0]).any()


@pytest.mark.reproduction
@pytest.mark.xfail(strict=True, reason="on 57 % of the seeds, not on 90 %")
def test_exchanged_rates_fail_on_nearly_every_seed():
    assert share_of_losers() >= 0.9


@pytest.mark.reproduction
def test_both_learners_never_lose_the_game():
    measured = learned_together(100)
    assert (measured["escapes [%]"] == 0).all()
    assert (measured["pursuer's loss [s]"] <= 2.0 + ROUNDING).mean() >= 0.95


@pytest.mark.reproduction
@pytest.mark.xfail(strict=True, reason="on about 85 % of the seeds, not on 95 %")
def test_both_learners_stay_near_the_classical_game():
    measured = learned_together(100)
    held = measured["pursuer's loss [s]"] <= 0.6 + ROUNDING
    held &= (measured["pursuer's path [m]"] <= 0.7) & (measured["evader's path [m]"] <= 1.1)
    assert share_fits(int(held.sum()), 100, least=0.95), held.mean()
