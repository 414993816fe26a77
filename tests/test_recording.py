"""Recordings of games: what files hold, and what is said of files that hold something else."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import fuzzyrs as fz
from fuzzyrs.experiments.figures import distance, times_of, wall_distance

numbers = st.floats(-1e6, 1e6)
sizes = st.floats(0, 1e3)
names = st.text(max_size=8)


@st.composite
def recordings(draw):
    def robot():
        steps = draw(st.integers(1, 5))
        role = draw(st.sampled_from(["pursuer", "evader", "robot"]))
        poses = draw(arrays(float, (steps, 3), elements=numbers))
        return fz.RecordedRobot(draw(names), role, poses)

    return fz.Recording(
        robots=tuple(robot() for _ in range(draw(st.integers(1, 3)))),
        time_step=draw(sizes),
        capture_time=draw(st.none() | sizes),
        capture_radius=draw(st.none() | sizes),
        label=draw(names),
        panel=draw(names),
        wall=draw(st.none() | arrays(float, (3, 2), elements=numbers)),
    )


def same(one, other):
    return one.to_dict() == other.to_dict()


@settings(max_examples=25)
@given(st.lists(recordings(), max_size=3), names)
def test_what_is_saved_is_loaded(tmp_path_factory, games, title):
    path = tmp_path_factory.mktemp("games") / "games.json"
    fz.save_games(path, games, title)
    loaded_title, loaded = fz.load_games(path)
    assert loaded_title == title
    assert all(map(same, loaded, games))
    assert len(loaded) == len(games)
    before = path.read_bytes()
    fz.save_games(path, loaded, loaded_title)
    assert path.read_bytes() == before


def test_a_game_is_recorded_as_it_was_played(game, tmp_path):
    played = game.play(evader_start=(2, 4))
    recorded = fz.Recording.of(played, label="classical", panel="near", capture_radius=0.1)
    assert [robot.role for robot in recorded.robots] == ["pursuer", "evader"]
    np.testing.assert_allclose(recorded.robots[0].poses, played.pursuer, atol=5e-5)
    np.testing.assert_allclose(distance(recorded), played.distance, atol=2e-4)
    assert (recorded.duration, recorded.capture_time) == (4.5, played.capture_time)
    assert np.array_equal(times_of(recorded).round(9), played.time)
    recorded.save(tmp_path / "one.json")
    (loaded,) = fz.load_games(tmp_path / "one.json")[1]
    assert same(loaded, recorded)


def test_games_of_more_robots_have_their_names():
    two = fz.Recording.of(fz.TwoPursuers().play(pursuer_starts=[(-4, 3), (5, -2)]))
    assert [robot.name for robot in two.robots] == ["pursuer 1", "pursuer 2", "evader"]
    starts = {"pursuer_starts": [(2, 4), (-4, 5)], "evader_starts": [(0, 4), (-1, 0)]}
    many = fz.Recording.of(fz.ManyOnMany.thesis(2).play([0, 1], **starts))
    assert [robot.name for robot in many.robots] == [
        "pursuer 1",
        "pursuer 2",
        "evader 1",
        "evader 2",
    ]
    steps = [len(robot.poses) for robot in many.robots]
    assert steps[:2] == steps[2:]
    assert many.duration == pytest.approx((max(steps) - 1) * many.time_step)


@pytest.fixture(scope="module")
def along_a_wall():
    wall = fz.Wall.sin()
    run = fz.WallFollowing(wall).play(fz.PD(1.2, 1.5), start=(0.0, 1.45), duration=60.0)
    return run, fz.Recording.of(run, label="PD", wall=wall.points)


def test_the_distance_from_the_wall_is_in_the_recording(along_a_wall):
    run, recorded = along_a_wall
    np.testing.assert_allclose(1.0 - wall_distance(recorded), run.error, atol=1e-4)
    assert recorded.capture_time is None


def test_a_long_run_is_thinned(along_a_wall):
    _, recorded = along_a_wall
    thinned = recorded.thinned(10)
    assert (thinned.time_step, thinned.duration) == (1.0, recorded.duration)
    np.testing.assert_array_equal(thinned.robots[0].poses, recorded.robots[0].poses[::10])
    assert same(recorded.thinned(1), recorded)
    with pytest.raises(fz.errors.InvalidValueError, match="every must be at least 1, got 0"):
        recorded.thinned(0)


def document(**changes):
    """A file's content with changes of its only game."""
    game = {
        "label": "",
        "panel": "",
        "time_step": 0.1,
        "capture_time": None,
        "capture_radius": None,
        "wall": None,
        "robots": [{"name": "p", "role": "pursuer", "x": [0, 1], "y": [0, 1], "heading": [0, 1]}],
    }
    return {"format": "fuzzyrs-games", "version": 1, "title": "", "games": [{**game, **changes}]}


def robot(**changes):
    return [{**document()["games"][0]["robots"][0], **changes}]


