"""Section 8.5 over seeds that nothing was chosen by, as expected before these were run."""

from __future__ import annotations

import json
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import fuzzyrs as fz
from fuzzyrs.experiments import find, reproduce
from fuzzyrs.experiments.chapter8_couplings import three, two
from fuzzyrs.experiments.chapter8_many import ScalingConfig
from fuzzyrs.experiments.statistics import share_fits

FIRST_SEED = 10_000
CONFIGS = {"two": (two(), 0), "three": (three(), 3)}


def over_seeds(run, count):
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(run, range(FIRST_SEED, FIRST_SEED + count)))


@cache
def values(name, reward, count):
    """Q_CF, a row for each seed."""
    config, _ = CONFIGS[name]

    def learn(seed):
        settings = config.rewarded(reward)
        return fz.learn_coupling(config.game, settings, **config.starts, seed=seed).values

    return np.array(over_seeds(learn, count))


def test_the_pattern_of_table_8_14_is_exact():
    assert two().classical() == [9.6, 20.2]
    assert three().classical() == [17.1, None, 17.1, 9.9, None, 13.7]


@pytest.mark.parametrize("reward", ["r_over_T2", "r_over_f"])
@pytest.mark.parametrize("name", CONFIGS)
def test_the_right_coupling_is_learned(name, reward):
    _, right = CONFIGS[name]
    table = values(name, reward, 40)
    assert share_fits(int((table.argmax(axis=1) == right).sum()), len(table), least=0.95)


#: Where 95 % of another implementation's seeds lay: game, reward, coupling, least and largest.
BANDS = [
    ("two", "r_over_f", 0, 0.39, 0.46),
    ("two", "r_over_f", 1, 0.21, 0.24),
    ("two", "r_over_T2", 0, 0.39, 0.57),
    ("two", "r_over_T2", 1, 0.11, 0.14),
    ("three", "r_over_f", 3, 0.51, 0.65),
    ("three", "r_over_T2", 3, 0.43, 0.65),
]


def inside(count):
    """The share of seeds within each band."""
    for name, reward, choice, low, high in BANDS:
        column = values(name, reward, count)[:, choice]
        yield ((low <= column) & (column <= high)).mean(), low <= np.median(column) <= high


def test_most_values_lie_where_others_did():
    shares, medians = zip(*inside(40), strict=True)
    assert all(medians)
    # Measured on 200 seeds: 86 to 97 %.
    assert min(shares) >= 0.7


@pytest.mark.reproduction
@pytest.mark.xfail(strict=True, reason="86 to 97 % of the seeds lie in the bands, not 95 % in each")
def test_values_lie_where_95_percent_of_others_did():
    assert min(share for share, _ in inside(300)) >= 0.94


SEARCH = fz.GeneticPhase(iterations=3, population=20)
SMALL = {
    "stage_1": SEARCH,
    "stage_2": fz.GeneticPhase(iterations=2, population=10),
    "episodes": 5,
    "max_time": 20.0,
}
EXPERIMENTS = {
    "table-8-2": None,
    "table-8-9": replace(two(), **SMALL),
    "table-8-13": three(),
    "table-8-14": replace(three(), **SMALL),
    "section-8-5-scaling": ScalingConfig(sizes=(2, 8), episodes=(1, 20)),
}


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_tables_run_and_draw(name, tmp_path, drawn):
    config = EXPERIMENTS[name]
    experiment = find(name)() if config is None else find(name)(config)
    seeds = [3, 4]
    result = reproduce(experiment, seeds, tmp_path)
    written = json.loads((tmp_path / f"{name}.json").read_text(encoding="utf-8"))
    assert written["config"] == json.loads(json.dumps(experiment.config()))
    for path in drawn(experiment, tmp_path):
        assert path.stat().st_size > 500
    # With enough seeds every row has a verdict or says why not.
    assert all(row.verdict and row.reason for row in experiment.rows(result.outcomes * 10))
    for included in experiment.includes:
        assert find(included) is type(experiment)


@cache
def learned_times(name, choice, count):
    """The last capture of robots that learned, and of the pursuers after classical evaders.

    Infinite where not all were caught.
    """
    config, _ = CONFIGS[name]
    coupling = fz.couplings(len(config.game))[choice].tolist()

    def play(seed):
        robots = config.learned_robots(coupling, seed, fz.Control())
        played = [config.play(coupling, those) for those in (robots, (robots[0], "classical"))]
        return [np.inf if one.capture_time is None else one.capture_time for one in played]

    return np.array(over_seeds(play, count)).T


