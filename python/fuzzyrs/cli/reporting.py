"""`fuzzyrs report`: all saved results as one page."""

from __future__ import annotations

import argparse
import sys
from typing import Any

from fuzzyrs.cli.arguments import add_folder
from fuzzyrs.report import build


def add_parser(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser("report", help="make one page, report.html, of all saved results")
    add_folder(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Build the report and print where it is."""

    def progress(identifier: str) -> None:
        if sys.stderr.isatty():
            print(f"\r\033[K{identifier}", end="", file=sys.stderr, flush=True)

    try:
        path = build(options.out, progress=progress)
    finally:
        if sys.stderr.isatty():
            print("\r\033[K", end="", file=sys.stderr, flush=True)
    print(f"wrote {path}")
    return 0
