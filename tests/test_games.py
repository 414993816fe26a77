"""Games: published times, the oracle's paths, one game and many."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fuzzyrs as fz
import oracle

PUBLISHED = {(-6, 7): 9.6, (-7, -7): 10.4, (2, 4): 4.5, (3, -8): 8.5}


@pytest.mark.parametrize(("start", "time"), PUBLISHED.items())
def test_classical_players_need_exactly_the_published_time(game, start, time):
    played = game.play("classical", "classical", evader_start=start)
    assert played.captured
    assert played.capture_time == time


def test_many_games_have_the_published_times_too(game):
    outcomes = game.play_many(evader_starts=list(PUBLISHED))
    assert outcomes.capture_time.tolist() == list(PUBLISHED.values())
    assert outcomes.captured.all()
    assert len(outcomes) == 4
    assert repr(outcomes) == "<Outcomes: 4 of 4 captured>"


def check_path(played, path):
    """The trajectory is the oracle's."""
    for robot, poses in [(played.pursuer, path.pursuer), (played.evader, path.evader)]:
        np.testing.assert_allclose(robot, poses, rtol=0, atol=1e-9)
    steering = np.column_stack([played.pursuer_steering, played.evader_steering])
    np.testing.assert_allclose(steering, path.steering, rtol=0, atol=1e-9)
    np.testing.assert_allclose(played.distance, path.distance, rtol=0, atol=1e-9)
    assert played.captured == path.captured


@pytest.mark.parametrize("start", [*PUBLISHED, (5, 0.5), (-4, 0, 1.0), (-3, -6, -2.5)])
def test_classical_games_take_the_path_of_the_equations(game, start):
    check_path(game.play(evader_start=start), oracle.play(start))


@pytest.mark.parametrize("start", [(2, 4), (3, -8), (-6, 7)])
def test_fuzzy_pursuers_take_the_path_of_the_equations(game, steer, start):
    shapes = [["gaussian"] * 3] * 2

    def steering(angle, rate):
        inputs = np.clip(angle, -1, 1), np.clip(rate, -0.8, 0.8)
        return oracle.tsk(shapes, 0, steer.parameters, inputs)

    pursuer = fz.FuzzyController(steer, angle_limit=1.0, rate_limit=0.8)
    played = game.play(pursuer, evader_start=start, max_time=5)
    check_path(played, oracle.play(start, steering, steps=50))


def test_tables_are_looked_up_by_the_nearest_point(game):
    grid = fz.Discretiser([(-1, 1, 5), (-1, 1, 3)])
    angles = np.linspace(-0.5, 0.5, 15)

    def steering(angle, rate):
        row = np.floor((np.clip(angle, -1, 1) + 1) / 0.5 + 0.5)
        column = np.floor((np.clip(rate, -1, 1) + 1) / 1.0 + 0.5)
        return angles[int(3 * row + column)]

    played = game.play(fz.TableController(grid, angles), evader_start=(2, 4), max_time=3)
    check_path(played, oracle.play((2, 4), steering, steps=30))


def test_both_robots_may_be_controlled_and_a_plain_system_has_no_limits(game, steer):
    limitless = fz.FuzzyController(steer)
    assert limitless.angle_limit == limitless.rate_limit == np.inf
    by_system = game.play(steer, steer, evader_start=(2, 4), max_time=5)
    by_controller = game.play(limitless, limitless, evader_start=(2, 4), max_time=5)
    np.testing.assert_array_equal(by_system.evader, by_controller.evader)
    assert not np.array_equal(by_system.evader, game.play(evader_start=(2, 4)).evader)


def test_a_pursuer_whose_rules_are_silent_drives_straight_ahead(game):
    far = {"far": fz.triangular(50, 51, 52)}
    silent = fz.TSK([fz.Variable("a", (0, 9), far), fz.Variable("b", (0, 9), far)], [0.4])
    played = game.play(silent, evader_start=(2, 4), max_time=1)
    assert not played.pursuer_steering.any()
    turning = fz.TSK(silent.inputs, [0.4], no_rule_fires=0.2)
    played = game.play(turning, evader_start=(2, 4), max_time=1)
    assert (played.pursuer_steering == 0.2).all()


