"""Chapter 4's robots and strategies: speed laws, the evasive turn, PD, sums, sweeping."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import fuzzyrs as fz
import oracle

LIMITS = {"pursuer": np.pi / 6, "evader": np.pi / 3}


def robot(who, law="cosine"):
    return fz.Vehicle(1.0 if who == "pursuer" else 0.5, 1.0, LIMITS[who], speed_law=law)


def chase(law="cosine", **options):
    return fz.OneOnOne(robot("pursuer", law), robot("evader"), **options)


def expected(start, gains, distance, steps, *, wrapped):
    """The equations (4.1)-(4.8), step by step; poses of both robots."""
    pursuer, evader, last = np.zeros(3), np.array([*start, 0.0]), None
    paths = [(pursuer, evader)]
    for _ in range(steps):
        dx, dy = evader[:2] - pursuer[:2]
        if np.hypot(dx, dy) < 0.1:
            break
        angle = oracle.wrap(np.arctan2(dy, dx) - pursuer[2])
        rate = 0.0 if last is None else oracle.wrap(angle - last) / 0.1
        last = angle
        flee = oracle.wrap(np.arctan2(dy, dx) - evader[2])
        if np.hypot(dx, dy) < distance:
            flee = pursuer[2] + np.pi - evader[2]
            flee = oracle.wrap(flee) if wrapped else flee
        steering = np.clip(gains[0] * angle + gains[1] * rate, -np.pi / 6, np.pi / 6)
        pursuer = drive(pursuer, 1.0, steering)
        evader = drive(evader, 0.5, np.clip(flee, -np.pi / 3, np.pi / 3))
        paths.append((pursuer, evader))
    return np.array(paths)


def drive(pose, speed, steering):
    heading = pose[2] + 0.1 * speed * np.sin(steering)
    way = 0.1 * speed * np.cos(steering)
    return np.array([pose[0] + way * np.cos(heading), pose[1] + way * np.sin(heading), heading])


@pytest.mark.parametrize("wrapped", [False, True])
@pytest.mark.parametrize("start", [(3, 3), (-3, 5), (4, -2)])
def test_paths_are_those_of_the_equations(start, wrapped):
    turn = fz.EvasiveTurn(1.6, wrapped=wrapped)
    played = chase().play(fz.PD(0.99, 0.02), turn, evader_start=start, max_time=20)
    paths = expected(start, (0.99, 0.02), 1.6, 200, wrapped=wrapped)
    np.testing.assert_allclose(played.pursuer, paths[:, 0], rtol=0, atol=1e-8)
    np.testing.assert_allclose(played.evader, paths[:, 1], rtol=0, atol=1e-8)


@pytest.mark.parametrize(("start", "time"), [((3, 3), 7.0), ((-2, 4), 8.7), ((7, 1), 13.0)])
def test_bang_bang_at_constant_speed_needs_the_published_time(start, time):
    game = chase("constant")
    assert game.play("bang-bang", fz.EvasiveTurn(1.6), evader_start=start).capture_time == time


def test_bang_bang_drives_straight_when_the_evader_is_ahead():
    played = chase().play("bang-bang", evader_start=(3, 0), max_time=1)
    assert not played.pursuer_steering.any()


@given(st.floats(-3, 3), st.floats(-3, 3), st.floats(-2, 2), st.floats(-2, 2))
def test_a_pd_is_its_formula(proportional, derivative, error, rate):
    output = fz.PD(proportional, derivative)(error, rate)
    assert output == pytest.approx(proportional * error + derivative * rate, abs=1e-12)


def test_two_pds_in_parallel_are_one_with_both_gains():
    turn, start = fz.EvasiveTurn(1.6), (2, 5)
    both = fz.Parallel(fz.PD(0.5, 0.02), fz.PD(0.5, 0.0))
    together = chase().play(both, turn, evader_start=start)
    one = chase().play(fz.PD(1.0, 0.02), turn, evader_start=start)
    np.testing.assert_allclose(together.pursuer, one.pursuer, rtol=0, atol=1e-9)
    assert isinstance(both.first, fz.PD)
    assert repr(both) == "Parallel(PD(0.5, 0.02), PD(0.5, 0.0))"
    nested = fz.Parallel(both, "classical")
    assert chase().play(nested, turn, evader_start=start).captured


@pytest.mark.parametrize("capture", ["sampled", "swept"])
def test_the_nearest_distance_is_looked_for_where_captures_are(capture):
    game = fz.OneOnOne(fz.Vehicle(5, 1, 0.5), fz.Vehicle(0, 1, 0.5), time_step=1, capture=capture)
    played = game.play(evader_start=(7.5, 0), max_time=3)
    many = game.play_many(evader_starts=[(7.5, 0), (2, 3)], max_time=3)
    assert played.captured == many.captured[0] == (capture == "swept")
    assert played.miss_distance == many.miss_distance[0]
    if capture == "swept":
        assert played.miss_distance == pytest.approx(0, abs=1e-12)
        assert played.capture_time == 2.0


def test_the_strategies_refuse_what_makes_no_sense():
    errors = fz.errors
    with pytest.raises(errors.InvalidValueError, match="proportional gain must be finite"):
        fz.PD(np.nan, 0)
    with pytest.raises(errors.InvalidValueError, match="switching distance must be zero or more"):
        fz.EvasiveTurn(-1)
    with pytest.raises(errors.UnknownNameError, match='speed law "cosin"; did you mean "cosine"'):
        fz.Vehicle(1, 1, 0.5, speed_law="cosin")
    with pytest.raises(errors.UnknownNameError, match='did you mean "swept"'):
        fz.OneOnOne(capture="sweep")
    with pytest.raises(errors.UnknownNameError, match='did you mean "bang-bang"'):
        chase().play("bangbang", evader_start=(1, 1))
    with pytest.raises(TypeError, match="the first must be"):
        fz.Parallel(3, "classical")
