"""Trainings that several tables and figures show are done once."""

from __future__ import annotations

import json
import time
from collections import OrderedDict
from threading import Lock
from typing import Any, overload

import fuzzyrs._fuzzyrs as native
from fuzzyrs._fuzzyrs import Control, OneOnOne, Trained, TwoPursuers, TwoPursuersTrained

#: So many are kept: 100 seeds of all techniques, some tens of megabytes.
MOST_KEPT = 2000

_kept: OrderedDict[str, tuple[Any, float]] = OrderedDict()
_lock = Lock()


@overload
def train(
    game: OneOnOne, settings: Any, seed: int, control: Control, evader: Any = None
) -> tuple[Trained, float]: ...
@overload
def train(
    game: TwoPursuers, settings: Any, seed: int, control: Control
) -> tuple[TwoPursuersTrained, float]: ...
def train(
    game: Any, settings: Any, seed: int, control: Control, evader: Any = None
) -> tuple[Any, float]:
    """Let a technique learn, or return what it learned before with the same seed.

    Parameters
    ----------
    game, settings, seed, control, evader
        As for `fuzzyrs.train`.

    Returns
    -------
    trained : Trained or TwoPursuersTrained
    seconds : float
        How long it took.
    """
    key = json.dumps([_plain(game), _plain(settings), _plain(evader), seed])
    with _lock:
        if key in _kept:
            _kept.move_to_end(key)
            return _kept[key]
    began = time.perf_counter()
    trained = native.train(game, settings, seed=seed, evader=evader, control=control)
    done = trained, time.perf_counter() - began
    with _lock:
        _kept[key] = done
        if len(_kept) > MOST_KEPT:
            _kept.popitem(last=False)
    return done


def _plain(thing: Any) -> Any:
    """Return what tells a game, settings or a player from all others."""
    if hasattr(thing, "to_dict"):
        return [type(thing).__name__, thing.to_dict()]
    return repr(thing)
