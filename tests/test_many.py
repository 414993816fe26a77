"""n pursuers against n evaders, and who should go for whom."""

from __future__ import annotations

import itertools
import math
import threading
import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.optimize import linear_sum_assignment

import fuzzyrs as fz

BAD = fz.errors.InvalidValueError

GAME = fz.ManyOnMany.thesis(3)
STARTS = {
    "pursuer_starts": [(-5, -4), (-1, -6), (0, 0)],
    "evader_starts": [(-4, -4), (1, -4), (-3, -1)],
}
CLASSICAL = fz.CoupledRobotsTraining(steering="classical")


def costs(most):
    """Square tables; whole numbers, so that sums are exact and ties are common."""
    sizes = st.integers(1, most)
    return sizes.flatmap(lambda n: arrays(np.float64, (n, n), elements=st.integers(-9, 20)))


def value(table, columns):
    return table[np.arange(len(table)), columns]


@given(costs(12))
def test_the_sum_is_that_of_scipy(table):
    columns = fz.assign(table)
    assert sorted(columns) == list(range(len(table)))
    assert value(table, columns).sum() == table[linear_sum_assignment(table)].sum()


@given(costs(5), st.floats(0, 1), st.randoms(use_true_random=False))
def test_no_permutation_is_better(table, share, random):
    hidden = [random.random() < share for _ in range(table.size)]
    table = np.where(np.reshape(hidden, table.shape), np.inf, table)

    def judged(columns, objective):
        chosen = value(table, list(columns))
        kept = chosen[np.isfinite(chosen)]
        largest = kept.max(initial=-np.inf) if objective == "bottleneck" else 0
        return len(chosen) - len(kept), largest, kept.sum()

    for objective in ["sum", "bottleneck"]:
        every = itertools.permutations(range(len(table)))
        best = min(judged(columns, objective) for columns in every)
        assert judged(fz.assign(table, objective=objective), objective) == best


def test_large_tables_are_as_good_as_scipys():
    rng = np.random.default_rng(5)
    for table in [rng.uniform(size=(300, 300)), rng.integers(0, 30, (200, 200)) / 7]:
        own, theirs = value(table, fz.assign(table)), table[linear_sum_assignment(table)]
        assert own.sum() == pytest.approx(theirs.sum(), rel=1e-12)
        last = value(table, fz.assign(table, objective="bottleneck")).max()
        assert last <= theirs.max()
        # With anything below the bottleneck alone somebody has nobody.
        below = np.where(table < last, 0.0, 1.0)
        assert below[linear_sum_assignment(below)].sum() > 0


def test_costs_that_are_none_are_refused():
    for table, message in [
        ([[1, math.nan], [1, 1]], r"costs\[0, 1\] must be a number"),
        ([[-math.inf]], "got -inf"),
        (np.zeros((2, 3)), r"expected an array of shape \(n, n\)"),
        (np.zeros((0, 0)), "rows of the costs must be at least 1"),
        ([[1e308, -1e308], [0, 0]], "sum of the costs must be finite"),
    ]:
        with pytest.raises(ValueError, match=message):
            fz.assign(table)
    with pytest.raises(fz.errors.UnknownNameError, match='did you mean "bottleneck"'):
        fz.assign([[1]], objective="botleneck")


def test_couplings_are_those_of_table_8_5():
    assert fz.couplings(3).tolist() == [list(c) for c in itertools.permutations(range(3))]
    assert fz.couplings(8).shape == (40320, 8)
    with pytest.raises(BAD, match="learn pair by pair"):
        fz.couplings(9)


def test_pairs_play_their_own_games():
    times = GAME.capture_times(**STARTS)
    for i, j in itertools.product(range(3), repeat=2):
        alone = GAME.pair(i, j).play(
            evader_start=STARTS["evader_starts"][j], pursuer_start=STARTS["pursuer_starts"][i]
        )
        assert times[i, j] == (math.inf if alone.capture_time is None else alone.capture_time)
    for coupling in fz.couplings(3).tolist():
        played = GAME.play(coupling, **STARTS)
        expected = value(times, coupling)
        assert played.coupling == coupling
        np.testing.assert_array_equal(played.capture_times, expected)
        assert played.escaped == np.isinf(expected).sum()
        assert played.captured == (played.escaped == 0) == (played.capture_time is not None)
        assert played.duration == min(expected.max(), 60)
        assert len(played) == len(played.pairs) == 3
        for i, j in enumerate(coupling):
            pair = played.pairs[i]
            np.testing.assert_array_equal(pair.pursuer, played.pursuers[i])
            np.testing.assert_array_equal(pair.evader, played.evaders[j])
    assert "1 of 3 not captured in 60.0 s" in repr(GAME.play([0, 2, 1], **STARTS))
    fz.plot.paths(GAME.play([1, 2, 0], **STARTS), capture_radius=0.1)


