"""A genetic search with a fitness written in Python."""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

import numpy as np
from tqdm import tqdm

from fuzzyrs._fuzzyrs import Genetic
from fuzzyrs.errors import from_kind

__all__ = ["minimise"]


def minimise(
    search: Genetic,
    function: Callable[[Any], Any],
    generations: int = 100,
    *,
    vectorised: bool = False,
    target: float | None = None,
    stagnation: int | None = None,
    progress: bool | Callable[[int], object] = False,
) -> Genetic:
    """Run a genetic search with a fitness function of your own.

    After Ctrl-C, or if the function raises, the search has what it was told so far, its best
    individual too; another call goes on from there.

    Parameters
    ----------
    search : Genetic
        The search, new or well on its way.
    function : callable
        Takes an individual, an array of shape (genes,), and returns its fitness; smaller is better.
        With constraints it returns a pair: the fitness and how far they are violated, 0 if not.
    generations : int, optional
        How many more to run at most.
    vectorised : bool, optional
        The function takes the whole population, an array of shape (population, genes), and returns
        the fitness of all (and their violations).
    target : float, optional
        Stop when the best fitness is this or smaller.
    stagnation : int, optional
        Stop when the best has not changed for so many generations.
    progress : bool or callable, optional
        Show a bar, or call this with the number of generations done.

    Returns
    -------
    Genetic
        The search.

    Examples
    --------
    >>> import fuzzyrs as fz
    >>> search = fz.Genetic([(-5, 5)] * 3, seed=1)
    >>> fz.minimise(search, lambda x: ((x - 1) ** 2).sum(), 200, target=1e-4).best[0].round(1)
    array([1., 1., 1.])
    """
    generations = operator.index(generations)
    if generations < 1:
        raise from_kind("out_of_range", f"generations must be at least 1, got {generations}")
    search.is_done(target=target, stagnation=stagnation)  # refuses what does not fit
    with tqdm(total=generations, unit="generation", disable=progress is not True) as bar:
        for done in range(1, generations + 1):
            search.tell(*_fitness(function, search.ask(), vectorised))
            bar.update()
            if search.best is not None:
                bar.set_postfix(best=f"{search.best[1]:.6g}", refresh=False)
            if callable(progress):
                progress(done)
            if search.is_done(target=target, stagnation=stagnation):
                break
    return search


def _fitness(function: Callable[[Any], Any], population: Any, vectorised: bool) -> tuple[Any, ...]:
    """Return the arguments of `tell`: the fitness, and the violations if there are any."""
    if vectorised:
        told = function(population)
        return told if isinstance(told, tuple) else (told,)
    told = [function(individual) for individual in population]
    if any(isinstance(each, tuple) for each in told):
        fitness, violation = np.array(told, dtype=float).T
        return np.ascontiguousarray(fitness), np.ascontiguousarray(violation)
    return (told,)