def test_arrays_of_a_trajectory_fit_together(game):
    played = game.play(evader_start=(2, 4, 0.5), pursuer_start=(1, -1, 3.0))
    n = len(played.reward)
    assert played.time.shape == played.distance.shape == (n + 1,)
    assert played.pursuer.shape == played.evader.shape == (n + 1, 3)
    assert played.pursuer_steering.shape == played.evader_steering.shape == (n,)
    assert played.pursuer[0].tolist() == [1.0, -1.0, 3.0]
    assert played.evader[0].tolist() == [2.0, 4.0, 0.5]
    assert played.time.tolist() == [round(0.1 * k, 9) for k in range(n + 1)]
    assert played.capture_time == played.time[-1]
    assert played.distance[-1] < game.capture_radius <= played.distance[:-1].min()
    assert played.miss_distance == played.distance.min()
    most = (game.pursuer.speed + game.evader.speed) * game.time_step
    np.testing.assert_allclose(played.reward, -np.diff(played.distance) / most, atol=1e-12)
    assert repr(played).startswith(f"<Trajectory: captured after {played.capture_time} s, nearest")


def test_who_escapes_has_no_capture_time(game):
    played = game.play(evader_start=(8, 8), max_time=2)
    assert (played.captured, played.capture_time) == (False, None)
    assert len(played.reward) == 20
    assert played.miss_distance == played.distance.min() > 0.1
    assert repr(played).startswith("<Trajectory: not captured in 2.0 s, nearest")
    outcomes = game.play_many(evader_starts=[(8, 8), (0.5, 0)], max_time=2)
    assert outcomes.captured.tolist() == [False, True]
    assert np.isnan(outcomes.capture_time[0])
    assert outcomes.duration[0] == 2.0
    assert outcomes.duration[1] == outcomes.capture_time[1] < 2.0


def test_who_is_caught_at_the_start_does_not_move(game):
    played = game.play(evader_start=(0.05, 0))
    assert (played.capture_time, len(played.reward)) == (0.0, 0)
    assert played.time.tolist() == [0.0]
    assert game.play_many(evader_starts=(0.05, 0)).capture_time.tolist() == [0.0]


def test_a_distance_equal_to_the_radius_is_no_capture():
    game = fz.OneOnOne(capture_radius=0.5)
    assert game.play(evader_start=(0.5, 0), max_time=0.1).capture_time != 0.0
    assert game.play(evader_start=(np.nextafter(0.5, 0), 0)).capture_time == 0.0


starts = st.tuples(st.floats(-9, 9), st.floats(-9, 9), st.floats(-4, 4))


@settings(max_examples=30)
@given(st.lists(starts, min_size=1, max_size=20), st.sampled_from(["classical", "fuzzy", "table"]))
def test_many_games_equal_single_ones_to_the_bit(steer, positions, who):
    game = fz.OneOnOne(capture_radius=0.3)
    grid = fz.Discretiser([(-1, 1, 11), (-1, 1, 11)])
    pursuer = {
        "classical": "classical",
        "fuzzy": fz.FuzzyController(steer, angle_limit=1, rate_limit=1),
        "table": fz.TableController(grid, np.repeat(np.linspace(-0.5, 0.5, 11), 11)),
    }[who]
    outcomes = game.play_many(pursuer, evader_starts=positions, max_time=8)
    for index, start in enumerate(positions):
        played = game.play(pursuer, evader_start=start, max_time=8)
        assert outcomes.captured[index] == played.captured
        assert outcomes.duration[index] == played.time[-1]
        assert outcomes.miss_distance[index] == played.miss_distance


def test_no_games_have_no_outcomes(game):
    outcomes = game.play_many(evader_starts=np.empty((0, 2)))
    assert len(outcomes) == 0
    assert outcomes.capture_time.shape == (0,)


def test_defaults_are_the_game_of_section_6_5_2(game):
    assert game.pursuer == fz.Vehicle(2.0, 0.3, 0.5)
    assert game.evader == fz.Vehicle(1.0, 0.3, 1.0)
    assert (game.capture_radius, game.time_step) == (0.1, 0.1)
    assert game.pursuer.turning_radius == pytest.approx(0.3 / np.tan(0.5), rel=1e-14)


def test_a_game_that_diverges_is_an_error_among_many_too():
    game = fz.OneOnOne(fz.Vehicle(1e308, 1, 0.5), time_step=1)
    with pytest.raises(fz.errors.DivergedError):
        game.play_many(evader_starts=[(1000, 1000)])
