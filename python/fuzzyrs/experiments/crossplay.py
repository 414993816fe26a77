"""How well two robots play that learned against each other.

A short capture may come from a good pursuer or from a bad evader. So each plays a classical
opponent too, and the paths of both are compared with the classical ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from fuzzyrs._fuzzyrs import OneOnOne, Trajectory
from fuzzyrs.experiments.result import Value

Start = tuple[float, float]


@dataclass(frozen=True)
class CrossPlay:
    """What came of it, start by start.

    Attributes
    ----------
    classical, together, pursuer, evader : list of float or None
        Capture times [s] of classical against classical, learned against learned, the learned
        pursuer against the classical evader, and the classical pursuer against the learned
        evader; None for an escape.
    pursuer_distance, evader_distance : list of float
        How far the robots that learned together are from the classical ones [m], on average over
        the time until the first of both games ends.
    """

    classical: list[Value]
    together: list[Value]
    pursuer: list[Value]
    evader: list[Value]
    pursuer_distance: list[float]
    evader_distance: list[float]

    def to_dict(self) -> dict[str, Any]:
        """Return the same as plain values."""
        return asdict(self)

    def measures(self, limit: float) -> list[float]:
        """Return the five numbers of `MEASURES`; an escape counts as a capture at the limit [s]."""
        classical, pursuer, evader = (
            np.array([limit if time is None else time for time in times])
            for times in (self.classical, self.pursuer, self.evader)
        )
        return [
            float((pursuer - classical).max()),
            float((evader - classical).min()),
            100 * sum(time is None for time in self.together) / len(self.together),
            float(np.mean(self.pursuer_distance)),
            float(np.mean(self.evader_distance)),
        ]


#: What the pursuer loses against a classical evader from its worst start [s]; what the evader wins
#: against a classical pursuer from its worst start [s]; escapes together [%]; distances of the
#: paths [m].
MEASURES = (
    "pursuer's loss [s]",
    "evader's gain [s]",
    "escapes [%]",
    "pursuer's path [m]",
    "evader's path [m]",
)


def cross_play(
    game: OneOnOne, pursuer: Any, evader: Any, starts: Sequence[Start], limit: float
) -> CrossPlay:
    """Play all four games from each start; `limit` ends a game [s]."""

    def play(one: Any, other: Any) -> list[Trajectory]:
        return [game.play(one, other, evader_start=start, max_time=limit) for start in starts]

    classical, together = play("classical", "classical"), play(pursuer, evader)
    pairs = list(zip(together, classical, strict=True))
    return CrossPlay(
        classical=[path.capture_time for path in classical],
        together=[path.capture_time for path in together],
        pursuer=[path.capture_time for path in play(pursuer, "classical")],
        evader=[path.capture_time for path in play("classical", evader)],
        pursuer_distance=[_apart(one.pursuer, other.pursuer) for one, other in pairs],
        evader_distance=[_apart(one.evader, other.evader) for one, other in pairs],
    )


def _apart(path: np.ndarray[Any, Any], other: np.ndarray[Any, Any]) -> float:
    """Return the mean distance of two robots at the same times [m]."""
    both = min(len(path), len(other))
    return float(np.hypot(*(path[:both, :2] - other[:both, :2]).T).mean())
