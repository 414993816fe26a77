"""Two pursuers, one evader: printed starts, the oracle's paths, one game and many, training."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fuzzyrs as fz
import oracle
import two_oracle

STARTS = [
    [(-3, -6), (4, -4)],
    [(-4, 3), (5, -2)],
    [(-3, 6), (-2, -5)],
    [(-4, 5), (3, 4)],
    [(-6, -2), (5, 3)],
    [(-5, 3), (-2, 6)],
]
AIMS = ["line-of-sight", "intercept", "intercept-flight"]
FLIGHTS = ["weighted", "weighted-units", "nearest", "sum", "sum-of-units"]
CLASSICAL = {
    "line-of-sight": [27.2, 18.7, 21.8, 23.9, 20.5, 28.2],
    "intercept": [26.9, 16.2, 19.9, 23.8, 16.8, 28.0],
    "intercept-flight": [26.7, 15.0, 19.9, 23.6, 16.8, 27.9],
}
PRINTED = [26.4, 20.7, 22.2, 25.7, 21.3, 28.4]


@pytest.mark.parametrize(("aim", "times"), CLASSICAL.items())
def test_classical_capture_times_are_those_of_the_equations(aim, times):
    outcomes = fz.TwoPursuers(aim=aim).play_many(pursuer_starts=STARTS)
    assert outcomes.capture_time.tolist() == times
    assert repr(outcomes) == "<Outcomes: 6 of 6 captured>"


def test_classical_times_are_near_the_print_and_prediction_is_faster_in_all():
    plain, predicted = np.array(CLASSICAL["line-of-sight"]), np.array(CLASSICAL["intercept"])
    assert abs(plain - PRINTED).max() <= 2.1
    assert (predicted < plain).all()
    assert (np.array(CLASSICAL["intercept-flight"]) < plain).all()


def check_path(played, path):
    """The trajectory is the oracle's."""
    robots = np.array(path.robots)
    np.testing.assert_allclose(played.pursuers, robots[:, :2].swapaxes(0, 1), rtol=0, atol=1e-6)
    np.testing.assert_allclose(played.evader, robots[:, 2], rtol=0, atol=1e-6)
    steering = np.vstack([played.pursuer_steering, played.evader_steering]).T
    np.testing.assert_allclose(steering, path.steering, rtol=0, atol=1e-6)
    assert played.captured == path.captured


@pytest.mark.parametrize("kind", FLIGHTS)
@pytest.mark.parametrize("aim", AIMS)
def test_classical_games_take_the_path_of_the_equations(aim, kind):
    game = fz.TwoPursuers(aim=aim, flight=kind)
    for starts, evader in [(STARTS[0], (0, 0)), ([(-2, 1, 2.0), (1, 4, -1.0)], (0.5, -0.3, 1.0))]:
        played = game.play(pursuer_starts=starts, evader_start=evader, max_time=12)
        strategies = [oracle.classical] * 3
        check_path(played, two_oracle.play(starts, evader, aim, kind, strategies, steps=120))


def test_each_robot_may_have_a_controller_of_its_own(steer):
    def steering(angle, rate):
        shapes = [["gaussian"] * 3] * 2
        return oracle.tsk(shapes, 0, steer.parameters, np.clip([angle, rate], -1, 1))

    fuzzy = fz.FuzzyController(steer, angle_limit=1, rate_limit=1)
    pd = fz.PD(0.9, 0.2)
    game = fz.TwoPursuers(aim="intercept")
    played = game.play((fuzzy, pd), fuzzy, pursuer_starts=STARTS[1], max_time=8)
    strategies = [steering, lambda angle, rate: 0.9 * angle + 0.2 * rate, steering]
    path = two_oracle.play(STARTS[1], (0, 0), "intercept", "weighted", strategies, steps=80)
    check_path(played, path)
    both = game.play(fuzzy, pursuer_starts=STARTS[1], max_time=8)
    assert np.array_equal(
        both.pursuers,
        game.play([fuzzy] * 2, pursuer_starts=STARTS[1]).pursuers[:, : both.pursuers.shape[1]],
    )


