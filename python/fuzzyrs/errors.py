"""Exceptions. Each inherits `FuzzyrsError` and the built-in exception that fits."""

from __future__ import annotations

from typing import Any

__all__ = [
    "CancelledError",
    "DivergedError",
    "FileError",
    "FormatError",
    "FuzzyrsError",
    "InvalidTypeError",
    "InvalidValueError",
    "MemoryLimitError",
    "NoRuleFiresError",
    "RuleError",
    "ShapeError",
    "ThreadsError",
    "UnknownNameError",
    "UsageError",
]


class FuzzyrsError(Exception):
    """Anything that fuzzyrs raises on its own.

    Attributes
    ----------
    kind : str
        What went wrong, more finely than the class; stable, for programs.
    """

    kind: str = "unknown"


class InvalidValueError(FuzzyrsError, ValueError):
    """A number or name outside its range."""


class InvalidTypeError(FuzzyrsError, TypeError):
    """An argument of a type that does not fit."""


class ShapeError(FuzzyrsError, ValueError):
    """A number of things, or the shape of an array, does not fit."""


class UnknownNameError(FuzzyrsError, LookupError):
    """A name that is not known."""


class NoRuleFiresError(FuzzyrsError, ArithmeticError):
    """No rule of a fuzzy system fires, so its output is undefined."""


class RuleError(FuzzyrsError, ValueError):
    """A rule or a formula cannot be understood, or does not fit the variables."""


class DivergedError(FuzzyrsError, ArithmeticError):
    """A simulation, or a learner, left the numbers that make sense.

    Attributes
    ----------
    so_far : Trained, Fit or None
        What was learned before, if it was a learner of one robot or of two.
    """

    so_far: Any = None


class FormatError(FuzzyrsError, ValueError):
    """A text is not the document it should be, or of a version that is not supported."""


class FileError(FuzzyrsError, OSError):
    """A file could not be read or written."""


class UsageError(FuzzyrsError, RuntimeError):
    """Calls in an order that makes no sense."""


class CancelledError(FuzzyrsError, RuntimeError):
    """Work was stopped on request."""


class MemoryLimitError(FuzzyrsError, MemoryError):
    """Something would need more memory than there is."""


class ThreadsError(FuzzyrsError, RuntimeError):
    """Threads, or other workers, could not be started, or ended too early."""


_CLASSES: dict[str, type[FuzzyrsError]] = {
    "not_finite": InvalidValueError,
    "out_of_range": InvalidValueError,
    "crossed_vertices": InvalidValueError,
    "duplicate_name": InvalidValueError,
    "bad_name": InvalidValueError,
    "wrong_type": InvalidTypeError,
    "wrong_shape": ShapeError,
    "controller_inputs": ShapeError,
    "unsuitable": InvalidValueError,
    "unknown_name": UnknownNameError,
    "no_rule_fires": NoRuleFiresError,
    "expression": RuleError,
    "rule": RuleError,
    "diverged": DivergedError,
    "learning_diverged": DivergedError,
    "format": FormatError,
    "unsupported": FormatError,
    "file": FileError,
    "out_of_order": UsageError,
    "cancelled": CancelledError,
    "memory": MemoryLimitError,
    "threads": ThreadsError,
}


def from_kind(kind: str, message: str) -> FuzzyrsError:
    """Make the exception of a kind of error."""
    error = _CLASSES[kind](message)
    error.kind = kind
    return error
