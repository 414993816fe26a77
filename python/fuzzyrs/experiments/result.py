"""Results of experiments: rows beside the published numbers, and the one JSON layout."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from fuzzyrs._fuzzyrs import __version__
from fuzzyrs.errors import FormatError, from_kind
from fuzzyrs.experiments.statistics import interquartile_mean, interquartile_mean_interval
from fuzzyrs.recording import Recording, is_number

# A measured or published value; None where there is none (not captured, lost in the scan).
Value = float | None

#: No number has more decimal places.
MOST_DIGITS = 17


@dataclass(frozen=True)
class Row:
    """One row of a table: what was printed and what came out, column by column.

    Attributes
    ----------
    name : str
        What the row is about.
    columns : list of str
        What the columns are.
    published : list of float or None
        The printed values; None where the scan lost one.
    per_seed : list of list of float or None
        Ours, a list for each seed; None where there is no value, as when the evader escapes.
    verdict : str
        "reproduced", "close", "differs" or "can't be checked".
    reason : str
        The verdict's reason, in a sentence.
    digits : int
        How many decimal places are worth printing.
    """

    name: str
    columns: list[str]
    published: list[Value]
    per_seed: list[list[Value]]
    verdict: str = ""
    reason: str = ""
    digits: int = 1

    def column(self, index: int) -> list[float]:
        """Our values of a column in rising order; what has none counts as infinite."""
        values = (seed[index] for seed in self.per_seed)
        return sorted(math.inf if value is None else value for value in values)

    def _each(self, statistic: Any) -> list[Value]:
        return [finite(statistic(self.column(index))) for index in range(len(self.columns))]

    @property
    def median(self) -> list[Value]:
        """Our medians; None where half of the seeds or more have no value."""
        return self._each(lambda v: rounded((v[(len(v) - 1) // 2] + v[len(v) // 2]) / 2))

    @property
    def low(self) -> list[Value]:
        """Our smallest values."""
        return self._each(lambda v: v[0])

    @property
    def high(self) -> list[Value]:
        """Our largest values; None where a seed has none."""
        return self._each(lambda v: v[-1])

    @property
    def mean(self) -> list[Value]:
        """Our means over the seeds that have a value."""
        return self._each(lambda v: _mean([x for x in v if not math.isinf(x)]))

    @property
    def interquartile_mean(self) -> list[Value]:
        """Our means of the middle half; None where a seed in it has no value."""
        return self._each(lambda v: rounded(interquartile_mean(v)))

    @property
    def interval(self) -> list[tuple[Value, Value]]:
        """The 95 % bootstrap intervals of the interquartile means; None is beyond all numbers."""
        each = (interquartile_mean_interval(self.column(i)) for i in range(len(self.columns)))
        return [(finite(rounded(low)), finite(rounded(high))) for low, high in each]

    def missing(self, index: int) -> int:
        """How many seeds have no value in a column."""
        return sum(seed[index] is None for seed in self.per_seed)

    def to_dict(self) -> dict[str, Any]:
        """Return the row in the layout that every experiment's JSON has."""
        return {
            "name": self.name,
            "columns": self.columns,
            "published": self.published,
            "median": self.median,
            "low": self.low,
            "high": self.high,
            "interquartile_mean": self.interquartile_mean,
            "interval": self.interval,
            "per_seed": self.per_seed,
            "verdict": self.verdict,
            "reason": self.reason,
            "digits": self.digits,
        }

    @staticmethod
    def from_dict(values: Mapping[str, Any]) -> Row:
        """Return the row of a result's JSON; medians and their like follow from its values.

        Raises
        ------
        FormatError
            If a value is of another type, or there is not one for each column.
        """
        names = ("name", "columns", "published", "per_seed", "verdict", "reason", "digits")
        row = Row(**{name: values[name] for name in names})
        texts = [row.name, row.verdict, row.reason, *row.columns]
        _require(isinstance(row.columns, list) and row.columns, "a row has columns")
        _require(all(isinstance(text, str) for text in texts), "names and reasons are texts")
        for cells in (row.published, *row.per_seed):
            _require(
                isinstance(cells, list)
                and len(cells) == len(row.columns)
                and all(cell is None or is_number(cell) for cell in cells),
                f'"published" and "per_seed" of {row.name!r} have a number or null for each column',
            )
        _require(
            type(row.digits) is int and 0 <= row.digits <= MOST_DIGITS,
            f'"digits" is from 0 to {MOST_DIGITS}',
        )
        return row


