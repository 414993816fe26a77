"""Recorded games as moving pictures: matplotlib draws, Pillow and ffmpeg write."""

from __future__ import annotations

import contextlib
import math
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fuzzyrs import plot
from fuzzyrs.animation.player import colours, line_styles
from fuzzyrs.errors import from_kind
from fuzzyrs.recording import RecordedRobot, Recording

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

#: All pictures of a GIF are in memory at once: so many pixels together at most.
MOST_GIF_PIXELS = 500_000_000

#: More frames than this make a film that nobody watches.
MOST_FRAMES = 20_000

#: How long the last picture stays [s].
REST = 1.5

# Lines of the games over each other, the solid one first; the player's are the same.
_DASHES = ("-", "--", ":", "-.", (0, (8, 3)), (0, (3, 1, 1, 1, 1, 1)))

# A robot from above, like a car's outline, with its front on the right.
_OUTLINE = ((1.0, 0.0), (-0.75, 0.58), (-0.5, 0.0), (-0.75, -0.58), (1.0, 0.0))

Frame = NDArray[np.uint8]
Progress = Callable[[int, int], None]


def frame_times(duration: float, fps: float, speed: float, most: int) -> list[float]:
    """Return which moments of a game the frames show [s]: from the first to the last, then rest.

    Raises
    ------
    InvalidValueError
        If they would be more than `most`.
    """
    count, rest = math.ceil(duration / speed * fps) + 1, round(REST * fps)
    if count + rest > most:
        message = (
            f"{duration:g} s at speed {speed:g} are {count} pictures at {fps:g} a second, "
            f"more than the {max(most - rest, 0)} that this size allows; choose a larger speed, "
            "or a smaller size"
        )
        raise from_kind("out_of_range", message)
    return [min(index * speed / fps, duration) for index in range(count)] + [duration] * rest


def film(
    games: Sequence[Recording],
    out: Path,
    *,
    title: str,
    fps: float,
    speed: float,
    size: int,
    progress: Progress | None = None,
) -> None:
    """Write games over each other as a GIF or an MP4, as `out` ends; whole or not at all.

    Raises
    ------
    InvalidValueError
        If the film would be too long, or there is no ffmpeg for an MP4.
    ImportError
        Without matplotlib.
    FileError
        If the file cannot be written.
    """
    plot.require_matplotlib()
    # Widths and heights that videos are made of are even.
    width, height = size // 2 * 2, round(_tall(games) * size / 2) * 2
    is_gif = out.suffix == ".gif"
    if is_gif:
        # A GIF shows its pictures for whole hundredths of a second.
        fps = 100 / round(100 / fps)
    most = MOST_GIF_PIXELS // (width * height) if is_gif else MOST_FRAMES
    times = frame_times(max(game.duration for game in games), fps, speed, most)
    write = partial(_write_gif, fps=fps) if is_gif else partial(_write_mp4, _ffmpeg(), fps=fps)
    frames = _frames(games, times, title, (width, height), progress)
    part = out.with_name(f".{out.stem}.{os.getpid()}.part{out.suffix}")
    try:
        write(frames, part)
        part.replace(out)
    except OSError as error:
        raise from_kind("file", f"cannot write {out}: {error.strerror or error}") from error
    finally:
        part.unlink(missing_ok=True)


def _write_gif(frames: Iterator[Frame], out: Path, *, fps: float) -> None:
    """Write a GIF whose pictures share the colours of the first, which shows everything faintly."""
    from PIL import Image

    first = Image.fromarray(next(frames)).convert("RGB").quantize(256)
    rest = (
        Image.fromarray(frame).convert("RGB").quantize(palette=first, dither=Image.Dither.NONE)
        for frame in frames
    )
    delay = 10 * round(100 / fps)
    more: Any = {"save_all": True, "append_images": rest, "duration": delay, "loop": 0}
    with out.open("wb") as file:
        first.save(file, format="GIF", **more)


def _ffmpeg() -> str:
    """Return where ffmpeg is, or say what to do without it."""
    found = shutil.which("ffmpeg")
    if found is None:
        message = (
            "an MP4 needs the program ffmpeg, which is not found (apt install ffmpeg, "
            "brew install ffmpeg); names that end in .gif or .html need none"
        )
        raise from_kind("unsuitable", message)
    return found


def _write_mp4(ffmpeg: str, frames: Iterator[Frame], out: Path, *, fps: float) -> None:
    first = next(frames)
    height, width, _ = first.shape
    raw = ["-f", "rawvideo", "-pix_fmt", "rgba", "-s", f"{width}x{height}", "-r", f"{fps:g}"]
    coded = ["-an", "-pix_fmt", "yuv420p", "-movflags", "+faststart", str(out)]
    command = [ffmpeg, "-loglevel", "error", "-y", *raw, "-i", "-", *coded]
    with (
        tempfile.TemporaryFile() as complaints,
        subprocess.Popen(command, stdin=subprocess.PIPE, stderr=complaints) as process,
    ):
        try:
            with contextlib.suppress(BrokenPipeError):
                for frame in chain([first], frames):
                    process.stdin.write(frame.tobytes())  # type: ignore[union-attr]
            process.communicate()
        except BaseException:
            process.kill()
            raise
        if process.returncode != 0:
            complaints.seek(0)
            raise OSError(f"ffmpeg says: {complaints.read().decode(errors='replace').strip()}")


