"""TOML documents whose errors name the line; parsers of TOML don't tell where a key stands."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from fuzzyrs.errors import FuzzyrsError, from_kind
from fuzzyrs.studies.settings import unknown

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

#: The way to a value: tables, and then its key.
Keys = tuple[str, ...]

#: More than that no person wrote.
MOST_BYTES = 1_000_000
#: Parsers take time in proportion to the square of this.
MOST_DOTS = 100


class Document:
    """A TOML file.

    Parameters
    ----------
    path : pathlib.Path
        Where it is.

    Raises
    ------
    FileError
        If it cannot be read.
    FormatError
        If it is not TOML.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        text = self._read()
        for names in _NAMES.finditer(text):
            if names.group().count(".") > MOST_DOTS:
                line = text.count("\n", 0, names.start()) + 1
                raise self._wrong(line, f"there are more than {MOST_DOTS} dots in this name")
        try:
            self.tree: dict[str, Any] = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            message = str(error)
            if place := re.search(r" \(at line (\d+), column \d+\)$", message):
                raise self._wrong(int(place[1]), message[: place.start()]) from error
            raise self._wrong(text.count("\n") + 1, message) from error
        except (RecursionError, ValueError) as error:
            reason = "nested too deeply" if isinstance(error, RecursionError) else str(error)
            raise self._wrong(1, f"this document cannot be read: {reason}") from error
        self._lines = key_lines(text)

    def _read(self) -> str:
        try:
            with self.path.open("rb") as file:
                data = file.read(MOST_BYTES + 1)
        except OSError as error:
            message = f"cannot read {self.path}: {error.strerror or error}"
            raise from_kind("file", message) from error
        if len(data) > MOST_BYTES:
            raise self._wrong(1, f"a study file has at most {MOST_BYTES} bytes; is this one?")
        try:
            return data.decode().replace("\r\n", "\n")
        except UnicodeDecodeError as error:
            line = data[: error.start].count(b"\n") + 1
            raise self._wrong(line, "this is no text in UTF-8") from error

    def table(self, *keys: str) -> dict[str, Any]:
        """Return the table that the keys lead to; an empty one if there is none."""
        table: Any = self.tree
        for depth, key in enumerate(keys, start=1):
            table = table.get(key, {})
            if not isinstance(table, dict):
                name = ".".join(keys[:depth])
                raise self.error(keys[:depth], f"{name!r} must be a table, got {table!r}")
        found: dict[str, Any] = table
        return found

    def check_keys(self, table: Keys, known: Iterable[str]) -> None:
        """Raise an error at the first key of a table that isn't known."""
        for key in self.table(*table):
            if key not in known:
                kind, place = ("key", f" in [{'.'.join(table)}]") if table else ("table", "")
                raise self.error((*table, key), str(unknown(kind, key, known, place)))

    @contextmanager
    def naming(self, keys: Keys) -> Iterator[None]:
        """Say of errors in a block of code that they are about the value of a key."""
        try:
            yield
        except FuzzyrsError as error:
            # An error that names a line already stays what it is.
            named = str(error).startswith(f"{self.path}:")
            raise error if named else self.error(keys, str(error)) from error

    def error(self, keys: Keys, message: str) -> FuzzyrsError:
        """Return an error about the value of a key."""
        while keys and keys not in self._lines:
            # Keys in inline tables are on the line of their table.
            keys = keys[:-1]
        return self._wrong(self._lines.get(keys, 1), message)

    def _wrong(self, line: int, message: str) -> FuzzyrsError:
        return from_kind("format", f"{self.path}:{line}: {message}")


# What a statement consists of. Quotes and brackets in strings and comments don't count, and a
# string of several lines may end with two quotes more than it takes.
_PART = re.compile(
    r'"""(?:[^\\]|\\.)*?"""(?:"{0,2})'
    r"|'''.*?'''(?:'{0,2})"
    r'|"(?:[^"\\\n]|\\.)*"'
    r"|'[^'\n]*'"
    r"|(?P<comment>\#[^\n]*)"
    r"|(?P<open>[\[{])"
    r"|(?P<close>[\]}])"
    r"|(?P<equals>=)"
    r"|(?P<end>\n)"
    r"""|[^"'\#\[\]{}=\n]+""",
    flags=re.DOTALL,
)


#: A key with dots in it, or anything that may look like one.
_NAMES = re.compile(r"""[\w"'\-. \t]+""")


def key_lines(text: str) -> dict[Keys, int]:
    """Return the line of each table and of each key that has a value, counted from 1.

    Keys in inline tables are not listed: they are on the line of their table. The text must be a
    document that `tomllib.loads` takes.
    """
    lines: dict[Keys, int] = {}
    table: Keys = ()
    for line, name in _statements(text):
        if name.startswith("["):
            table = keys = _path(tomllib.loads(name))
        else:
            keys = (*table, *_path(tomllib.loads(f"{name} = 0")))
        # A table is where it is first named.
        for depth in range(1, len(keys)):
            lines.setdefault(keys[:depth], line)
        lines[keys] = line
    return lines


def _statements(text: str) -> Iterator[tuple[int, str]]:
    """Yield the headers of tables, and the keys that stand before an equals sign."""
    line, depth, name, named = 1, 0, "", False
    start = line
    for part in _PART.finditer(text):
        kind, content = part.lastgroup, part.group()
        if kind == "end" and depth == 0:
            if name.startswith("["):
                yield start, name.strip()
            name, named = "", False
        elif kind == "equals" and depth == 0 and not named:
            yield start, name.strip()
            name, named = "", True
        elif kind != "comment":
            depth += (kind == "open") - (kind == "close")
            if not named:
                if not name:
                    start = line
                name = (name + content).lstrip()
        line += content.count("\n")
    if name.startswith("["):
        yield start, name.strip()


def _path(document: object) -> Keys:
    """Return the keys that lead to the only value of a document."""
    keys: list[str] = []
    while isinstance(document, dict) and document:
        [(key, document)] = document.items()
        keys.append(key)
    return tuple(keys)
