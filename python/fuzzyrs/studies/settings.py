"""Settings by dotted names, such as "learner.stage_2.iterations", and copies with others."""

from __future__ import annotations

import dataclasses
import difflib
import inspect
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from typing import Any

from fuzzyrs.errors import FuzzyrsError, from_kind

_PLAIN = (bool, int, float, str, tuple, list, type(None))


def changed(settings: Any, changes: Mapping[str, Any]) -> Any:
    """Return settings in which some have other values.

    Parameters
    ----------
    settings : object
        A data class, or settings of fuzzyrs. They may have others in them, also in a row, where
        the places are the names: "learners.0.steps".
    changes : dict
        New values by dotted names. A list stands for a tuple, an int for a float.

    Raises
    ------
    UnknownNameError
        If there is no setting of a name; it names the nearest.
    InvalidTypeError, InvalidValueError
        If a value does not fit.
    """
    return _changed(settings, changes, "")


def _changed(settings: Any, changes: Mapping[str, Any], prefix: str) -> Any:
    """Change settings whose names begin with a prefix."""
    groups: dict[str, dict[str, Any]] = {}
    values = parts(settings)
    for name, value in changes.items():
        head, _, rest = name.partition(".")
        if head not in values or (rest and not parts(values[head])):
            there = [prefix + leaf for leaf in leaves(settings)]
            raise unknown("setting", prefix + name, there)
        if rest:
            groups.setdefault(head, {})[rest] = value
        else:
            values[head] = _fitting(prefix + name, values[head], value)
    for head, inner in groups.items():
        values[head] = _changed(values[head], inner, f"{prefix}{head}.")
    if isinstance(settings, (tuple, list)):
        return type(settings)(values.values())
    if isinstance(settings, dict):
        return values
    try:
        return type(settings)(**values)
    except FuzzyrsError as error:
        raise from_kind(error.kind, f"{prefix[:-1]}: {error}" if prefix else str(error)) from error


def _fitting(name: str, old: Any, value: Any) -> Any:
    """Return a value as one of the kind that a setting has."""
    if parts(old):
        some = next(leaves(old))
        message = f"{name!r} has several settings in it, such as {f'{name}.{some}'!r}; name one"
        raise from_kind("wrong_type", message)
    if not isinstance(old, _PLAIN):
        message = f"{name!r} is a {type(old).__name__}, which can't be written as a plain value"
        raise from_kind("unsuitable", message)
    if isinstance(old, (tuple, list)) and isinstance(value, (tuple, list)):
        # What no value shows the kind of is checked by whoever uses it.
        return tuple(_fitting(name, old[0], one) if old else _tuple(one) for one in value)
    kinds: tuple[type, ...] = (int, float) if isinstance(old, float) else (type(old),)
    if type(value) in kinds or (old is None and isinstance(value, (str, bool, int, float))):
        return value
    example = f" such as {old!r}" if old else ""
    raise from_kind("wrong_type", f"{name!r} must be {described(old)}{example}, got {value!r}")


def _tuple(value: Any) -> Any:
    return tuple(map(_tuple, value)) if isinstance(value, (tuple, list)) else value


def described(value: Any) -> str:
    """Return in words what kind of plain value this is."""
    words = {
        bool: "true or false",
        int: "a whole number",
        float: "a number",
        str: "a text",
        tuple: "a list",
        list: "a list",
    }
    return words.get(type(value), "a number or a text")


def parts(settings: Any) -> dict[str, Any]:
    """Return the settings in an object by name; none if it is a value."""
    if dataclasses.is_dataclass(settings):
        names = [field.name for field in dataclasses.fields(settings) if field.init]
        return {name: getattr(settings, name) for name in names}
    if isinstance(settings, (tuple, list)) and settings and all(map(parts, settings)):
        return {str(place): part for place, part in enumerate(settings)}
    if isinstance(settings, dict):
        return dict(settings)
    kind: Any = type(settings)
    if hasattr(settings, "to_dict") and kind.__module__.startswith("fuzzyrs"):
        # What a setting is called here and what its constructor calls it is one.
        names = [name for name in _arguments(kind) if hasattr(settings, name)]
        return {name: getattr(settings, name) for name in names}
    return {}


@cache
def _arguments(kind: Any) -> list[str]:
    return list(inspect.signature(kind).parameters)


def leaves(settings: Any) -> Iterator[str]:
    """Yield the dotted names of all settings that have a plain value."""
    for name, part in parts(settings).items():
        if parts(part):
            yield from (f"{name}.{leaf}" for leaf in leaves(part))
        elif isinstance(part, _PLAIN):
            yield name


def unknown(kind: str, name: str, known: Iterable[str], place: str = "") -> FuzzyrsError:
    """Return the error that a name is not known at a place, with the nearest one that is."""
    there = list(known)
    nearest = difflib.get_close_matches(name, there, n=1, cutoff=0.4)
    if not nearest:
        # "iterations" is near to "learner.stage_2.iterations".
        nearest = [other for other in there if other.rpartition(".")[2] == name.rpartition(".")[2]]
    hint = f"did you mean {nearest[0]!r}?" if nearest else f"there are {_listed(there)}"
    return from_kind("unknown_name", f"unknown {kind} {name!r}{place}; {hint}")


def _listed(names: list[str]) -> str:
    more = f" and {len(names) - 8} more" if len(names) > 8 else ""
    return (", ".join(map(repr, names[:8])) or "none") + more