def test_arrays_of_a_trajectory_fit_together():
    game = fz.TwoPursuers(pursuers=(fz.Vehicle(0.5, 0.2, 0.5), fz.Vehicle(0.7, 0.2, 0.4)))
    played = game.play(pursuer_starts=[(-4, 3), (5, -2)], evader_start=(1, 0, 0.5))
    n = played.evader_steering.size
    assert played.time.tolist() == [round(0.1 * k, 9) for k in range(n + 1)]
    assert played.pursuers.shape == (2, n + 1, 3)
    assert played.evader.shape == (n + 1, 3)
    assert played.pursuer_steering.shape == played.reward.shape == (2, n)
    between = played.evader[:, :2] - played.pursuers[:, :, :2]
    np.testing.assert_allclose(played.distance, np.hypot(*between.T).T, atol=1e-12)
    most = np.array([[0.5 + 0.3], [0.7 + 0.3]]) * game.time_step
    np.testing.assert_allclose(played.reward, -np.diff(played.distance) / most, atol=1e-12)
    assert played.capture_time == played.duration == played.time[-1]
    assert played.captor == played.distance[:, -1].argmin()
    assert played.distance[played.captor, -1] < 0.1 <= played.distance[:, :-1].min()
    assert played.miss_distance == played.distance.min()
    assert repr(played).startswith(f"<TwoPursuersTrajectory: captured after {played.duration} s")


def test_a_slow_pair_catches_nobody():
    slow = fz.TwoPursuers(fz.Vehicle(0.2, 0.2, 0.5), aim="intercept")
    played = slow.play(pursuer_starts=[(3, 1), (4, -2)], evader_start=(0, 0, 3.0), max_time=5)
    assert (played.captured, played.captor, played.capture_time) == (False, None, None)
    plain = fz.TwoPursuers(fz.Vehicle(0.2, 0.2, 0.5))
    same = plain.play(pursuer_starts=[(3, 1), (4, -2)], evader_start=(0, 0, 3.0), max_time=5)
    np.testing.assert_array_equal(played.pursuers, same.pursuers)


def test_robots_may_start_in_one_place_and_who_is_caught_at_the_start_does_not_move():
    played = fz.TwoPursuers(aim="intercept").play(pursuer_starts=[(0, 0), (0, 0)])
    assert (played.capture_time, played.captor, played.reward.shape) == (0.0, 0, (2, 0))
    together = fz.TwoPursuers().play(pursuer_starts=[(2, 1), (2, 1)])
    np.testing.assert_array_equal(*together.pursuers)


poses = st.tuples(st.floats(-6, 6), st.floats(-6, 6), st.floats(-4, 4))


@settings(max_examples=25)
@given(
    st.lists(st.tuples(poses, poses), min_size=1, max_size=12),
    poses,
    st.sampled_from(AIMS),
    st.sampled_from(FLIGHTS),
)
def test_many_games_equal_single_ones_to_the_bit(steer, starts, evader, aim, kind):
    game = fz.TwoPursuers(aim=aim, flight=kind, capture="swept")
    players = ((fz.FuzzyController(steer, angle_limit=1, rate_limit=1), "classical"), "bang-bang")
    many = game.play_many(*players, pursuer_starts=starts, evader_start=evader, max_time=4)
    for index, start in enumerate(starts):
        played = game.play(*players, pursuer_starts=start, evader_start=evader, max_time=4)
        assert many.captured[index] == played.captured
        assert many.duration[index] == played.duration
        assert many.miss_distance[index] == played.miss_distance


@settings(max_examples=40)
@given(poses, poses, poses, st.sampled_from(AIMS), st.sampled_from(FLIGHTS))
def test_any_start_gives_finite_numbers(first, second, evader, aim, kind):
    game = fz.TwoPursuers(aim=aim, flight=kind)
    for starts in ([first, second], [first, first], [evader, second], [evader, evader]):
        played = game.play(pursuer_starts=starts, evader_start=evader, max_time=2)
        assert all(
            np.isfinite(a).all() for a in (played.pursuers, played.evader, played.evader_steering)
        )


def test_defaults_are_the_game_of_section_8_4():
    game = fz.TwoPursuers()
    assert game.pursuers == (fz.Vehicle(0.5, 0.2, 0.5),) * 2
    assert game.evader == fz.Vehicle(0.3, 0.2, 0.8)
    assert (game.capture_radius, game.time_step, game.capture) == (0.1, 0.1, "sampled")
    assert (game.aim, game.flight) == ("line-of-sight", "weighted")
    assert eval(repr(game), vars(fz)) == game
    assert game.to_dict()["pursuers"][0] == game.pursuers[0].to_dict()


