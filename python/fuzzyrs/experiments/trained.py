"""What several tables and figures show is learned once."""

from __future__ import annotations

import json
import time
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import Future
from threading import Lock
from typing import Any, TypeVar, overload

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

T = TypeVar("T")

#: So many results are kept: 100 seeds of all techniques, some tens of megabytes.
MOST_KEPT = 10_000

_kept: OrderedDict[str, Future[Any]] = OrderedDict()
_lock = Lock()


@overload
def train(
    game: OneOnOne, settings: Any, seed: int, control: Control, *, evader: Any = None
) -> tuple[Trained, float]: ...
@overload
def train(
    game: TwoPursuers,
    settings: Any,
    seed: int,
    control: Control,
    *,
    begun: TwoPursuersTrained | None = None,
) -> tuple[TwoPursuersTrained, float]: ...
@overload
def train(
    game: WallFollowing, settings: Any, seed: int, control: Control, *, expert: Any = None
) -> tuple[WallTrained, float]: ...
def train(
    game: Any, settings: Any, seed: int, control: Control, **others: Any
) -> tuple[Any, float]:
    """Let a technique learn, or return what it learned before with the same seed.

    Parameters
    ----------
    game, settings, seed, control, evader, expert, begun
        As for `fuzzyrs.train`.

    Returns
    -------
    trained : Trained, TwoPursuersTrained or WallTrained
    seconds : float
        How long it took.
    """
    began = time.perf_counter()

    def learn() -> tuple[Any, float]:
        trained = native.train(game, settings, seed=seed, control=control, **others)
        return trained, time.perf_counter() - began

    # What was begun makes no difference to what is learned.
    players = {name: _plain(other) for name, other in others.items() if name != "begun"}
    return once([_plain(game), _plain(settings), players, seed], learn)


def once(what: Any, work: Callable[[], T]) -> T:
    """Do some work, or return what came of it before.

    Parameters
    ----------
    what : JSON values
        What tells this work from all others.
    work : callable
        What is to be done. A thread that wants what another is just doing waits for it.
    """
    key = json.dumps(what)
    while True:
        with _lock:
            known = _kept.get(key)
            if known is None:
                mine = _kept[key] = Future()
                break
            _kept.move_to_end(key)
        if known.exception() is None:
            done: T = known.result()
            return done
        # Whoever began it failed or was stopped, which need not be so again.
    try:
        mine.set_result(done := work())
    except BaseException as error:
        with _lock:
            del _kept[key]
        mine.set_exception(error)
        raise
    with _lock:
        while len(_kept) > MOST_KEPT and next(iter(_kept.values())).done():
            _kept.popitem(last=False)
    return done


def _plain(thing: Any) -> Any:
    """Return what tells a game, settings or a player from all others."""
    if hasattr(thing, "to_dict"):
        return [type(thing).__name__, thing.to_dict()]
    return repr(thing)