def _require(holds: object, what: str) -> None:
    if not holds:
        raise from_kind("format", f"it is not a result: {what}")


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values) if values else math.inf


def total(values: Sequence[Value]) -> Value:
    """Return the sum, or None if a value is missing."""
    there = [value for value in values if value is not None]
    return rounded(math.fsum(there)) if len(there) == len(values) else None


def finite(value: float) -> Value:
    """Return the value, or None in the place of infinity."""
    return None if math.isinf(value) else value


def infinite(value: Value) -> float:
    """Return the value, or infinity in the place of one that is missing."""
    return math.inf if value is None else value


def rounded(value: float) -> float:
    """Return the value cleared of the rounding error of decimal fractions."""
    return round(value, 9) if math.isfinite(value) else value


@dataclass(frozen=True)
class Result:
    """The outcome of an experiment over several seeds: all that tables and figures are made of.

    Attributes
    ----------
    id : str
        The experiment's.
    seeds : list of int
        In the order of each row's `per_seed`.
    config : dict
        Everything that the result depends on besides the seeds and the version.
    rows : list of Row
        The table.
    run : dict
        Times and the machine, which no two runs share.
    outcomes : list of dict
        What the rows were made of, seed by seed; kept beside the JSON, not in it.
    games : list of Recording
        What figures and animations show; kept beside the JSON, not in it.
    games_digest : str or None
        The SHA-256 of the file with the games, by which they are known to be of the same run; None
        without one.
    """

    id: str
    seeds: list[int]
    config: dict[str, Any]
    rows: list[Row]
    run: dict[str, Any]
    outcomes: list[dict[str, Any]] = field(default_factory=list, repr=False)
    games: list[Recording] = field(default_factory=list, repr=False)
    games_digest: str | None = None

    def to_json(self) -> str:
        """Return the result as JSON; all but `run` is the same for the same seeds and config."""
        document = {
            "id": self.id,
            "version": __version__,
            "seeds": self.seeds,
            "config": self.config,
            "rows": [row.to_dict() for row in self.rows],
            "games": self.games_digest,
            "run": self.run,
        }
        return json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False) + "\n"

    @staticmethod
    def from_json(text: str) -> Result:
        """Return the result in a JSON, without outcomes and games, or say what is wrong with it."""
        try:
            document = json.loads(text)
            # Refuses what could not be written again: infinity, and halves of characters.
            json.dumps(document, ensure_ascii=False, allow_nan=False).encode()
            if document["version"] != __version__:
                raise from_kind(
                    "unsupported",
                    f"it is of fuzzyrs {document['version']}, this is {__version__}; "
                    "reproduce it again",
                )
            rows = [Row.from_dict(row) for row in document["rows"]]
            plain = {name: document[name] for name in ("id", "seeds", "config", "run")}
            result = Result(rows=rows, games_digest=document.get("games"), **plain)
        except FormatError:
            raise
        except (KeyError, TypeError, ValueError, RecursionError) as error:
            raise from_kind("format", f"it is not a result: {error!r}") from error
        result._check()
        return result

    def _check(self) -> None:
        """Say what is wrong with values that were read."""
        seeds = self.seeds
        _require(isinstance(self.id, str), '"id" is a text')
        _require(isinstance(seeds, list) and seeds, '"seeds" has one at least')
        _require(all(type(seed) is int for seed in seeds), '"seeds" are whole numbers')
        _require(
            self.games_digest is None or isinstance(self.games_digest, str), '"games" is a text'
        )
        _require(isinstance(self.config, dict), '"config" is an object')
        _require(isinstance(self.run, dict), '"run" is an object')
        for row in self.rows:
            _require(
                isinstance(row.per_seed, list) and len(row.per_seed) == len(seeds),
                f'"per_seed" of {row.name!r} has a list for each seed',
            )
