"""What several commands take."""

from __future__ import annotations

import argparse
from pathlib import Path


def positive(text: str) -> int:
    """Return a whole number of at least 1."""
    count = natural(text)
    if count == 0:
        raise argparse.ArgumentTypeError("must be at least 1, got 0")
    return count


def natural(text: str) -> int:
    """Return a whole number of at least 0."""
    try:
        count = int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a whole number, got {text!r}") from None
    if count < 0:
        raise argparse.ArgumentTypeError(f"must be zero or more, got {count}")
    return count


def add_folder(parser: argparse.ArgumentParser) -> None:
    """Add the option that says where results are."""
    parser.add_argument(
        "--out", type=Path, default=Path("results"), metavar="DIR", help="default: results"
    )
