"""Studies: a function over a grid of parameters and seeds, with every finished run on disk."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from fuzzyrs.studies.backends import backend_of
from fuzzyrs.studies.definition import define, name_of, require_own_name
from fuzzyrs.studies.running import StudyInterrupted, run_study
from fuzzyrs.studies.store import Run, Store
from fuzzyrs.studies.table import StudyResults
from fuzzyrs.studies.work import FunctionWork

__all__ = ["Run", "StudyInterrupted", "StudyResults", "open_study", "study"]


def study(
    function: Callable[..., Any],
    grid: Mapping[str, Iterable[Any]],
    *,
    seeds: int | Iterable[int] = 20,
    database: str | Path,
    name: str | None = None,
    backend: str = "threads",
    workers: int = 0,
    record_errors: bool = False,
    progress: bool | Callable[[int, int], object] = False,
) -> StudyResults:
    """Run a function at every point of a grid with every seed.

    Each run is in the database as soon as it is finished. A study that was stopped, by Ctrl-C, an
    exception, `kill -9` or the loss of power, goes on when it is called again: no finished run is
    lost, and none is done twice. Grid and seeds may grow from call to call.

    Parameters
    ----------
    function : callable
        Called as ``function(seed=..., **point)``; returns a number, or a dictionary of numbers,
        texts, True, False or None by name. If it takes a `control`, it gets a Control that is
        cancelled on Ctrl-C; pass it on to what runs long.
    grid : dict
        The values of each parameter.
    seeds : int or iterable of int, optional
        So many from 0 on, or those given; the same at every point, so that points can be compared
        seed by seed.
    database : path
        An SQLite file; it may hold several studies.
    name : str, optional
        What the study is called in the database; by default the function's name. If the function
        changes, so should the name: runs of both would be mixed. Others may share the name of a
        lambda, of a function within another, of an object's method, and of a partial function with
        other arguments than numbers and texts; their studies must be given one.
    backend : {"threads", "processes", "ray"}, optional
        Where the runs are worked on. Threads are right for what fuzzyrs does; processes for
        functions that spend their time in Python, which must stand in a module; a Ray cluster
        (``pip install 'fuzzyrs[ray]'``) for what one machine can't do.
    workers : int, optional
        How many runs at a time; 0 for one on each core.
    record_errors : bool, optional
        Keep an exception as the outcome of its run and go on. Otherwise the first one ends the
        study and is raised; what was finished is kept. Failed runs are tried again in a next call.
    progress : bool or callable, optional
        Show a bar, or call this with the numbers of finished and of all runs.

    Returns
    -------
    StudyResults
        The runs of this grid and these seeds.

    Raises
    ------
    StudyInterrupted
        On Ctrl-C; its `results` are what was finished.
    FileError, FormatError
        If the database cannot be used.
    InvalidValueError
        If the study needs a name, or was defined otherwise before.

    Examples
    --------
    >>> import fuzzyrs as fz
    >>> def learn(seed, episodes):
    ...     trained = fz.train(fz.OneOnOne(), fz.QLambdaTraining(episodes=episodes), seed=seed)
    ...     return {"learning time": trained.learning_time}
    >>> results = fz.study(learn, {"episodes": [5, 10]}, seeds=3, database="learning.db")
    >>> results.columns()["episodes"]
    array([ 5,  5,  5, 10, 10, 10])
    """
    function_name = name_of(function)
    if name is None:
        require_own_name(function)
    return run_study(
        define(function_name if name is None else name, function_name, grid, seeds),
        FunctionWork(function, record_errors),
        Path(database),
        backend=backend_of(backend, workers),
        progress=progress,
    )


def open_study(database: str | Path, name: str | None = None) -> StudyResults:
    """Return all finished runs of a study: parameters by name, points and seeds in rising order.

    Parameters
    ----------
    database : path
        The study's database.
    name : str, optional
        The study; needed if the database holds several.

    Returns
    -------
    StudyResults
    """
    with Store(Path(database), name, None) as store:
        runs = store.runs()
        runs.sort(key=lambda run: ([_order(value) for value in run.point.values()], run.seed))
        parameters = list(runs[0].point) if runs else []
        return StudyResults(store.name, store.path, parameters, runs)


def _order(value: Any) -> tuple[bool, float, str]:
    """Return what sorts numbers by their size, and all else behind them by its text."""
    number = isinstance(value, (int, float))
    return not number, float(value) if number else 0.0, repr(value)