@pytest.mark.reproduction
def test_two_learned_pursuers_catch_classical_evaders_as_fast():
    assert abs(np.median(learned_times("two", 0, 60)[1]) - 9.6) <= 0.5


@pytest.mark.reproduction
@pytest.mark.xfail(strict=True, reason="13 s in the median, not 9.9; a third misses an evader")
def test_three_learned_pursuers_catch_classical_evaders_as_fast():
    assert abs(np.median(learned_times("three", 3, 60)[1]) - 9.9) <= 1.5


@pytest.mark.reproduction
def test_two_learned_pairs_need_as_long_as_classical_ones():
    assert abs(np.median(learned_times("two", 0, 60)[0]) - 9.6) <= 0.5


@pytest.mark.reproduction
@pytest.mark.xfail(strict=True, reason="14 s in the median; a third misses an evader")
def test_three_learned_pairs_need_as_long_as_classical_ones():
    assert abs(np.median(learned_times("three", 3, 60)[0]) - 9.9) <= 1.5


@pytest.mark.reproduction
def test_the_right_coupling_is_learned_on_hundreds_of_seeds():
    for name, (_, right) in CONFIGS.items():
        for reward in ["r_over_T2", "r_over_f"]:
            table = values(name, reward, 300)
            assert (table.argmax(axis=1) == right).mean() >= 0.95


@pytest.mark.reproduction
def test_hundreds_of_pairs_learn_the_best_coupling():
    experiment = find("section-8-5-scaling")()
    game, starts = experiment.settings.draw(100, FIRST_SEED)
    times = game.capture_times(**starts)
    robots = fz.CoupledRobotsTraining(steering="classical")
    learned = fz.learn_coupling(game, fz.PairwiseTraining(robots=robots), **starts)
    best = times[np.arange(100), fz.assign(times, objective="bottleneck")].max()
    # 200 games may leave some of the 10 000 pairs to be tried.
    assert times[np.arange(100), learned.coupling].max() <= best + 0.5


def sets_drawn_by_times(count):
    """Whole-number positions from which classical robots need the times of Table 8.14.

    Nothing is known of Q_CF when they are drawn.
    """
    game, far = fz.ManyOnMany.thesis(3), 12
    offsets = np.array(list(np.ndindex(2 * far + 1, 2 * far + 1)), float) - far
    shape = (2 * far + 1, 2 * far + 1)
    pairs = [[game.pair(i, j).play_many(evader_starts=offsets) for j in range(3)] for i in range(3)]
    times = np.array([[p.capture_time.reshape(shape) for p in row] for row in pairs])
    times = np.where(np.isnan(times), np.inf, times)
    printed = np.array([17.1, np.inf, 17.1, 10.0, np.inf, 13.7])
    caught, rng = np.isfinite(printed), np.random.default_rng(8)
    rows, columns = np.ogrid[:3, :3]
    found = []
    while len(found) < count:
        pursuers, evaders = rng.integers(-6, 7, (2, 200_000, 3, 2))
        x, y = np.moveaxis(evaders[:, None] - pursuers[:, :, None] + far, -1, 0)
        each = times[rows, columns, x, y]
        last = np.stack([each[:, range(3), c].max(axis=1) for c in fz.couplings(3)], axis=1)
        near = abs(last[:, caught] - printed[caught]) <= 0.31
        fits = near.all(axis=1) & np.isinf(last[:, ~caught]).all(axis=1)
        found += zip(pursuers[fits], evaders[fits], strict=True)
    return found[:count]


@pytest.mark.reproduction
def test_the_right_coupling_is_learned_from_positions_drawn_by_times_only():
    settings = three().rewarded("r_over_T2")
    right = [
        fz.learn_coupling(
            fz.ManyOnMany.thesis(3), settings, pursuer_starts=ours, evader_starts=theirs, seed=seed
        ).coupling
        == [1, 2, 0]
        for ours, theirs in sets_drawn_by_times(12)
        for seed in range(FIRST_SEED, FIRST_SEED + 10)
    ]
    assert np.mean(right) >= 0.85