def test_robots_may_each_have_a_controller():
    slow = fz.PD(0.1, 0)
    some = GAME.capture_times(**STARTS, pursuers=["classical", slow, "classical"])
    all_slow = GAME.capture_times(**STARTS, pursuers=slow)
    classical = GAME.capture_times(**STARTS)
    np.testing.assert_array_equal(some[[0, 2]], classical[[0, 2]])
    np.testing.assert_array_equal(some[1], all_slow[1])
    assert (some[1] != classical[1]).any()
    with pytest.raises(ValueError, match="controllers of the evaders: expected 3, got 2"):
        GAME.play([0, 1, 2], **STARTS, evaders=["classical"] * 2)


def test_what_is_no_game_is_refused():
    robot = fz.Vehicle(1, 0.3, 0.5)
    for robots, message in [
        (([], []), "number of pursuers must be at least 1"),
        (([robot] * 2, [robot]), "evaders, one for each pursuer: expected 2, got 1"),
        (([robot], [robot] * 2), "expected 1, got 2"),
    ]:
        with pytest.raises(ValueError, match=message):
            fz.ManyOnMany(*robots)
    with pytest.raises(TypeError, match="evaders must be a list of Vehicle"):
        fz.ManyOnMany([robot], ["classical"])
    for coupling, message in [
        ([0, 1], "partners of a coupling: expected 3, got 2"),
        ([0, 1, 1], "partner 1 is taken twice"),
        ([0, 1, 3], "partners are numbered from 0 to 2"),
        ([0, 1, -1], r"coupling\[2\] must be a whole number, 0 or more, got -1"),
    ]:
        with pytest.raises(ValueError, match=message):
            GAME.play(coupling, **STARTS)
    with pytest.raises(TypeError, match="list of whole numbers"):
        GAME.play(3, **STARTS)
    with pytest.raises(BAD, match="robots 1: starting y of the evader must be finite"):
        GAME.capture_times(**{**STARTS, "evader_starts": [(0, 0), (0, math.nan), (0, 0)]})
    with pytest.raises(ValueError, match="starts of the pursuers: expected 3, got 1"):
        GAME.capture_times(**{**STARTS, "pursuer_starts": [(0, 0)]})
    with pytest.raises(BAD, match="below 3"):
        GAME.pair(3, 0)


def test_robots_may_start_in_one_place():
    same = {"pursuer_starts": np.zeros((3, 2)), "evader_starts": np.zeros((3, 2))}
    assert (GAME.capture_times(**same) == 0).all()
    learned = fz.learn_coupling(GAME, fz.CouplingTraining(episodes=5), **same)
    assert np.isfinite(learned.values).all()
    assert (learned.durations == 0).all()


def cockayne(pursuer, evader):
    """The conditions of the theorem, in the form of turning radii."""
    if pursuer.speed <= evader.speed:
        return "hopeless"
    force = [robot.speed**2 / robot.turning_radius for robot in (pursuer, evader)]
    return "certain" if force[0] >= force[1] else "not guaranteed"


def test_pairs_that_may_not_capture_are_recognised():
    for game in [GAME, fz.ManyOnMany.thesis(2)]:
        expected = [[cockayne(p, e) for e in game.evaders] for p in game.pursuers]
        assert game.prospects() == expected
    assert GAME.prospects()[2] == ["certain", "hopeless", "not guaranteed"]


def test_a_hopeless_game_is_legal_and_says_so():
    slow, fast = fz.Vehicle(1, 0.3, 0.5), fz.Vehicle(2, 0.3, 0.5)
    game = fz.ManyOnMany([slow, fast], [fast, fast])
    assert {word for row in game.prospects() for word in row} == {"hopeless"}
    starts = {"pursuer_starts": [(0, 0), (0, 1)], "evader_starts": [(3, 0), (3, 1)]}
    played = game.play([0, 1], **starts, max_time=20)
    assert (played.captured, played.escaped, played.capture_time) == (False, 2, None)
    assert np.isinf(game.capture_times(**starts, max_time=20)).all()
    for settings in [fz.CouplingTraining(episodes=3), fz.PairwiseTraining(episodes=3)]:
        learned = fz.learn_coupling(game, settings, **starts)
        assert sorted(learned.coupling) == [0, 1]
        assert (learned.captured < 2).all()


