"""The command line: reproduce experiments, run studies, look at what came out."""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections.abc import Sequence

from fuzzyrs import __version__
from fuzzyrs.cli import animating, listing, reporting, reproducing, studying
from fuzzyrs.errors import FuzzyrsError

FAILED = 1
BAD_USAGE = 2
INTERRUPTED = 130

#: Each adds its commands; a command's `run` takes the options and returns the exit code.
COMMANDS = (listing, reproducing, studying, reporting, animating)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    # Where they were closed, Python has none.
    sys.stdout = sys.stdout or io.StringIO()
    sys.stderr = sys.stderr or io.StringIO()
    options = _parser().parse_args(arguments)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            # A terminal or pipe without Greek letters gets question marks, not a traceback.
            stream.reconfigure(errors="replace")
    try:
        return int(options.run(options))
    except KeyboardInterrupt as interruption:
        how = "" if getattr(options, "resume", True) else " without --no-resume"
        kept = f"{interruption}; the same command{how} goes on from there"
        print(kept if str(interruption) else "interrupted", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        # Whoever read our output has gone; nothing more can be said, not even at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
    except FuzzyrsError as error:
        notes = getattr(error, "__notes__", [])  # Python 3.11
        print("\n".join([f"fuzzyrs: {error}", *notes]), file=sys.stderr)
        return BAD_USAGE if error.kind in {"unknown_name", "out_of_range"} else FAILED
    except (ImportError, OSError) as error:
        print(f"fuzzyrs: {error}", file=sys.stderr)
        return FAILED


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="fuzzyrs", description="Fuzzy controllers that learn: reproduce the thesis's results."
    )
    parser.add_argument("--version", action="version", version=f"fuzzyrs {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for module in COMMANDS:
        module.add_parser(commands)
    return parser
