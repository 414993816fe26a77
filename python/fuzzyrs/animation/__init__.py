"""Games that move: as a page that plays them, as a GIF, as an MP4."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

from fuzzyrs._fuzzyrs import (
    ManyTrajectory,
    Trajectory,
    TwoPursuersTrajectory,
    WallRun,
    write_text,
)
from fuzzyrs.animation.film import Progress, film
from fuzzyrs.animation.player import page, playing_speed
from fuzzyrs.errors import from_kind
from fuzzyrs.recording import Played, Recording, by_panel

__all__ = ["ENDINGS", "animate", "chosen_panel"]

#: What files may end in.
ENDINGS = (".gif", ".mp4", ".html")

#: Delays in a GIF are whole hundredths of a second, and viewers slow down what is faster.
FASTEST_GIF = 50.0


def animate(
    games: Recording | Played | Iterable[Recording | Played],
    out: str | Path,
    *,
    panel: str | None = None,
    title: str = "",
    fps: float = 20.0,
    speed: float | None = None,
    size: int = 640,
    progress: Progress | None = None,
) -> Path:
    """Write games as a moving picture, or as a page that plays them.

    Games of one panel are shown over each other. The file is whole or not there.

    Parameters
    ----------
    games : Recording, trajectory, or several of them
        What a game's `play` gave, or recordings, as `load_games` reads them.
    out : path
        Where to; its ending says as what: `.html` for a page with a player, which needs no other
        file and no network; `.gif`; `.mp4`, which needs ffmpeg.
    panel : str, optional
        Which games: a panel's name or a part that only one has. A page shows all by default, a
        picture the first panel.
    title : str, optional
        Shown above; the panel's name by default.
    fps : float, optional
        Pictures a second, from 1 to 60 (50 in a GIF). Not for pages.
    speed : float, optional
        How many times faster than it was played the game is shown, from 1/100; by default such
        that it takes 12 s at most. Not for pages.
    size : int, optional
        The width, from 200 to 3840 (pixels). Not for pages.
    progress : callable, optional
        Called as `progress(done, total)` after each picture.

    Returns
    -------
    pathlib.Path
        `out`.

    Raises
    ------
    InvalidValueError
        If an ending or a number makes no sense, the film is too long, or ffmpeg is missing.
    UnknownNameError
        If there is no such panel.
    ImportError
        Without matplotlib, if it is not a page.
    FileError
        If the file cannot be written.

    Examples
    --------
    >>> import fuzzyrs as fz
    >>> path = fz.OneOnOne().play(evader_start=(-6, 7))
    >>> fz.animate(path, "pursuit.html")  # doctest: +SKIP
    PosixPath('pursuit.html')
    """
    out = Path(out)
    if out.suffix not in ENDINGS:
        message = f"the file's name must end in {', '.join(ENDINGS)}, got {out.name!r}"
        raise from_kind("unsuitable", message)
    recordings = _recordings(games)
    if out.suffix == ".html":
        shown = (
            recordings if panel is None else by_panel(recordings)[chosen_panel(recordings, panel)]
        )
        write_text(out, page(shown, title or (panel and shown[0].panel) or ""))
        return out
    name = chosen_panel(recordings, panel)
    shown = by_panel(recordings)[name]
    speed = float(playing_speed(shown)) if speed is None else speed
    _check("fps", fps, 1.0, FASTEST_GIF if out.suffix == ".gif" else 60.0)
    _check("speed", speed, 0.01, 1e9)
    _check("size", size, 200, 3840)
    film(
        shown,
        out,
        title=title or name,
        fps=fps,
        speed=speed,
        size=int(size),
        progress=progress,
    )
    return out


def chosen_panel(recordings: Iterable[Recording], asked: str | None) -> str:
    """Return the name of the panel that is asked for, by its name or a part of it.

    Raises
    ------
    UnknownNameError
        If none or more than one fits; it names them.
    """
    names = list(by_panel(recordings))
    if asked is None or asked in names:
        return names[0] if asked is None else asked
    fitting = [name for name in names if asked.casefold() in name.casefold()]
    if len(fitting) == 1:
        return fitting[0]
    problem = "several games fit" if fitting else "there is no game"
    choices = "; ".join(map(repr, fitting or names))
    raise from_kind("unknown_name", f"{problem} {asked!r}; choose from: {choices}")


def _recordings(games: Recording | Played | Iterable[Recording | Played]) -> list[Recording]:
    played = (Trajectory, TwoPursuersTrajectory, ManyTrajectory, WallRun)
    each = [games] if isinstance(games, (Recording, *played)) else list(games)
    if not each:
        raise from_kind("wrong_shape", "there are no games to show")
    for game in each:
        if not isinstance(game, (Recording, *played)):
            what = "a recording, or what a game's play gave"
            raise from_kind("wrong_type", f"a game must be {what}; got {type(game).__name__}")
    return [game if isinstance(game, Recording) else Recording.of(game) for game in each]


def _check(name: str, value: float, low: float, high: float) -> None:
    if not (math.isfinite(value) and low <= value <= high):
        raise from_kind("out_of_range", f"{name} must be from {low:g} to {high:g}, got {value}")
