"""Games that were played, as plain values that files hold and figures and animations show."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from fuzzyrs._fuzzyrs import ManyTrajectory, Trajectory, TwoPursuersTrajectory, WallRun, write_text
from fuzzyrs.errors import FuzzyrsError, from_kind

Role = Literal["pursuer", "evader", "robot"]
Played = Trajectory | TwoPursuersTrajectory | ManyTrajectory | WallRun

FORMAT = "fuzzyrs-games"
VERSION = 1

#: Poses are kept to a tenth of a millimetre and of a milliradian.
DIGITS = 4

#: A file larger than this holds no games that anybody watches [bytes].
LARGEST_FILE = 256 * 1024 * 1024


@dataclass(frozen=True)
class RecordedRobot:
    """A robot's part in a game.

    Attributes
    ----------
    name : str
        Such as "pursuer 1".
    role : {"pursuer", "evader", "robot"}
        What it is after; "robot" follows a wall.
    poses : array of shape (n, 3)
        x [m], y [m] and heading [rad] at every step. A robot whose game has ended stands still.
    """

    name: str
    role: Role
    poses: NDArray[np.float64]


@dataclass(frozen=True)
class Recording:
    """A game that was played.

    Attributes
    ----------
    robots : tuple of RecordedRobot
        Who played.
    time_step : float
        Between two poses [s].
    capture_time : float or None
        When the last evader was captured [s]; None if one escaped, or if nobody was chased.
    capture_radius : float or None
        Of the circle in which a pursuer captures [m].
    label : str
        Who plays, such as "classical".
    panel : str
        What is played; recordings of one panel are shown over each other.
    wall : array of shape (n, 2) or None
        The corners of a wall [m].
    """

    robots: tuple[RecordedRobot, ...]
    time_step: float
    capture_time: float | None = None
    capture_radius: float | None = None
    label: str = ""
    panel: str = ""
    wall: NDArray[np.float64] | None = field(default=None, repr=False)

    @staticmethod
    def of(
        played: Played,
        *,
        label: str = "",
        panel: str = "",
        capture_radius: float | None = None,
        wall: Any = None,
    ) -> Recording:
        """Return the recording of a game.

        Parameters
        ----------
        played : Trajectory, TwoPursuersTrajectory, ManyTrajectory or WallRun
            What a game's `play` gave.
        label, panel : str, optional
            Who plays, and what is played.
        capture_radius : float, optional
            The game's [m]; the circle is shown if it is given.
        wall : array of shape (n, 2), optional
            Corners of the wall that a robot follows [m].

        Examples
        --------
        >>> import fuzzyrs as fz
        >>> path = fz.OneOnOne().play(evader_start=(-6, 7))
        >>> fz.Recording.of(path, label="classical", capture_radius=0.1).duration
        9.6
        """
        times = played.pairs[0].time if isinstance(played, ManyTrajectory) else played.time
        return Recording(
            robots=tuple(_robots(played)),
            time_step=round(float(times[1] - times[0]), 9) if len(times) > 1 else 0.0,
            capture_time=None if isinstance(played, WallRun) else played.capture_time,
            capture_radius=capture_radius,
            label=label,
            panel=panel,
            wall=None if wall is None else np.round(np.asarray(wall, dtype=float), DIGITS),
        )

    @property
    def duration(self) -> float:
        """How long the game lasts [s]."""
        steps = max(len(robot.poses) for robot in self.robots) - 1
        return round(steps * self.time_step, 9)

    def outcome(self, *, brief: bool = False) -> str:
        """Return how a chase ended, in words; nothing if there was none.

        Examples
        --------
        >>> import fuzzyrs as fz
        >>> path = fz.Recording.of(fz.OneOnOne().play(evader_start=(-6, 7)))
        >>> path.outcome(), path.outcome(brief=True)
        ('captured at 9.6 s', '9.6 s')
        """
        if self.capture_time is not None:
            return f"{'' if brief else 'captured at '}{_seconds(self.capture_time)}"
        if any(robot.role == "evader" for robot in self.robots):
            return "escaped" if brief else f"escaped for {_seconds(self.duration)}"
        return ""

    def thinned(self, every: int) -> Recording:
        """Return the recording with one pose in so many; for long runs whose end tells nothing.

        Examples
        --------
        >>> import fuzzyrs as fz
        >>> run = fz.WallFollowing(fz.Wall.sin()).play(fz.PD(1.2, 1.5), duration=60.0)
        >>> whole = fz.Recording.of(run)
        >>> whole.duration, len(whole.thinned(10).robots[0].poses), len(whole.robots[0].poses)
        (60.0, 61, 601)
        """
        if every < 1:
            raise from_kind("out_of_range", f"every must be at least 1, got {every}")
        robots = tuple(replace(robot, poses=robot.poses[::every]) for robot in self.robots)
        return replace(self, robots=robots, time_step=round(self.time_step * every, 9))

    def save(self, path: str | Path) -> None:
        """Write the recording to a file that `fuzzyrs animate` and `load_games` read."""
        save_games(path, [self])

    def to_dict(self) -> dict[str, Any]:
        """Return the recording as plain values, a list for each coordinate of a robot."""
        return {
            "label": self.label,
            "panel": self.panel,
            "time_step": self.time_step,
            "capture_time": self.capture_time,
            "capture_radius": self.capture_radius,
            "wall": None if self.wall is None else self.wall.tolist(),
            "robots": [
                {
                    "name": robot.name,
                    "role": robot.role,
                    **dict(zip(("x", "y", "heading"), robot.poses.T.tolist(), strict=True)),
                }
                for robot in self.robots
            ],
        }

    @staticmethod
    def from_dict(values: Mapping[str, Any]) -> Recording:
        """Return the recording with these plain values, or say what is wrong with them."""
        robots = values.get("robots")
        if not isinstance(robots, list) or not robots:
            raise _broken("a game has a list of robots, one at least")
        wall = values.get("wall")
        return Recording(
            robots=tuple(map(_robot, robots)),
            time_step=_number(values, "time_step"),
            capture_time=_number_or_none(values, "capture_time"),
            capture_radius=_number_or_none(values, "capture_radius"),
            label=_text(values, "label"),
            panel=_text(values, "panel"),
            wall=None if wall is None else _table("the corners of a wall", wall, 2),
        )


def by_panel(games: Iterable[Recording]) -> dict[str, list[Recording]]:
    """Return the games of each panel, in the order in which they first appear."""
    found: dict[str, list[Recording]] = {}
    for game in games:
        found.setdefault(game.panel, []).append(game)
    return found


def save_games(path: str | Path, games: Iterable[Recording], title: str = "") -> None:
    """Write recordings to a file, as a whole or not at all.

    Parameters
    ----------
    path : path
        The file; JSON whatever its name.
    games : iterable of Recording
        In the order in which they are shown.
    title : str, optional
        Of all of them.

    Raises
    ------
    FormatError
        If a game has a number that is not finite.
    FileError
        If the file cannot be written.
    """
    document = {"format": FORMAT, "version": VERSION, "title": title}
    document["games"] = [game.to_dict() for game in games]
    try:
        text = json.dumps(document, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    except ValueError as error:
        raise _broken(f"cannot save {path}: a game has a number that is not finite") from error
    write_text(Path(path), text + "\n")


def load_games(path: str | Path) -> tuple[str, list[Recording]]:
    """Return the title and the recordings of a file.

    Raises
    ------
    FileError
        If the file cannot be read.
    FormatError
        If it holds something else.
    """
    path = Path(path)
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise _broken(f"larger than {LARGEST_FILE} bytes")
        document = json.loads(path.read_text(encoding="utf-8"))
        if not isinstance(document, dict) or document.get("format") != FORMAT:
            raise _broken(f'"format" must be "{FORMAT}"')
        if document.get("version") != VERSION:
            raise _broken(f'"version" must be {VERSION}, got {document.get("version")!r}')
        games = document.get("games")
        if not isinstance(games, list) or not all(isinstance(game, dict) for game in games):
            raise _broken('"games" must be a list of objects')
        return _text(document, "title"), [Recording.from_dict(game) for game in games]
    except OSError as error:
        raise from_kind("file", f"cannot read {path}: {error.strerror or error}") from error
    except (ValueError, RecursionError) as error:
        raise from_kind("format", f"{path} does not hold recorded games: {error}") from error


def _seconds(time: float) -> str:
    return f"{time:.1f} s" if round(time, 1) == time else f"{time:g} s"


def _robots(played: Played) -> Iterable[RecordedRobot]:
    """Yield the robots of a game, pursuers first; one alone has no number."""
    if isinstance(played, WallRun):
        yield _recorded("robot", "robot", played.poses)
        return
    for role in ("pursuer", "evader"):
        if hasattr(played, role):
            yield _recorded(role, role, getattr(played, role))
        else:
            for index, path in enumerate(getattr(played, f"{role}s"), start=1):
                yield _recorded(f"{role} {index}", role, path)


def _recorded(name: str, role: Any, poses: NDArray[np.float64]) -> RecordedRobot:
    # Adding zero turns -0.0 into 0.0.
    return RecordedRobot(name, role, np.round(poses, DIGITS) + 0.0)


def _robot(values: Any) -> RecordedRobot:
    if not isinstance(values, dict) or values.get("role") not in ("pursuer", "evader", "robot"):
        raise _broken('a robot has a "role": pursuer, evader or robot')
    columns = [values.get(key) for key in ("x", "y", "heading")]
    if not all(isinstance(column, list) and column for column in columns):
        raise _broken('a robot has lists "x", "y" and "heading"')
    if len({len(column) for column in columns if column}) > 1:
        raise _broken('"x", "y" and "heading" of a robot have different lengths')
    rows = list(zip(*(column for column in columns if column), strict=True))
    return RecordedRobot(_text(values, "name"), values["role"], _table("a robot's poses", rows, 3))


def _table(what: str, rows: Sequence[Any], width: int) -> NDArray[np.float64]:
    if not isinstance(rows, list) or not rows:
        raise _broken(f"{what} must be a list of rows")
    if not all(isinstance(row, (list, tuple)) and len(row) == width for row in rows):
        raise _broken(f"{what} must be rows of {width} numbers")
    if not all(is_number(value) for row in rows for value in row):
        raise _broken(f"{what} must be finite numbers")
    return np.array(rows, dtype=float)


def is_number(value: Any) -> bool:
    """Tell whether a value of a JSON is a finite number that calculations bear."""
    return type(value) in (int, float) and abs(value) < 1e300 and math.isfinite(value)


def _number(values: Mapping[str, Any], key: str) -> float:
    value = values.get(key)
    if not is_number(value) or float(value or 0) < 0:
        raise _broken(f'"{key}" must be a number, zero or more')
    return float(value or 0)


def _number_or_none(values: Mapping[str, Any], key: str) -> float | None:
    return None if values.get(key) is None else _number(values, key)


def _text(values: Mapping[str, Any], key: str) -> str:
    value = values.get(key, "")
    if not isinstance(value, str):
        raise _broken(f'"{key}" must be a text')
    return value


def _broken(what: str) -> FuzzyrsError:
    return from_kind("format", what)
