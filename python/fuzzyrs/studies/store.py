"""Finished runs in an SQLite database: each is there as a whole or not at all."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fuzzyrs.errors import from_kind

#: A value of each parameter.
Point = dict[str, Any]
#: Any value that JSON has.
Outcome = Any

#: The layout of the tables; another one is another version.
VERSION = 1
#: How long another program that writes is waited for (s).
PATIENCE = 60.0
#: Tells our databases from others ("fuzz" in ASCII).
APPLICATION = 0x66757A7A

_TABLES = (
    """CREATE TABLE study (
        id INTEGER PRIMARY KEY AUTOINCREMENT,
        name TEXT NOT NULL UNIQUE,
        definition TEXT NOT NULL
    )""",
    """CREATE TABLE run (
        study INTEGER NOT NULL REFERENCES study (id),
        point TEXT NOT NULL,
        seed INTEGER NOT NULL,
        outcome TEXT,
        error TEXT,
        seconds REAL NOT NULL,
        PRIMARY KEY (study, point, seed)
    ) WITHOUT ROWID""",
)


@dataclass(frozen=True)
class Run:
    """A finished run.

    Attributes
    ----------
    point : dict
        Its place in the grid.
    seed : int
        Its seed.
    outcome : any JSON value
        What came out; None if it failed. Functions of `fuzzyrs.study` give dictionaries.
    error : str or None
        Why it failed, if it did.
    seconds : float
        How long it took.
    """

    point: Point
    seed: int
    outcome: Outcome
    error: str | None
    seconds: float


def point_key(point: Point) -> str:
    """Return a point of a grid as text, the same for equal points."""
    return json.dumps(point, sort_keys=True)


class Store:
    """The runs of one study in a database, which may hold other studies too.

    Parameters
    ----------
    path : pathlib.Path
        The database; made if there is none.
    name : str or None
        Which study; None for the only one.
    definition : dict or None
        What all its runs have in common; None to open a study that must be there.

    Raises
    ------
    FileError
        If the file cannot be opened or written.
    FormatError
        If it is something else, or of another version.
    InvalidValueError
        If the study in it was defined otherwise.
    """

    def __init__(
        self,
        path: Path,
        name: str | None,
        definition: dict[str, Any] | None,
    ) -> None:
        self.path = path
        if definition is None and not path.exists():
            raise from_kind("file", f"there is no study database {path}")
        uri = f"{path.absolute().as_uri()}?mode={'rw' if definition is None else 'rwc'}"
        with _told(path):
            self._connection = sqlite3.connect(
                uri, uri=True, timeout=PATIENCE, isolation_level=None
            )
        try:
            with _told(path):
                # A transaction that has returned survives kill -9 and the loss of power. A
                # write-ahead log would enter it faster, but not on network drives, nor could a
                # finished database be read from a folder that is read-only; batches do as well.
                self._connection.execute("PRAGMA synchronous = EXTRA")
                # A run must not be entered for a study that was removed meanwhile; nor can it come
                # to another study, for numbers of studies are not used again.
                self._connection.execute("PRAGMA foreign_keys = ON")
                if definition is not None:
                    self._make_tables()
                self._check()
                self.name, self._study = self._find(name, definition)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Close the database."""
        self._connection.close()

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _make_tables(self) -> None:
        """Make the tables of a new database."""
        if not self._tables():
            with self._transaction():
                # Another process may have been faster.
                if not self._tables():
                    for statement in _TABLES:
                        self._connection.execute(statement)
                    self._connection.execute(f"PRAGMA application_id = {APPLICATION}")
                    self._connection.execute(f"PRAGMA user_version = {VERSION}")

    def _check(self) -> None:
        """See whether the database is one of studies, and of this version."""
        [application] = self._connection.execute("PRAGMA application_id").fetchone()
        [version] = self._connection.execute("PRAGMA user_version").fetchone()
        if application != APPLICATION:
            raise from_kind(
                "format", f"{self.path} is a database, but not one of studies; choose another file"
            )
        if version != VERSION:
            raise from_kind(
                "unsupported",
                f"the studies in {self.path} are of version {version}, this fuzzyrs reads version "
                f"{VERSION}; use the fuzzyrs that wrote them, or choose another file",
            )

    def _tables(self) -> int:
        [count] = self._connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
        return int(count)

    def _find(self, name: str | None, definition: dict[str, Any] | None) -> tuple[str, int]:
        """Return the name and the number of a study; a new one is entered."""
        if name is None:
            [*others, name] = self.names() or [""]
            if others:
                raise from_kind(
                    "unknown_name", f"name one of the studies in {self.path}: {self._all()}"
                )
        if definition is not None:
            self._enter(name, json.dumps(definition, sort_keys=True))
        found = self._connection.execute("SELECT id FROM study WHERE name = ?", [name]).fetchone()
        if found is None:
            message = f"there is no study {name!r} in {self.path}; it has {self._all()}"
            raise from_kind("unknown_name", message)
        return name, int(found[0])

    def _enter(self, name: str, definition: str) -> None:
        """Enter a study that is new, or see whether it was defined like that."""
        with self._transaction():
            self._connection.execute(
                "INSERT OR IGNORE INTO study (name, definition) VALUES (?, ?)", [name, definition]
            )
            [known] = self._connection.execute(
                "SELECT definition FROM study WHERE name = ?", [name]
            ).fetchone()
        if known != definition:
            raise from_kind(
                "unsuitable",
                f"the study {name!r} in {self.path} was defined otherwise: "
                f"{_difference(known, definition)}; give this one another name",
            )

    def _all(self) -> str:
        return ", ".join(map(repr, self.names())) or "none"

    def names(self) -> list[str]:
        """Return the names of all studies in the database."""
        with _told(self.path):
            rows = self._connection.execute("SELECT name FROM study ORDER BY id")
            return [name for (name,) in rows]

    def done(self) -> set[tuple[str, int]]:
        """Return which runs are finished: `point_key` and seed. Failed ones are not."""
        with _told(self.path):
            rows = self._connection.execute(
                "SELECT point, seed FROM run WHERE study = ? AND error IS NULL", [self._study]
            )
            return {(point, _unsigned(seed)) for point, seed in rows}

    def add(self, runs: Iterable[Run], *, anew: bool = False) -> None:
        """Enter finished runs in one transaction; when this returns, they are on disk.

        A run that is there already stays, unless it had failed or was done anew.
        """
        rows = [
            (
                self._study,
                point_key(run.point),
                _signed(run.seed),
                json.dumps(run.outcome) if run.error is None else None,
                # Half of a surrogate pair is no text for a database.
                run.error and run.error.encode(errors="backslashreplace").decode(),
                run.seconds,
            )
            for run in runs
        ]
        with _told(self.path), self._transaction():
            self._connection.executemany(
                "INSERT INTO run VALUES (?, ?, ?, ?, ?, ?) ON CONFLICT DO UPDATE SET "
                "outcome = excluded.outcome, error = excluded.error, seconds = excluded.seconds "
                f"WHERE {'TRUE' if anew else 'error IS NOT NULL'}",
                rows,
            )

    def runs(self) -> list[Run]:
        """Return all finished runs, failed ones too, in the order of points and seeds."""
        with _told(self.path):
            rows = self._connection.execute(
                "SELECT point, seed, outcome, error, seconds FROM run WHERE study = ? "
                "ORDER BY point, seed < 0, seed",
                [self._study],
            ).fetchall()
        try:
            return [
                Run(
                    point=json.loads(point),
                    seed=_unsigned(seed),
                    outcome=json.loads(outcome) if error is None else None,
                    error=error,
                    seconds=seconds,
                )
                for point, seed, outcome, error, seconds in rows
            ]
        except (TypeError, ValueError) as error:
            message = f"a run of {self.name!r} in {self.path} was changed by another program"
            raise from_kind("format", f"{message} ({error})") from error

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        try:
            self._connection.execute("BEGIN IMMEDIATE")
            yield
            self._connection.execute("COMMIT")
        except BaseException:
            # Ctrl-C may come between any two of these lines.
            if self._connection.in_transaction:
                self._connection.execute("ROLLBACK")
            raise