@pytest.mark.parametrize("settings", [fz.CouplingTraining, fz.PairwiseTraining])
def test_results_have_their_shapes_and_do_not_depend_on_threads(settings):
    few = settings(episodes=12)
    one, two = (fz.learn_coupling(GAME, few, **STARTS, seed=9, threads=t) for t in (1, 2))
    shape = (6,) if settings is fz.CouplingTraining else (3, 3)
    assert one.values.shape == one.visits.shape == shape
    assert one.visits.sum() == 12 * (1 if len(shape) == 1 else 3)
    assert one.couplings.shape == (12, 3)
    assert one.learning_time == pytest.approx(one.durations.sum())
    for name in ["values", "visits", "couplings", "durations", "captured"]:
        np.testing.assert_array_equal(getattr(one, name), getattr(two, name))
    assert one.coupling == two.coupling
    assert "12 episodes" in repr(one)


def test_the_table_is_updated_as_it_is_written():
    """Q_CF by NumPy, from the games that were played."""
    settings = fz.CouplingTraining(episodes=40, robots=CLASSICAL, reward="r_over_f")
    learned = fz.learn_coupling(GAME, settings, **STARTS, seed=2)
    table, visits, all_couplings = np.zeros(6), np.zeros(6), fz.couplings(3).tolist()
    for coupling, duration in zip(learned.couplings.tolist(), learned.durations, strict=True):
        choice = all_couplings.index(coupling)
        steps = round(duration / GAME.time_step)
        played = GAME.play(coupling, **STARTS)
        reward = sum(pair.reward.sum() for pair in played.pairs) / steps
        visits[choice] += 1
        table[choice] += visits[choice] ** -0.7 * (reward - table[choice])
    np.testing.assert_allclose(learned.values, table, atol=1e-9)
    np.testing.assert_array_equal(learned.visits, visits)


def random_game(size, seed):
    rng = np.random.default_rng([seed, size])
    game = fz.ManyOnMany(
        [fz.Vehicle(v, 0.3, 0.5) for v in rng.uniform(1.5, 2.5, size)],
        [fz.Vehicle(v, 0.3, 0.5) for v in rng.uniform(0.5, 1.0, size)],
    )
    half = 3 * math.sqrt(size)
    starts = {
        "pursuer_starts": rng.uniform(-half, half, (size, 2)),
        "evader_starts": rng.uniform(-half, half, (size, 2)),
    }
    return game, starts


@pytest.mark.parametrize("objective", ["sum", "bottleneck"])
@pytest.mark.parametrize("size", [1, 4, 9])
def test_optimism_learns_the_assignment_on_the_capture_times(size, objective):
    for seed in range(5):
        game, starts = random_game(size, seed)
        times = game.capture_times(**starts)
        settings = fz.PairwiseTraining(robots=CLASSICAL, objective=objective, episodes=150)
        learned = fz.learn_coupling(game, settings, **starts)
        best = value(times, fz.assign(times, objective=objective))
        own = value(times, learned.coupling)
        measure = np.sum if objective == "sum" else np.max
        assert measure(own) == pytest.approx(measure(best))
        tried = learned.visits > 0
        np.testing.assert_allclose(learned.values[tried], times[tried])
        # First estimates are lower than any time.
        assert (learned.values[~tried] <= times[~tried]).all()


def test_settings_that_make_no_sense_are_refused():
    for settings, message in [
        (fz.CouplingTraining(episodes=0), "episodes must be at least 1"),
        (fz.CouplingTraining(steps=0), "steps must be at least 1"),
        (fz.CouplingTraining(temperature=0.0), "temperature of the couplings must be positive"),
        (fz.CouplingTraining(learning_rate=2.0), "learning rate of the couplings"),
        (fz.PairwiseTraining(confidence=-1.0), "confidence must be zero or more"),
        (fz.PairwiseTraining(exploration="softmax", temperature=0.0), "temperature must be"),
        (fz.CouplingTraining(robots={"action_step": 0.0}), "distance of steering angles"),
        (fz.CouplingTraining(robots={"exploration": 0.0}), "temperature must be positive"),
        (fz.PairwiseTraining(robots={"discount": math.nan}), "discount must be finite"),
    ]:
        with pytest.raises(BAD, match=message):
            fz.learn_coupling(GAME, settings, **STARTS)
    with pytest.raises(TypeError, match="settings must be CouplingTraining or PairwiseTraining"):
        fz.learn_coupling(GAME, fz.QLambdaTraining(), **STARTS)
    with pytest.raises(fz.errors.UnknownNameError, match="reward of couplings"):
        fz.CouplingTraining(reward="r")
    game, starts = random_game(9, 0)
    with pytest.raises(BAD, match="learn pair by pair"):
        fz.learn_coupling(game, fz.CouplingTraining(), **starts)