def test_what_no_game_can_be_is_refused_in_words():
    game, robot = fz.TwoPursuers(), fz.Vehicle(1, 0.2, 0.5)
    with pytest.raises(fz.errors.UnknownNameError, match='did you mean "intercept"'):
        fz.TwoPursuers(aim="intercep")
    with pytest.raises(fz.errors.UnknownNameError, match="nearest"):
        fz.TwoPursuers(flight="near")
    with pytest.raises(fz.errors.ShapeError, match="pursuers: expected one or two, got 3"):
        fz.TwoPursuers([robot] * 3)
    with pytest.raises(fz.errors.InvalidTypeError, match="a Vehicle or two of them, got int"):
        fz.TwoPursuers([robot, 3])
    parked = fz.Vehicle(0, 0.2, 0.5)
    with pytest.raises(fz.errors.InvalidValueError, match="second pursuer and the evader"):
        fz.TwoPursuers([robot, parked], parked)
    for starts in [(1, 2), [(1, 2)], [(1, 2)] * 3, [[(1, 2), (3, 4)]]]:
        with pytest.raises(fz.errors.ShapeError, match="perhaps a heading for both pursuers, got"):
            game.play(pursuer_starts=starts)
    with pytest.raises(fz.errors.ShapeError, match="for each start"):
        game.play_many(pursuer_starts=[(1, 2), (3, 4)])
    with pytest.raises(fz.errors.InvalidValueError, match="starting y of the first pursuer"):
        game.play(pursuer_starts=[(1, np.nan), (2, 3)])
    with pytest.raises(fz.errors.InvalidTypeError, match="the pursuer must be"):
        game.play(["classical", 3], pursuer_starts=STARTS[0])
    with pytest.raises(fz.errors.ShapeError, match="pursuers' controllers: expected one or two"):
        game.play(["classical"] * 3, pursuer_starts=STARTS[0])
    with pytest.raises(fz.errors.InvalidValueError, match="max_time"):
        game.play(pursuer_starts=STARTS[0], max_time=0)
    assert len(game.play_many(pursuer_starts=np.empty((0, 2, 2)))) == 0


def small(**changes):
    """Settings with which all three learn in milliseconds."""
    phase = {"iterations": 8, "population": 20, "crossover": 0.2, "mutation": 0.3}
    chosen = {
        "phase_1": fz.TwoPursuersQLambdaTraining(episodes=20, steps=600),
        "stage_1": phase,
        "stage_2": {**phase, "population": 10, "fresh_mutants": False},
        "steps": 100,
        **changes,
    }
    return fz.TwoPursuersQlbgflcTraining(**chosen)


def test_defaults_of_the_training_are_table_8_1():
    chosen = fz.TwoPursuersQlbgflcTraining().to_dict()
    assert (chosen["phase_1"]["episodes"], chosen["phase_1"]["exploration"]) == (2000, 1.0)
    assert [*chosen["stage_1"].values()] == [1000, 100, 0.2, 0.3, True]
    assert [*chosen["stage_2"].values()] == [500, 10, 0.4, 0.2, False]
    assert (chosen["steps"], chosen["starts_per_generation"]) == (600, 4)


def test_all_three_robots_learn_and_the_same_seed_teaches_the_same():
    game = fz.TwoPursuers(aim="intercept")
    done = []
    first = fz.train(game, small(), seed=3, progress=done.append)
    assert done[-1] == 20 + 3 * 8 + 8
    second = fz.train(game, small(), seed=3)
    assert first.pursuers == second.pursuers
    assert first.evader == second.evader != fz.train(game, small(), seed=4).evader
    names = [robot.system.name for robot in (*first.pursuers, first.evader)]
    assert names == ["first pursuer", "second pursuer", "evader"]
    assert [*first.history] == [
        "duration of the games [s]",
        *(f"{name}: stage 1: least mean squared error" for name in names),
        *(f"{name}: stage 2: least capture time [s]" for name in names[:2]),
        "evader: stage 2: largest capture time [s]",
    ]
    assert first.learning_time > first.history["duration of the games [s]"].sum()
    game.play(first.pursuers, first.evader, pursuer_starts=STARTS[0])
    assert repr(first).startswith("<TwoPursuersTrained in")


def test_tables_alone_learn_by_q_lambda():
    trained = fz.train(fz.TwoPursuers(), fz.TwoPursuersQLambdaTraining(episodes=30), seed=1)
    tables = (*trained.pursuers, trained.evader)
    assert [len(table.angles) for table in tables] == [121] * 3
    for table, most in zip(tables, (0.5, 0.5, 0.8), strict=True):
        tenths = table.angles * 10
        np.testing.assert_allclose(tenths, tenths.round(), atol=1e-12)
        assert abs(table.angles).max() <= most
    assert trained.learning_time == pytest.approx(trained.history.popitem()[1].sum())