def _difference(known: str, new: str) -> str:
    """Say where two definitions differ."""
    before, now = json.loads(known), json.loads(new)
    return ", ".join(
        f"{key} was {before.get(key)!r}, is {now.get(key)!r}"
        for key in sorted(before.keys() | now.keys())
        if before.get(key) != now.get(key)
    )


def _signed(seed: int) -> int:
    """Return a seed of 64 bits as the integer of the same bits that SQLite has."""
    return seed - 2**64 if seed >= 2**63 else seed


def _unsigned(number: int) -> int:
    return number + 2**64 if number < 0 else number


@contextmanager
def _told(path: Path) -> Iterator[None]:
    """Say what is wrong with a database in the words of its user."""
    try:
        yield
    except sqlite3.OperationalError as error:
        advice = next(
            (advice for words, advice in _ADVICE.items() if words in str(error)), str(error)
        )
        message = f"cannot use the study database {path}: {advice}; finished runs in it are intact"
        raise from_kind("file", message) from error
    except sqlite3.IntegrityError as error:
        message = (
            f"cannot add runs to {path}: another program has removed or replaced their study "
            f"meanwhile ({error}); run the study again, with a database or a name of its own"
        )
        raise from_kind("file", message) from error
    except sqlite3.DatabaseError as error:
        message = f"{path} is not a study database ({error}); choose another file"
        raise from_kind("format", message) from error


_ADVICE = {
    "unable to open": "the folder does not exist or cannot be written",
    "readonly": "it cannot be written; change its permissions or choose another file",
    "disk is full": "the disk is full; free some space and run the study again",
    "locked": f"another program writes to it for more than {PATIENCE:g} s; wait for that to end",
}
