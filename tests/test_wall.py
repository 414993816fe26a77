"""Following a wall: the simulation and the Mamdani controller beside plain NumPy, and bad input."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import fuzzyrs as fz

EXPERT = fz.PD(1.2, 1.5)
PLANT = fz.WallFollowing(fz.Wall.sin())


def nearest(points, x, y):
    """The distance to the nearest of all pieces."""
    start, way = points[:-1], np.diff(points, axis=0)
    square = (way**2).sum(axis=1)  # 0 where a piece is too short for it
    along = (((x, y) - start) * way).sum(axis=1)
    share = np.divide(along, square, out=np.zeros_like(along), where=square > 0)
    foot = start + np.clip(share, 0, 1)[:, None] * way
    return np.hypot(*((x, y) - foot).T).min()


def trapezoids(vertices, x):
    a, b, c, d = np.reshape(vertices, (5, 4)).T
    x = np.asarray(x)[..., None]
    return np.clip(np.minimum((x - a) / (b - a), (d - x) / (d - c)), 0, 1)


def mamdani(error, rate):
    """The thesis's controller, every rule at every sample."""
    tuned = fz.FuzzyRegulator.thesis()
    vertices = tuned.system.parameters[:60].reshape(3, 20)
    scaled = np.clip([tuned.error_gain * error, tuned.rate_gain * rate], -1, 1)
    first, second = (trapezoids(vertices[k], scaled[k]) for k in range(2))
    samples = np.linspace(-1.2, 1.2, 61)
    terms = trapezoids(vertices[2], samples)
    joined = np.zeros(61)
    for i in range(5):
        for j in range(5):
            concluded = terms[:, np.clip(i + j - 2, 0, 4)]
            joined = np.maximum(joined, first[i] * second[j] * concluded)
    return tuned.output_gain * (joined @ samples) / joined.sum()


def simulated(points, output, steps, y):
    """Errors and steering angles, step by step."""
    x, heading, last, errors, steering = 0.0, 0.0, None, [], []
    for _ in range(steps):
        error = 1 - nearest(points, x, y)
        rate = 0.0 if last is None else (error - last) / 0.1
        last = error
        angle = np.clip(output(error, rate), -1.2, 1.2)
        heading += 0.5 / 0.1 * np.tan(angle) * 0.1
        x, y = x + 0.05 * np.cos(heading), y + 0.05 * np.sin(heading)
        errors.append(error)
        steering.append(angle)
    return np.array(errors), np.array(steering)


@pytest.mark.parametrize("regulator", ["PD", "fuzzy", "both"])
def test_runs_are_those_of_plain_numpy(regulator):
    tuned = fz.FuzzyRegulator.thesis()
    ours, plain = {
        "PD": (EXPERT, EXPERT),
        "fuzzy": (tuned, mamdani),
        "both": ([EXPERT, tuned], lambda e, r: EXPERT(e, r) + mamdani(e, r)),
    }[regulator]
    run = PLANT.play(ours, start=(0, 1.3), duration=20)
    errors, steering = simulated(fz.Wall.sin().points, plain, 200, 1.3)
    np.testing.assert_allclose(run.error[:-1], errors, atol=1e-9)
    np.testing.assert_allclose(run.steering, steering, atol=1e-8)
    np.testing.assert_allclose(run.rate[1:], np.diff(run.error) / 0.1, atol=1e-12)
    assert run.rate[0] == 0
    np.testing.assert_allclose(run.time, np.arange(201) / 10)
    assert run.poses.shape == (201, 3)
    np.testing.assert_array_equal(run.distance, 1 - run.error)


@given(
    arrays(float, (7, 2), elements=st.floats(-9, 9), unique=True),
    st.floats(-15, 15),
    st.floats(-15, 15),
)
def test_the_nearest_point_counts(points, x, y):
    wall = fz.Wall.polyline(points)
    assert wall.distance(x, y) == pytest.approx(nearest(points, x, y), abs=1e-12)


def test_a_vertical_sensor_sees_the_wall_below_it():
    wall = fz.Wall.polyline([(0, 0), (4, 2), (6, 2)], sensing="vertical")
    xs = np.linspace(0, 6, 50)
    for x in xs:
        expected = 1.5 - np.interp(x, [0, 4, 6], [0, 2, 2])
        assert wall.distance(x, 1.5) == pytest.approx(expected, abs=1e-15)
    assert wall.distance(6.1, 0) is None
    assert wall.points.tolist() == [[0, 0], [4, 2], [6, 2]]


