"""`fuzzyrs animate`: a recorded game as a moving picture, or as a page that plays it."""

from __future__ import annotations

import argparse
import json
import sys
from contextlib import closing
from pathlib import Path
from typing import Any

from tqdm import tqdm

from fuzzyrs.animation import ENDINGS, animate, chosen_panel
from fuzzyrs.errors import from_kind
from fuzzyrs.recording import FORMAT, Recording, by_panel, load_games


def add_parser(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser("animate", help="make a GIF, an MP4 or a page of a recorded game")
    parser.add_argument(
        "result",
        type=Path,
        metavar="RESULT",
        help="recorded games, or a result beside which they lie, such as results/table-6-3.json",
    )
    parser.add_argument(
        "--out",
        type=Path,
        required=True,
        metavar="FILE",
        help=f"what to write; its ending is one of {', '.join(ENDINGS)}",
    )
    parser.add_argument(
        "--game",
        metavar="NAME",
        help="which, by its name or a part of it (default: the first)",
    )
    parser.add_argument("--fps", type=float, default=20.0, help="pictures a second (20)")
    parser.add_argument(
        "--speed", type=float, help="how many times faster it is shown (default: in 12 s at most)"
    )
    parser.add_argument("--size", type=int, default=640, help="the width in pixels (640)")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Write the file and print where it is."""
    title, games = recorded(options.result)
    picture = options.out.suffix != ".html"
    if picture or options.game is not None:
        name = chosen_panel(games, options.game)
        others = [each for each in by_panel(games) if each != name]
        if others and options.game is None:
            print(f"game: {name} (--game for: {'; '.join(others)})", file=sys.stderr)
    with closing(tqdm(unit="picture", file=sys.stderr, disable=not sys.stderr.isatty())) as shown:

        def progress(done: int, total: int) -> None:
            shown.total = total
            shown.update(done - shown.n)

        path = animate(
            games,
            options.out,
            panel=options.game,
            title=title if options.game is None and not picture else "",
            fps=options.fps,
            speed=options.speed,
            size=options.size,
            progress=progress,
        )
    print(f"wrote {path}")
    return 0


def recorded(path: Path) -> tuple[str, list[Recording]]:
    """Return the title and the games in a file, or beside it if it is a result.

    Raises
    ------
    FileError
        If it cannot be read.
    FormatError
        If there are no games.
    """
    beside = path.with_name(f"{path.stem}.games.json")
    if path.suffix == ".json" and not path.name.endswith(".games.json") and _is_result(path):
        if not beside.exists():
            raise from_kind("format", f"{path} is a result without recorded games ({beside})")
        path = beside
    title, games = load_games(path)
    if not games:
        raise from_kind("format", f"{path} has no games")
    return title, games


def _is_result(path: Path) -> bool:
    """Tell whether a file is a result; what cannot be read is told by who reads the games."""
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return False
    return isinstance(document, dict) and document.get("format") != FORMAT and "rows" in document