def test_learning_can_be_watched_and_stopped():
    seen = []
    fz.learn_coupling(GAME, fz.PairwiseTraining(episodes=4), **STARTS, progress=seen.append)
    assert seen[-1] == 4 * 3
    control = fz.Control()
    threading.Thread(target=lambda: (time.sleep(0.1), control.cancel())).start()
    with pytest.raises(fz.errors.CancelledError):
        fz.learn_coupling(GAME, fz.CouplingTraining(episodes=10**7), **STARTS, control=control)


def test_steering_angles_are_those_of_tables_8_2_and_8_3():
    angles = fz.Vehicle(1.2, 0.3, 0.6).steering_angles()
    np.testing.assert_allclose(angles, np.arange(-6, 7) / 10, atol=1e-15)
    with pytest.raises(BAD, match="distance of steering angles must be above 0 and"):
        fz.Vehicle(1.2, 0.3, 0.6).steering_angles(0)


def test_agents_may_explore_by_softmax():
    grid = fz.Discretiser([(-1, 1, 5)])
    agent = fz.QLambdaAgent(grid, [-0.5, 0.0, 0.5], exploring="softmax", exploration=0.5, seed=1)
    acts = [float(agent.act([0.0])[0]) for _ in range(300)]
    assert len(set(acts)) > 1
    again = type(agent).from_json(agent.to_json())
    assert again.to_json() == agent.to_json()
    with pytest.raises(BAD, match="temperature must be positive"):
        fz.QLambdaAgent(grid, [-0.5, 0.5], exploring="softmax", exploration=0.0)


def test_a_hopeless_coupling_says_so():
    game = fz.ManyOnMany([fz.Vehicle(0.5, 0.3, 0.5)] * 2, [fz.Vehicle(1.0, 0.3, 0.5)] * 2)
    starts = {"pursuer_starts": [(0, 0), (1, 0)], "evader_starts": [(3, 0), (4, 0)]}
    robots = fz.CoupledRobotsTraining(steering="classical")
    for settings in (fz.CouplingTraining, fz.PairwiseTraining):
        learned = fz.learn_coupling(game, settings(robots=robots, episodes=3, steps=50), **starts)
        assert learned.hopeless == [0, 1]
        assert repr(learned).endswith("after 3 episodes, 2 of its pairs hopeless>")
        assert not learned.captured.any()


@pytest.mark.parametrize("settings", [fz.CouplingTraining, fz.PairwiseTraining])
def test_a_learner_of_couplings_must_learn(settings):
    starts = {"pursuer_starts": [(2, 4), (-4, 5)], "evader_starts": [(0, 4), (-1, 0)]}
    with pytest.raises(fz.errors.InvalidValueError, match="must be above 0 and at most 1, got 0"):
        fz.learn_coupling(fz.ManyOnMany.thesis(2), settings(learning_rate=0.0), **starts)


@pytest.mark.parametrize("coupling", [[0.0, 1.0], "01", [[0], [1]]])
def test_a_coupling_of_other_things_names_the_place(coupling):
    starts = {"pursuer_starts": [(2, 4), (-4, 5)], "evader_starts": [(0, 4), (-1, 0)]}
    with pytest.raises(
        fz.errors.InvalidTypeError, match=r"coupling\[[01]\] must be a whole number"
    ):
        fz.ManyOnMany.thesis(2).play(coupling, **starts)


def test_crews_may_be_tuples():
    starts = {"pursuer_starts": [(2, 4), (-4, 5)], "evader_starts": [(0, 4), (-1, 0)]}
    game = fz.ManyOnMany.thesis(2)
    crews = {"pursuers": ("classical", "classical"), "evaders": ["classical", "classical"]}
    assert game.play([0, 1], **starts, **crews).capture_time == 9.6