def test_measures_are_those_of_their_definitions():
    run = PLANT.play(EXPERT, duration=30)
    for after in (0.0, 0.3, 12.0, 30.0):
        errors = run.error[round(after / 0.1) :]
        measures = run.measures(after)
        assert measures["iae"] == pytest.approx(np.abs(errors).sum() * 0.1)
        assert measures["mse"] == pytest.approx((errors**2).mean())
        assert measures["max_error"] == np.abs(errors).max()
    assert not run.beats(run)


def test_a_lost_robot_says_so():
    short = fz.Wall.polyline([(-1, 0), (3, 0)], sensing="vertical")
    run = fz.WallFollowing(short).play(EXPERT, start=(0, 1), duration=60)
    assert run.lost
    assert run.duration == 6.0
    assert "then lost" in repr(run)
    away = fz.WallFollowing(fz.Wall.straight(), sensor_range=2.0)
    run = away.play(fz.PD(-0.01, 0), start=(0, 1.2, 1.0))
    assert run.lost
    assert np.isfinite(run.poses).all()
    assert not run.beats(PLANT.play(EXPERT, duration=10))


def test_a_system_of_the_users_steers():
    inputs = [
        fz.Variable.evenly(name, (-1, 1), "NP", shape="triangular") for name in ("error", "rate")
    ]
    plane = fz.TSK(inputs, [[-2.7, 0.3], [-0.3, 2.7]])
    run = PLANT.play(plane, duration=20)
    pd = PLANT.play(fz.PD(1.2, 1.5), duration=20)
    # Within its universe the system is the plane 1.2 e + 1.5 rate.
    np.testing.assert_allclose(run.error, pd.error, atol=1e-9)
    scaled = fz.FuzzyRegulator(plane, error_gain=2.0, rate_gain=0.5, output_gain=3.0)
    assert scaled(0.1, 0.2) == pytest.approx(3 * (1.2 * 0.2 + 1.5 * 0.1))
    assert scaled.rules_kept == 4
    terms = [fz.Variable.evenly(name, (-1, 1), "NP") for name in ("e", "rate", "u")]
    system = fz.System(terms[:2], terms[2], ["if e is N then u is N", "if e is P then u is P"])
    assert not PLANT.play(fz.FuzzyRegulator(system, output_gain=2.0), duration=5).lost


def test_training_learns_and_says_what_it_learned():
    training = fz.WallIgbflcTraining(duration=60, repetitions=1)
    trained = fz.train(PLANT, training, seed=3)
    assert len(trained.stages) == 2
    for stage in trained.stages:
        assert stage.fitness.shape == (15,)
        assert (np.diff(stage.fitness) <= 0).all()
        run = PLANT.play(stage.controller, duration=60)
        assert stage.iae == (None if run.lost else run.measures()["iae"])
        assert stage.beats_expert == run.beats(PLANT.play(EXPERT, duration=60))
        bits = stage.controller.system.parameters[-25:]
        assert set(bits) <= {0.0, 1.0}
        assert stage.controller.rules_kept == bits.sum()
    assert trained.controller == trained.stages[trained.best].controller
    again = fz.train(PLANT, training, seed=3, expert=EXPERT)
    assert again.controller == trained.controller
    other = fz.train(PLANT, fz.WallIgbflcTraining(duration=60, operators="modern"), seed=3)
    assert other.controller != trained.controller


def test_the_fitness_of_stage_1_is_the_mean_squared_error():
    trained = fz.train(PLANT, fz.WallIgbflcTraining(duration=20, repetitions=0), seed=1)
    (stage,) = trained.stages
    run = PLANT.play(EXPERT, duration=20)
    outputs = [stage.controller(e, r) for e, r in zip(run.error[:-1], run.rate[:-1], strict=True)]
    mse = ((np.array(outputs) - run.wanted) ** 2).mean()
    assert stage.fitness[-1] == pytest.approx(mse, rel=1e-12)


