"""What a study is: a function, a grid of its parameters, and seeds."""

from __future__ import annotations

import inspect
import itertools
import math
import operator
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from fuzzyrs._fuzzyrs import __version__
from fuzzyrs.errors import from_kind
from fuzzyrs.studies.store import Point, point_key

Scalar = str | int | float | bool | None

MOST_SEED = 2**64 - 1
#: More runs than this are not planned but mistaken.
MOST_RUNS = 10_000_000


@dataclass(frozen=True)
class Definition:
    """A grid of parameters and the seeds of every point.

    Attributes
    ----------
    name : str
        What the study is called in its database.
    function : str
        What is run, such as "module.function".
    grid : dict
        The values of each parameter.
    seeds : tuple of int
        Of every point.
    settings : dict
        What is fixed for all points.
    """

    name: str
    function: str
    grid: dict[str, tuple[Scalar, ...]]
    seeds: tuple[int, ...]
    settings: dict[str, Any]

    def common(self) -> dict[str, Any]:
        """Return what all runs have in common; grid and seeds may grow."""
        return {
            "function": self.function,
            "parameters": sorted(self.grid),
            "settings": self.settings,
            "version": __version__,
        }

    def points(self) -> list[Point]:
        """Return the points of the grid, the last parameter changing fastest."""
        product = itertools.product(*self.grid.values())
        return [dict(zip(self.grid, values, strict=True)) for values in product]

    def size(self) -> int:
        """Return the number of runs."""
        return math.prod(map(len, self.grid.values())) * len(self.seeds)

    def missing(self, done: set[tuple[str, int]]) -> list[tuple[Point, int]]:
        """Return the runs that are not done, given by `point_key` and seed.

        They come seed by seed, so that an interrupted study has all points alike.
        """
        points = [(point, point_key(point)) for point in self.points()]
        return [
            (point, seed) for seed in self.seeds for point, key in points if (key, seed) not in done
        ]


def define(
    name: str,
    function: str,
    grid: Mapping[str, Iterable[Any]],
    seeds: int | Iterable[int],
    settings: Mapping[str, Any] | None = None,
) -> Definition:
    """Return a checked definition, or say what is wrong with it."""
    check_name(name)
    checked = {str(key): axis(str(key), values) for key, values in grid.items()}
    for reserved in {"seed", "control"} & set(checked):
        raise from_kind("bad_name", f"a parameter can't be called {reserved!r}; rename it")
    definition = Definition(name, function, checked, seed_list(seeds), dict(settings or {}))
    if (count := definition.size()) > MOST_RUNS:
        raise from_kind("out_of_range", f"a study has at most {MOST_RUNS} runs, got {count}")
    return definition


def check_name(name: str) -> None:
    """Refuse a name that a study can't have in a database."""
    if not isinstance(name, str):
        raise from_kind("wrong_type", f"a study's name must be a text, got {name!r}")
    if not name.strip():
        message = f"a study can't be called {name!r}; give it a name, or none for that of what runs"
        raise from_kind("bad_name", message)
    try:
        name.encode()
    except UnicodeEncodeError as error:
        raise from_kind("bad_name", f"a study can't be called {name!r}: it is no text") from error


def name_of(function: Callable[..., Any]) -> str:
    """Return what a function is called in a database, whichever process it is in."""
    if isinstance(function, partial):
        arguments = [*function.args, *function.keywords.values()]
        told = f"{function.args or ''}{function.keywords or ''}" if _plain(arguments) else "(...)"
        return name_of(function.func) + told
    if not callable(function):
        raise from_kind(
            "wrong_type", f"a study runs a function, got {type(function).__name__} {function!r}"
        )
    kind = function if hasattr(function, "__qualname__") else type(function)
    return f"{function.__module__}.{kind.__qualname__}"


def require_own_name(function: Callable[..., Any]) -> None:
    """Refuse a function that others may share the name of; its study must be given one."""
    whose = getattr(function, "__self__", None)
    if isinstance(function, partial):
        require_own_name(function.func)
        kind = "a partial function with such arguments"
        shared = not _plain([*function.args, *function.keywords.values()])
    elif whose is not None and not inspect.ismodule(whose):
        kind, shared = "a method of an object", True
    elif not hasattr(function, "__qualname__"):
        kind, shared = "an object that is called", True
    else:
        kind = "a function without a name of its own"
        shared = "<" in function.__qualname__  # "<lambda>", "outer.<locals>.inner"
    if shared:
        message = (
            f"{name_of(function)} is {kind}, and another one of the same name would be taken for "
            "it; give the study a name of its own: name='...'"
        )
        raise from_kind("bad_name", message)


def _plain(value: Any) -> bool:
    """Tell whether the text of a value tells all of it, in every process."""
    if isinstance(value, dict):
        return _plain([*value, *value.values()])
    if isinstance(value, (list, tuple)):
        return all(map(_plain, value))
    return value is None or isinstance(value, (bool, int, float, str))


def seed_list(seeds: int | Iterable[int]) -> tuple[int, ...]:
    """Return seeds as plain integers: so many from 0 on, or those given."""
    try:
        listed = seeds if isinstance(seeds, Iterable) else range(operator.index(seeds))
        plain = tuple(operator.index(seed) for seed in _planned("the seeds", listed))
    except TypeError as error:
        message = f"seeds must be a whole number or a list of them, got {seeds!r}"
        raise from_kind("wrong_type", message) from error
    if not plain:
        raise from_kind("out_of_range", "a study takes one seed at least")
    if len(set(plain)) < len(plain):
        raise from_kind("out_of_range", "the seeds must differ from each other")
    if not all(0 <= seed <= MOST_SEED for seed in plain):
        raise from_kind("out_of_range", "seeds must be whole numbers from 0 to 2^64 - 1")
    return plain


def axis(key: str, values: Iterable[Any]) -> tuple[Scalar, ...]:
    """Return the values of a parameter, all different."""
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise from_kind(
            "wrong_type", f"the grid's {key!r} must be a list of values, got {values!r}"
        )
    what = f"the values of the grid's {key!r}"
    axis = tuple(
        scalar(f"a value of the grid's {key!r}", value) for value in _planned(what, values)
    )
    if not axis:
        raise from_kind(
            "out_of_range", f"the grid's {key!r} has no values; leave it out or fill it"
        )
    # 1, 1.0 and True are equal, but not the same value.
    if len(set(map(repr, axis))) < len(axis):
        raise from_kind("duplicate_name", f"the grid's {key!r} has a value twice")
    return axis


def _planned(what: str, values: Iterable[Any]) -> list[Any]:
    """Return values as a list, but no endless one."""
    some = list(itertools.islice(values, MOST_RUNS + 1))
    if len(some) > MOST_RUNS:
        raise from_kind("out_of_range", f"{what} are more than {MOST_RUNS}")
    return some


def scalar(what: str, value: Any) -> Scalar:
    """Return a value as a plain one that JSON has; NumPy's numbers too."""
    if hasattr(value, "item") and getattr(value, "ndim", None) == 0:
        value = value.item()
    if isinstance(value, int) and not -(2**63) <= value < 2**64:
        raise from_kind("out_of_range", f"{what} must fit into 64 bits")
    if value is None or isinstance(value, (str, bool, int, float)):
        return value
    raise from_kind(
        "wrong_type",
        f"{what} must be a number, a text, True, False or None, got {type(value).__name__}",
    )


def outcome_of(result: Any) -> dict[str, Scalar]:
    """Return what a function gave as plain values by name."""
    if not isinstance(result, Mapping):
        result = {"value": result}
    return {str(key): scalar(f"the outcome's {key!r}", value) for key, value in result.items()}