def test_stage_2_is_done_anew_from_what_was_begun():
    game, settings = fz.TwoPursuers(), small()
    first = fz.train(game, settings, seed=3)
    other = fz.TwoPursuersQlbgflcTraining(**{**settings.to_dict(), "starts_per_generation": 1})
    anew, begun = fz.train(game, other, seed=3), fz.train(game, other, seed=3, begun=first)
    assert (begun.pursuers, begun.evader) == (anew.pursuers, anew.evader)
    assert begun.learning_time == anew.learning_time
    assert {k: v.tolist() for k, v in begun.history.items()} == {
        k: v.tolist() for k, v in anew.history.items()
    }
    tables = fz.TwoPursuersQLambdaTraining(**settings.phase_1.to_dict())
    alone = fz.train(game, tables, seed=3)
    assert first.tables is not None
    assert (first.tables.pursuers, first.tables.evader) == (alone.pursuers, alone.evader)
    assert alone.tables is None

    longer = {**settings.to_dict(), "phase_1": fz.TwoPursuersQLambdaTraining(episodes=21)}
    with pytest.raises(ValueError, match="its phase 1 must be the same"):
        fz.train(game, fz.TwoPursuersQlbgflcTraining(**longer), seed=3, begun=first)
    with pytest.raises(ValueError, match="its seed must be the same"):
        fz.train(game, other, seed=4, begun=first)
    with pytest.raises(ValueError, match="its game must be the same"):
        fz.train(fz.TwoPursuers(aim="intercept"), other, seed=3, begun=first)
    with pytest.raises(TypeError, match="begun must be what TwoPursuersQlbgflcTraining learned"):
        fz.train(game, other, seed=3, begun=alone)
    with pytest.raises(TypeError, match="begun is for a TwoPursuers"):
        fz.train(fz.OneOnOne(), fz.QLambdaTraining(), begun=first)  # type: ignore[call-overload]


def test_both_pairings_and_both_kinds_of_mutants_differ():
    game = fz.TwoPursuers()
    variants = [
        {},
        {"pairing": "place"},
        {"stage_2": {"iterations": 8, "population": 10, "crossover": 0.2, "mutation": 0.3}},
        {"starts_per_generation": 1},
    ]
    times = [fz.train(game, small(**change), seed=5).learning_time for change in variants]
    assert len(set(times)) == len(times)


def test_trainings_that_make_no_sense_are_refused_in_words():
    game, errors = fz.TwoPursuers(), fz.errors
    with pytest.raises(errors.InvalidTypeError, match="TwoPursuersQlbgflcTraining for a TwoPurs"):
        fz.train(game, fz.QlbgflcTraining())
    with pytest.raises(errors.InvalidTypeError, match="IgbflcTraining for a OneOnOne, got TwoP"):
        fz.train(fz.OneOnOne(), small())
    with pytest.raises(errors.InvalidTypeError, match="evader is for a OneOnOne"):
        fz.train(game, small(), evader="classical")
    with pytest.raises(errors.InvalidValueError, match="starts of a generation must be between"):
        fz.train(game, small(starts_per_generation=0))
    with pytest.raises(errors.InvalidValueError, match="clearance of the starts must be between 0"):
        fz.train(game, fz.TwoPursuersQLambdaTraining(spread=1, clearance=2))
    with pytest.raises(errors.InvalidValueError, match="first pursuer: number of steering"):
        fz.train(game, fz.TwoPursuersQLambdaTraining(action_step=1e-12))
    with pytest.raises(errors.InvalidValueError, match="starts of a generation must be between"):
        fz.train(fz.OneOnOne(), fz.QlbgflcTraining(starts_per_generation=10**9))
    control = fz.Control()
    control.cancel()
    with pytest.raises(errors.CancelledError):
        fz.train(game, fz.TwoPursuersQlbgflcTraining(), control=control)


def test_a_pursuit_of_one_may_be_judged_from_several_starts():
    game, phase = fz.OneOnOne(), fz.GeneticPhase(iterations=5, population=10)
    base = {"stage_2": phase, "prepared": False, "steps": 100}
    one, four = (fz.QlbgflcTraining(**base, starts_per_generation=n) for n in (1, 4))
    for evader in ({}, {"evader": "settings"}):
        trained = [
            fz.train(game, s, seed=2, **({"evader": s} if evader else {})) for s in (one, four)
        ]
        assert trained[0].controller != trained[1].controller
        assert trained[1].learning_time > 2 * trained[0].learning_time
    best = fz.train(game, four, seed=2).history["stage 2: least capture time [s]"]
    # Means of four captures in tenths of seconds.
    np.testing.assert_allclose(best * 40, (best * 40).round(), atol=1e-9)


def test_a_table_of_both_robots_angles_has_no_place_among_three():
    grid = fz.Discretiser([(-1, 1, 2)] * 2)
    mixed = fz.MixedTableController(grid, [-0.1, 0.1], [[0.5, 0.5]] * 4)
    game = fz.TwoPursuers()
    for robots in ({"evader": mixed}, {"pursuers": ("classical", fz.Parallel(mixed, "classical"))}):
        with pytest.raises(fz.errors.InvalidTypeError, match="can't be a MixedTableController"):
            game.play(**robots, pursuer_starts=STARTS[0])