def test_documents_come_back_equal(tmp_path):
    for regulator in (fz.FuzzyRegulator.thesis(), fz.FuzzyRegulator.thesis_pruned(8)):
        regulator.save(tmp_path / "regulator.json")
        assert fz.load(tmp_path / "regulator.json") == regulator
    text = fz.FuzzyRegulator.thesis().to_json()
    other = fz.TSK([fz.Variable.evenly("x", (0, 1), "ab")], [0, 1])
    with pytest.raises(fz.errors.FormatError, match="tsk"):
        fz.FuzzyRegulator.from_json(other.to_json())
    assert json.loads(text)["error_gain"] == 1.2858


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda: fz.Wall.polyline([(0, 0)]), fz.errors.InvalidValueError, "at least 2"),
        (lambda: fz.Wall.polyline([(0, 0)] * 2), fz.errors.InvalidValueError, "equals the point"),
        (lambda: fz.Wall.polyline([(0, 0), (1, np.nan)]), fz.errors.InvalidValueError, "finite"),
        (lambda: fz.Wall.polyline([0, 1]), fz.errors.ShapeError, "points"),
        (
            lambda: fz.Wall.polyline([(0, 0), (0, 1)], sensing="vertical"),
            fz.errors.InvalidValueError,
            "rising x",
        ),
        (
            lambda: fz.Wall.polyline([(0, 0), (1, 1)], sensing="vertikal"),
            fz.errors.UnknownNameError,
            "vertical",
        ),
        (
            lambda: fz.WallFollowing(fz.Wall.jog(), sensor_range=0.5),
            fz.errors.InvalidValueError,
            "range of the sensor",
        ),
        (lambda: PLANT.play("classical"), fz.errors.InvalidTypeError, "PD"),
        (lambda: PLANT.play([]), fz.errors.InvalidValueError, "at least 1"),
        (lambda: PLANT.play([[EXPERT]]), fz.errors.InvalidTypeError, "got list"),
        (lambda: PLANT.play(EXPERT, start=(0, 99)), fz.errors.InvalidValueError, "no wall"),
        (lambda: PLANT.play(EXPERT, start=(0, 1, 2, 3)), fz.errors.ShapeError, "start"),
        (lambda: PLANT.play(EXPERT, duration=0), fz.errors.InvalidValueError, "duration"),
        (lambda: PLANT.play(EXPERT, duration=1e12), fz.errors.InvalidValueError, "1e7"),
        (
            lambda: PLANT.play(EXPERT, duration=1).measures(2),
            fz.errors.InvalidValueError,
            "from 0 to 1",
        ),
        (lambda: fz.FuzzyRegulator(EXPERT), fz.errors.InvalidTypeError, "System or a TSK"),
        (lambda: fz.FuzzyRegulator.thesis()(np.inf, 0), fz.errors.InvalidValueError, "error"),
        (lambda: fz.FuzzyRegulator.thesis_pruned(9), fz.errors.InvalidValueError, "from 0 to 8"),
        (
            lambda: fz.train(PLANT, fz.QLambdaTraining()),
            fz.errors.InvalidTypeError,
            "WallIgbflcTraining",
        ),
        (
            lambda: fz.train(PLANT, fz.WallIgbflcTraining(), evader="classical"),
            fz.errors.InvalidTypeError,
            "evader is for a OneOnOne",
        ),
        (
            lambda: fz.train(fz.OneOnOne(), fz.QLambdaTraining(), expert=EXPERT),
            fz.errors.InvalidTypeError,
            "expert is for a WallFollowing",
        ),
        (
            lambda: fz.train(fz.OneOnOne(), fz.WallIgbflcTraining()),
            fz.errors.InvalidTypeError,
            "for a OneOnOne",
        ),
        (
            lambda: fz.train(PLANT, fz.WallIgbflcTraining(population=3)),
            fz.errors.InvalidValueError,
            "population",
        ),
        (
            lambda: fz.train(PLANT, fz.WallIgbflcTraining(start=(0, 99))),
            fz.errors.InvalidValueError,
            "no wall",
        ),
    ],
)
def test_bad_input_is_refused_in_words(call, error, words):
    with pytest.raises(error, match=words):
        call()


def test_training_stops_on_request():
    control = fz.Control()
    control.cancel()
    with pytest.raises(fz.errors.CancelledError):
        fz.train(PLANT, fz.WallIgbflcTraining(duration=10), control=control)
