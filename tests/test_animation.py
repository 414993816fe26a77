"""Recorded games as pictures that move, and what a page holds of them."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

import fuzzyrs as fz
from fuzzyrs import cli
from fuzzyrs.animation.film import frame_times
from fuzzyrs.animation.player import HEADING_UNIT, packed, playing_speed


def recording(poses, **more):
    robots = [
        fz.RecordedRobot(role, role, np.asarray(each, dtype=float))
        for role, each in zip(("pursuer", "evader"), poses, strict=False)
    ]
    return fz.Recording(tuple(robots), **{"time_step": 0.1, **more})


@pytest.fixture(scope="module")
def games():
    game = fz.OneOnOne()
    return [
        fz.Recording.of(
            game.play(pursuer, evader_start=start, max_time=3.0),
            label=label,
            panel=f"evader from ({start[0]}, {start[1]}) m",
            capture_radius=0.1,
        )
        for start in [(1, 1), (2, 1)]
        for label, pursuer in [("straight", fz.PD(0.0, 0.0)), ("classical", "classical")]
    ]


def unpacked(steps, unit):
    return np.cumsum(steps) * unit


coordinates = st.floats(-1e300, 1e300) | st.floats(-20, 20) | st.floats(1e6, 1e6 + 10)
pose = st.tuples(coordinates, coordinates, st.floats(-100, 100))


@given(st.lists(pose, min_size=1, max_size=20))
def test_a_page_holds_places_as_fine_as_a_screen_shows_them(poses):
    game = recording([poses])
    panel = json.loads(json.dumps(packed([game]), allow_nan=False))["panels"][0]
    robot = panel["games"][0]["robots"][0]
    table = np.asarray(poses)
    span = np.ptp(table[:, :2], axis=0).max()
    for column, key in enumerate(("x", "y")):
        kept = unpacked(robot[key], panel["unit"]) + panel["origin"][column]
        finest = np.abs(table[:, column]).max() * 1e-15
        assert np.abs(kept - table[:, column]).max() <= span / 20_000 + finest
        assert max(map(abs, robot[key])) <= 201_000
    turned = unpacked(robot["heading"], HEADING_UNIT) - table[:, 2]
    assert np.abs(np.angle(np.exp(1j * turned))).max() <= HEADING_UNIT


def test_lines_and_colours_are_the_same_in_all_panels(games):
    panels = packed(games)["panels"]
    assert [panel["name"] for panel in panels] == ["evader from (1, 1) m", "evader from (2, 1) m"]
    for panel in panels:
        assert [(game["label"], game["style"]) for game in panel["games"]] == [
            ("straight", 1),
            ("classical", 0),
        ]
        for game in panel["games"]:
            assert [(r["name"], r["colour"]) for r in game["robots"]] == [
                ("pursuer", 0),
                ("evader", 1),
            ]


def test_outcomes_are_said_in_words(games):
    ends = [game["outcome"] for game in packed(games)["panels"][0]["games"]]
    assert ends == ["escaped for 3.0 s", f"captured at {games[1].capture_time} s"]
    wall = fz.WallFollowing(fz.Wall.sin()).play(fz.FuzzyRegulator.thesis(), start=(0, 1.45))
    (panel,) = packed([fz.Recording.of(wall, wall=[(0, 0), (1, 1)])])["panels"]
    assert panel["games"][0]["outcome"] == ""
    assert panel["games"][0]["wall"]["x"][0] >= 0


def test_long_games_are_shown_faster():
    def lasting(seconds):
        return recording([np.zeros((round(seconds / 0.1) + 1, 3))])

    assert [playing_speed([lasting(s)]) for s in (0, 9.6, 12, 12.1, 60, 6000)] == [
        1, 1, 1, 2, 8, 512,
    ]  # fmt: skip


def test_a_gif_has_the_pictures_that_its_speed_asks_for(games, tmp_path):
    seen = []
    out = fz.animate(
        games,
        tmp_path / "game.gif",
        fps=10,
        speed=2,
        size=240,
        progress=lambda done, total: seen.append((done, total)),
    )
    # 3 s at double speed are 1.5 s: 15 steps, and the picture at 0; the last one rests for 1.5 s.
    with Image.open(out) as film:
        assert film.format == "GIF"
        assert film.size == (240, 160)
        assert film.n_frames == 16
        assert film.info["loop"] == 0
        assert film.info["duration"] == 100
        first = film.convert("RGB").tobytes()
        film.seek(15)
        assert film.info["duration"] == 1600
        assert film.convert("RGB").tobytes() != first
    assert seen[-1] == (31, 31)
    assert [path.name for path in tmp_path.iterdir()] == ["game.gif"]


def test_the_pictures_of_a_game_are_the_same_again(games, tmp_path):
    def made(name):
        out = fz.animate(games, tmp_path / name, panel="(2, 1)", fps=5, speed=3, size=200)
        return out.read_bytes()

    assert made("one.gif") == made("two.gif")


def test_frames_begin_with_the_game_and_end_with_it():
    times = frame_times(1.0, fps=10, speed=3, most=100)
    assert times[:5] == pytest.approx([0, 0.3, 0.6, 0.9, 1.0])
    assert len(times) == 5 + 15
    assert set(times[5:]) == {1.0}
    assert set(frame_times(0.0, fps=10, speed=1, most=100)) == {0.0}


STILL = recording([[(1, 2, 0)], [(3, 4, 0)]], time_step=0.0)
APART = recording([np.full((30, 3), 1e8), np.zeros((2, 3))], capture_time=0.1, capture_radius=0.1)
NAMED = recording([[(0, 0, 0), (1, 1, 1)]], panel="_$x$ <b>", label="_a $b")


@pytest.mark.parametrize("game", [STILL, APART, NAMED], ids=["still", "apart", "named"])
@pytest.mark.parametrize("ending", ["gif", "html"])
def test_odd_games_are_shown_too(game, ending, tmp_path):
    more = {"fps": 5, "speed": 4, "size": 200} if ending == "gif" else {}
    assert fz.animate(game, tmp_path / f"game.{ending}", **more).stat().st_size > 1000


def test_whatever_can_be_played_can_be_shown(tmp_path):
    played = fz.TwoPursuers().play(pursuer_starts=[(-1, 1), (1, -1)])
    page = fz.animate(played, tmp_path / "two.html").read_text(encoding="utf-8")
    for name in ("pursuer 1", "pursuer 2", "evader"):
        assert f'"name":"{name}"' in page


def test_a_page_may_show_one_panel_or_all(games, tmp_path):
    def names(**more):
        page = fz.animate(games, tmp_path / "games.html", **more).read_text(encoding="utf-8")
        start = page.index('{"panels"')
        values = json.JSONDecoder().raw_decode(page, start)[0]
        return [panel["name"] for panel in values["panels"]]

    assert len(names()) == 2
    assert names(panel="(2, 1)") == ["evader from (2, 1) m"]


@pytest.mark.parametrize("fps", [7, 30, 45, 50])
def test_a_gif_lasts_as_long_as_its_game(fps, tmp_path):
    game = recording([np.linspace((0, 0, 0), (9, 6, 1), 41)])
    with Image.open(fz.animate(game, tmp_path / "game.gif", fps=fps, speed=1, size=200)) as film:
        lasts = 0
        for index in range(film.n_frames):
            film.seek(index)
            lasts += film.info["duration"]
    # 4 s, and the last picture rests.
    assert lasts == pytest.approx(5500, abs=2500 / fps)


def test_an_mp4_without_ffmpeg_says_what_to_install(games, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(fz.errors.InvalidValueError, match=r"apt install ffmpeg.*\.gif or \.html"):
        fz.animate(games, tmp_path / "game.mp4")
    assert list(tmp_path.iterdir()) == []


def pretend(folder, body):
    """Put a program into a folder that is run in the place of ffmpeg."""
    program = folder / "ffmpeg"
    program.write_text(f"#!/bin/sh\n{body}\n")
    program.chmod(0o755)


def test_ffmpeg_gets_every_picture(games, tmp_path, monkeypatch):
    # It writes what it reads to the last argument.
    pretend(tmp_path, 'for out; do :; done; exec cat > "$out"')
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    out = fz.animate(games, tmp_path / "game.mp4", fps=10, speed=2, size=200)
    assert out.stat().st_size == 31 * 200 * 134 * 4


def test_what_ffmpeg_complains_of_is_told(games, tmp_path, monkeypatch):
    pretend(tmp_path, "echo no such codec >&2; exit 1")
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    with pytest.raises(fz.errors.FileError, match="ffmpeg says: no such codec"):
        fz.animate(games, tmp_path / "game.mp4", size=200)
    assert [path.name for path in tmp_path.iterdir()] == ["ffmpeg"]


@pytest.mark.parametrize(
    ("more", "error", "says"),
    [
        ({"out": "game.avi"}, "InvalidValueError", r"\.gif, \.mp4, \.html, got 'game.avi'"),
        ({"panel": "nowhere"}, "UnknownNameError", r"no game 'nowhere'; choose from: 'evader"),
        ({"panel": "evader"}, "UnknownNameError", "several games fit 'evader'"),
        ({"fps": 51}, "InvalidValueError", "fps must be from 1 to 50"),
        ({"speed": 0.0}, "InvalidValueError", "speed must be from 0.01"),
        ({"speed": math.nan}, "InvalidValueError", "speed must be"),
        ({"size": 10}, "InvalidValueError", "size must be from 200"),
        ({"speed": 0.01, "size": 640}, "InvalidValueError", "choose a larger speed"),
        ({"out": "no/such/game.gif", "size": 200}, "FileError", "cannot write"),
    ],
)
def test_bad_input_is_told(more, error, says, games, tmp_path):
    more = {"out": "game.gif", **more}
    out = tmp_path / more.pop("out")
    with pytest.raises(getattr(fz.errors, error), match=says):
        fz.animate(games, out, **more)
    assert list(tmp_path.iterdir()) == []


def test_what_is_no_game_is_told(tmp_path):
    with pytest.raises(fz.errors.ShapeError, match="no games"):
        fz.animate([], tmp_path / "game.gif")
    with pytest.raises(fz.errors.InvalidTypeError, match="got str"):
        fz.animate(["game"], tmp_path / "game.gif")


def test_an_interrupted_film_leaves_nothing(games, tmp_path):
    def stop(done, total):
        del done, total
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fz.animate(games, tmp_path / "game.gif", size=200, progress=stop)
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def recorded(games, tmp_path):
    path = tmp_path / "table-9-1.games.json"
    fz.save_games(path, games, "Known games")
    return path


def test_the_command_takes_games_or_the_result_beside_them(recorded, tmp_path, capsys):
    out = tmp_path / "games.html"
    assert cli.main(["animate", str(recorded), "--out", str(out)]) == 0
    assert capsys.readouterr().out == f"wrote {out}\n"
    assert "<h1>Known games</h1>" in out.read_text(encoding="utf-8")
    result = tmp_path / "table-9-1.json"
    result.write_text('{"id": "table-9-1", "rows": []}')
    picture = tmp_path / "game.gif"
    options = ["--fps", "5", "--speed", "4", "--size", "200"]
    assert cli.main(["animate", str(result), "--out", str(picture), *options]) == 0
    assert "evader from (2, 1) m" in capsys.readouterr().err
    assert picture.exists()


def test_the_command_says_what_is_wrong(recorded, tmp_path, capsys):
    def said(path, *options, out="game.gif"):
        code = cli.main(["animate", str(path), "--out", str(tmp_path / out), *options])
        assert code in (1, 2)
        return capsys.readouterr().err

    assert "choose from: 'evader from (1, 1) m'" in said(recorded, "--game", "nowhere")
    assert "must end in .gif" in said(recorded, out="game.txt")
    assert "cannot read" in said(tmp_path / "nothing.json")
    lonely = tmp_path / "table-9-2.json"
    lonely.write_text('{"rows": []}')
    assert "a result without recorded games" in said(lonely)
    lonely.write_text("[")
    assert "does not hold recorded games" in said(lonely)
    empty = tmp_path / "empty.games.json"
    fz.save_games(empty, [])
    assert "has no games" in said(empty)