def _frames(
    games: Sequence[Recording],
    times: Sequence[float],
    title: str,
    size: tuple[int, int],
    progress: Progress | None,
) -> Iterator[Frame]:
    """Yield the picture of each time; only what moves is drawn anew."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(size[0] / 100, size[1] / 100), dpi=100, layout="constrained")
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    robots = _draw_still(axes, games, title)
    clock: Any = {"transform": axes.transAxes, "ha": "right", "va": "top", "family": "monospace"}
    text = axes.text(0.985, 0.975, "", **clock, animated=True)
    canvas.draw()  # type: ignore[no-untyped-call]
    still = canvas.copy_from_bbox(figure.bbox)  # type: ignore[no-untyped-call]
    for index, time in enumerate(times):
        canvas.restore_region(still)  # type: ignore[no-untyped-call]
        text.set_text(f"{time:.2f} s")
        for artist in chain(*(robot.moved(time) for robot in robots), [text]):
            axes.draw_artist(artist)
        yield np.array(canvas.buffer_rgba())  # type: ignore[no-untyped-call]
        if progress is not None:
            progress(index + 1, len(times))


def _tall(games: Sequence[Recording]) -> float:
    """Return how high the picture is, as a share of its width."""
    places = np.concatenate([robot.poses[:, :2] for game in games for robot in game.robots])
    width, height = np.ptp(places, axis=0)
    return float(np.clip((height / (width or 1.0)) * 0.85 + 0.2, 0.45, 0.84))


def _draw_still(axes: Axes, games: Sequence[Recording], title: str) -> list[_Robot]:
    """Draw what does not move, and return what does."""
    colour, style = colours(games), line_styles(games)
    robots = [
        _Robot(axes, game, robot, plot.COLOURS[colour[robot.name] % 7], style[game.label])
        for game in games
        for robot in game.robots
    ]
    for game in games:
        if game.wall is not None:
            axes.plot(*game.wall.T, color="0.35", linewidth=2.5, zorder=1)
        dashes: Any = _DASHES[style[game.label] % len(_DASHES)]
        ended = ": ".join(filter(None, [game.label, game.outcome()]))
        axes.plot([], [], linestyle=dashes, color="0.35", label=_plain(ended))
    axes.set(xlabel="x [m]", ylabel="y [m]", title=_plain(title))
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.08)
    axes.grid(alpha=0.25, linewidth=0.6)
    axes.figure.legend(loc="outside lower center", ncols=3, frameon=False, fontsize=8)
    return robots


def _plain(text: str) -> str:
    """Return a text that matplotlib takes neither for mathematics nor for a hidden label."""
    text = text.replace("$", r"\$")
    return f" {text}" if text.startswith("_") else text


class _Robot:
    """A robot of a game in the picture: its path so far, itself, and its circle."""

    def __init__(
        self, axes: Axes, game: Recording, robot: RecordedRobot, colour: str, style: int
    ) -> None:
        from matplotlib.patches import Circle
        from matplotlib.path import Path as Outline

        self._game, self._robot = game, robot
        self._x, self._y = robot.poses[:, 0], robot.poses[:, 1]
        self._heading = np.unwrap(np.remainder(robot.poses[:, 2], math.tau))
        dashes: Any = _DASHES[style % len(_DASHES)]
        axes.plot(self._x, self._y, linestyle=dashes, color=colour, alpha=0.2, linewidth=1.2)
        axes.plot(self._x[0], self._y[0], "o", color=colour, markersize=4)
        moving: Any = {"color": colour, "animated": True}
        (self._trail,) = axes.plot([], [], linestyle=dashes, linewidth=1.6, **moving)
        self._outline = Outline(np.array(_OUTLINE))
        # That of the last game is filled; those below it are not.
        body: Any = {"linestyle": "", "markersize": 11, "marker": self._outline, "color": colour}
        body["markerfacecolor"] = colour if style == 0 else "white"
        (self._body,) = axes.plot([], [], **body, animated=True)
        if style == 0:
            axes.plot([], [], **body, label=_plain(robot.name or robot.role))
        self._circle = None
        if robot.role == "pursuer" and game.capture_radius is not None:
            self._circle = Circle((0, 0), game.capture_radius, fill=False, **moving)
            axes.add_artist(self._circle)
        self._ring = None
        if robot.role == "evader" and game.capture_time is not None:
            ring: Any = {"marker": "o", "markersize": 18, "fillstyle": "none"}
            (self._ring,) = axes.plot([self._x[-1]], [self._y[-1]], **ring, **moving)

    def moved(self, time: float) -> Iterator[Artist]:
        """Yield what shows the robot at a time [s]; behind its path's end it stands still."""
        from matplotlib.markers import MarkerStyle

        place = self._place(time)
        x, y, heading = (_between(each, place) for each in (self._x, self._y, self._heading))
        seen = math.floor(place) + 1
        self._trail.set_data(np.append(self._x[:seen], x), np.append(self._y[:seen], y))
        self._body.set_data([x], [y])
        self._body.set_marker(MarkerStyle(self._outline).rotated(rad=heading))
        yield from (self._trail, self._body)
        if self._circle is not None:
            self._circle.center = (x, y)
            yield self._circle
        if self._ring is not None and time >= (self._game.capture_time or 0.0) - 1e-6:
            yield self._ring

    def _place(self, time: float) -> float:
        """Return where in its path the robot is."""
        last = len(self._x) - 1
        step = self._game.time_step
        return min(round(time / step, 6), last) if step > 0 else last


def _between(values: NDArray[np.float64], place: float) -> float:
    return float(np.interp(place, np.arange(len(values)), values))
