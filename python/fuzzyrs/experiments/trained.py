"""Trainings that several tables and figures show are done once."""

from __future__ import annotations

import json
import time
from collections import OrderedDict
from concurrent.futures import Future
from threading import Lock
from typing import Any, overload

import fuzzyrs._fuzzyrs as native
from fuzzyrs._fuzzyrs import (
    Control,
    OneOnOne,
    Trained,
    TwoPursuers,
    TwoPursuersTrained,
    WallFollowing,
    WallTrained,
)

#: So many are kept: 100 seeds of all techniques, some tens of megabytes.
MOST_KEPT = 2000

_kept: OrderedDict[str, Future[tuple[Any, float]]] = OrderedDict()
_lock = Lock()


@overload
def train(
    game: OneOnOne, settings: Any, seed: int, control: Control, *, evader: Any = None
) -> tuple[Trained, float]: ...
@overload
def train(
    game: TwoPursuers, settings: Any, seed: int, control: Control
) -> tuple[TwoPursuersTrained, float]: ...
@overload
def train(
    game: WallFollowing, settings: Any, seed: int, control: Control, *, expert: Any = None
) -> tuple[WallTrained, float]: ...
def train(
    game: Any, settings: Any, seed: int, control: Control, **others: Any
) -> tuple[Any, float]:
    """Let a technique learn, or return what it learned before with the same seed.

    A thread that wants what another is just learning waits for it.

    Parameters
    ----------
    game, settings, seed, control, evader, expert
        As for `fuzzyrs.train`.

    Returns
    -------
    trained : Trained, TwoPursuersTrained or WallTrained
    seconds : float
        How long it took.
    """
    key = json.dumps([_plain(game), _plain(settings), _plain(others), seed])
    while True:
        with _lock:
            known = _kept.get(key)
            if known is None:
                mine = _kept[key] = Future()
                break
            _kept.move_to_end(key)
        if known.exception() is None:
            return known.result()
        # Whoever began it failed or was stopped, which need not be so again.
    try:
        began = time.perf_counter()
        trained = native.train(game, settings, seed=seed, control=control, **others)
        done = trained, time.perf_counter() - began
    except BaseException as error:
        with _lock:
            del _kept[key]
        mine.set_exception(error)
        raise
    mine.set_result(done)
    with _lock:
        while len(_kept) > MOST_KEPT and next(iter(_kept.values())).done():
            _kept.popitem(last=False)
    return done


def _plain(thing: Any) -> Any:
    """Return what tells a game, settings or players from all others."""
    if isinstance(thing, dict):
        return {name: _plain(other) for name, other in thing.items()}
    if hasattr(thing, "to_dict"):
        return [type(thing).__name__, thing.to_dict()]
    return repr(thing)