HOSTILE = {
    "no JSON": ("games", "Expecting value"),
    "a list": ([], '"format" must be "fuzzyrs-games"'),
    "another format": ({**document(), "format": "fuzzyrs"}, '"format" must be'),
    "another version": ({**document(), "version": 2}, '"version" must be 1, got 2'),
    "no games": ({**document(), "games": None}, '"games" must be a list of objects'),
    "games of numbers": ({**document(), "games": [1]}, '"games" must be a list of objects'),
    "a title of numbers": ({**document(), "title": 3}, '"title" must be a text'),
    "no robots": (document(robots=[]), "a list of robots, one at least"),
    "robots of text": (document(robots=["p"]), 'a robot has a "role"'),
    "another role": (document(robots=robot(role="judge")), 'a robot has a "role"'),
    "a name of numbers": (document(robots=robot(name=1)), '"name" must be a text'),
    "no heading": (document(robots=robot(heading=None)), 'lists "x", "y" and "heading"'),
    "no poses": (document(robots=robot(x=[], y=[], heading=[])), 'lists "x", "y" and "heading"'),
    "uneven poses": (document(robots=robot(x=[0])), "different lengths"),
    "a text in a pose": (document(robots=robot(x=[0, "1"])), "must be finite numbers"),
    "true in a pose": (document(robots=robot(x=[0, True])), "must be finite numbers"),
    "too large a pose": (document(robots=robot(x=[0, 10**400])), "must be finite numbers"),
    "a negative step": (document(time_step=-1), '"time_step" must be a number, zero or more'),
    "no step": (document(time_step=None), '"time_step" must be a number, zero or more'),
    "a text as time": (document(capture_time="1"), '"capture_time" must be a number'),
    "a wall of numbers": (document(wall=[1, 2]), "rows of 2 numbers"),
    "a wall of triples": (document(wall=[[1, 2, 3]]), "rows of 2 numbers"),
    "no wall": (document(wall=[]), "must be a list of rows"),
}


@pytest.mark.parametrize(("content", "says"), HOSTILE.values(), ids=list(HOSTILE))
def test_a_file_with_something_else_is_refused_in_words(content, says, tmp_path):
    path = tmp_path / "bad.json"
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    with pytest.raises(fz.errors.FormatError) as told:
        fz.load_games(path)
    assert says in str(told.value)
    assert f"{path} does not hold recorded games" in str(told.value)


@pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity", "1e999", "9" * 5000])
def test_what_is_no_number_is_refused(number, tmp_path):
    path = tmp_path / "bad.json"
    text = json.dumps(document()).replace('"x": [0, 1]', f'"x": [0, {number}]')
    assert number in text
    path.write_text(text)
    with pytest.raises(fz.errors.FormatError):
        fz.load_games(path)


def test_files_that_are_broken_are_refused(tmp_path):
    whole = tmp_path / "whole.json"
    wall = fz.Wall.jog()
    run = fz.WallFollowing(wall).play(fz.PD(1.2, 1.5), duration=5.0)
    fz.save_games(whole, [fz.Recording.of(run, wall=wall.points)])
    content = whole.read_bytes()
    bad = tmp_path / "bad.json"
    for broken in (
        b"",
        b"\xff\xfe\x00",
        b"[" * 200_000,
        b'{"games":' * 100_000,
        *(content[:end] for end in range(1, len(content) - 1, 197)),
    ):
        bad.write_bytes(broken)
        with pytest.raises(fz.errors.FormatError, match="does not hold recorded games"):
            fz.load_games(bad)
    with pytest.raises(fz.errors.FileError, match="cannot read"):
        fz.load_games(tmp_path / "none.json")
    with pytest.raises(fz.errors.FileError, match="cannot read"):
        fz.load_games(tmp_path)


values = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=3),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(names, inner, max_size=3),
    max_leaves=8,
)


@given(st.sampled_from([*document()["games"][0], "x", "y", "heading", "role", "name"]), values)
def test_whatever_a_file_holds_it_loads_or_is_refused(tmp_path_factory, key, value):
    path = tmp_path_factory.getbasetemp() / "any.json"
    games = document(**{key: value}) if key in document()["games"][0] else document()
    if key not in document()["games"][0]:
        games = document(robots=robot(**{key: value}))
    path.write_text(json.dumps(games))
    try:
        _, (game,) = fz.load_games(path)
    except fz.errors.FormatError:
        return
    assert all(np.isfinite(each.poses).all() for each in game.robots)
    assert game.duration >= 0


def test_a_recording_that_no_file_holds_is_not_written(tmp_path):
    game = fz.Recording((fz.RecordedRobot("p", "pursuer", np.zeros((1, 3))),), 0.1)
    path = tmp_path / "games.json"
    with pytest.raises(fz.errors.FormatError, match="a number that is not finite"):
        fz.save_games(path, [replace(game, time_step=float("nan"))])
    assert not path.exists()
