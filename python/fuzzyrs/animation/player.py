"""Recorded games as a part of a page that plays them.

A page holds whole numbers: coordinates in a unit that no screen resolves, headings in hundredths
of a radian, each as the step from the one before. `assets/scene.js` reads and draws them,
`assets/player.js` is what a reader operates.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fuzzyrs._html import Html, asset, data, document, element, theme_switch
from fuzzyrs.recording import RecordedRobot, Recording, by_panel

#: How finely a panel is kept: its extent has this many units at least.
UNITS = 20_000

#: Steps of the headings [rad].
HEADING_UNIT = 0.01

#: How long a game is shown at most before it is shown faster [s].
LONGEST_SHOWN = 12.0


def styles() -> str:
    """Return the CSS of players."""
    return asset(__package__, "assets/player.css")


def scripts() -> str:
    """Return the JavaScript of players."""
    return "\n".join(asset(__package__, f"assets/{name}.js") for name in ("scene", "player"))


def page(recordings: Sequence[Recording], title: str) -> str:
    """Return a whole page that plays games."""
    title = title or "Recorded games"
    head = element("header", element("h1", title), theme_switch(), class_="player-head")
    body = element("main", head, player(recordings, title), class_="player-page")
    return document(title, [body], styles=[styles()], scripts=[scripts()])


def player(recordings: Sequence[Recording], title: str) -> Html:
    """Return the element that plays games; `title` is what those who don't see it are told."""
    return element(
        "div",
        data(packed(recordings), class_="player-data"),
        element("p", "The games are played where scripts may run.", class_="player-missing"),
        class_="player",
        role="group",
        aria_label=f"Animated games: {title}",
    )


def line_styles(recordings: Iterable[Recording]) -> dict[str, int]:
    """Return the number of each label's line style in a panel: the last one's is 0, solid."""
    labels = list(dict.fromkeys(recording.label for recording in recordings))
    return {label: index for index, label in enumerate(reversed(labels))}


def colours(recordings: Iterable[Recording]) -> dict[str, int]:
    """Return the number of each robot's colour.

    The first pursuer and the first evader look as those of a game of two.
    """
    names: dict[str, list[str]] = {"pursuer": [], "evader": [], "robot": []}
    for recording in recordings:
        for robot in recording.robots:
            if robot.name not in names[robot.role]:
                names[robot.role].append(robot.name)
    pursuers, evaders = names["pursuer"], names["evader"]
    order = [*pursuers[:1], *evaders[:1], *pursuers[1:], *evaders[1:], *names["robot"]]
    return {name: index for index, name in enumerate(order)}


def playing_speed(recordings: Iterable[Recording]) -> int:
    """Return how many times faster than it was played a game is shown: a power of two."""
    longest = max((recording.duration for recording in recordings), default=0.0)
    doublings = math.ceil(math.log2(max(longest, 1.0) / LONGEST_SHOWN))
    return int(2 ** max(0, doublings))


def packed(recordings: Sequence[Recording]) -> dict[str, Any]:
    """Return what the page holds of games."""
    colour = colours(recordings)
    return {
        "panels": [
            {"name": name, **_panel(games, colour)} for name, games in by_panel(recordings).items()
        ]
    }


def _panel(games: Sequence[Recording], colour: dict[str, int]) -> dict[str, Any]:
    style = line_styles(games)
    places = np.concatenate([place for game in games for place in _places(game)])
    origin = places.min(axis=0)
    span = float((places.max(axis=0) - origin).max())
    unit = 10.0 ** math.floor(math.log10((span or 1.0) / UNITS))
    return {
        "origin": origin.tolist(),
        "unit": unit,
        "speed": playing_speed(games),
        "games": [
            {
                "label": game.label,
                "outcome": game.outcome(),
                "style": style[game.label],
                "step": game.time_step,
                "captured": game.capture_time,
                "radius": game.capture_radius,
                "wall": None if game.wall is None else _columns(game.wall, origin, unit),
                "robots": [_robot(robot, colour, origin, unit) for robot in game.robots],
            }
            for game in games
        ],
    }


def _places(game: Recording) -> Iterable[NDArray[np.float64]]:
    yield from (robot.poses[:, :2] for robot in game.robots)
    if game.wall is not None:
        yield game.wall


def _robot(
    robot: RecordedRobot, colour: dict[str, int], origin: NDArray[np.float64], unit: float
) -> dict[str, Any]:
    heading = np.unwrap(np.remainder(robot.poses[:, 2], math.tau))
    return {
        "name": robot.name,
        "role": robot.role,
        "colour": colour[robot.name],
        **_columns(robot.poses, origin, unit),
        "heading": _steps(heading / HEADING_UNIT),
    }


def _columns(
    places: NDArray[np.float64], origin: NDArray[np.float64], unit: float
) -> dict[str, list[int]]:
    x, y = ((places[:, :2] - origin) / unit).T
    return {"x": _steps(x), "y": _steps(y)}


def _steps(values: NDArray[np.float64]) -> list[int]:
    """Return rounded values, each as the step from the one before."""
    steps: list[int] = np.diff(np.rint(values).astype(np.int64), prepend=0).tolist()
    return steps
