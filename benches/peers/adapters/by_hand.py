"""What one writes without a library: NumPy, factorised and in blocks that stay in the cache."""

import numpy as np
from works import Breeder, Contender, Mamdani, Sampling, Search, Tsk

BLOCK = 4096


def tsk(work: Tsk) -> list[Contender]:
    parameters = np.array([work.x, work.y])
    means, scales = parameters[..., 0], np.sqrt(0.5) / parameters[..., 1]
    table = work.constants

    def block(points):
        degrees = np.exp(-(((points[:, :, None] - means) * scales) ** 2))
        a, b = degrees[:, 0], degrees[:, 1]
        return ((a @ table) * b).sum(axis=1) / (a.sum(axis=1) * b.sum(axis=1))

    return [_contender(block, None)]


def mamdani(work: Mamdani) -> list[Contender]:
    x, y = _sides(work.x), _sides(work.y)
    sampling = Sampling.endpoints()
    positions = sampling.positions
    sets = _degrees(positions, _sides(work.z))
    rules = [[(i, j) for i, j, k in work.rules() if k == term] for term in range(len(work.z))]

    def block(points):
        a, b = _degrees(points[:, 0], x), _degrees(points[:, 1], y)
        union = np.zeros((len(points), len(positions)))
        for term, pairs in enumerate(rules):
            i, j = np.transpose(pairs)
            strength = np.minimum(a[:, i], b[:, j]).max(axis=1)
            np.maximum(union, np.minimum(strength[:, None], sets[:, term]), out=union)
        return union @ positions / union.sum(axis=1)

    return [_contender(block, sampling)]


def search(work: Search) -> Breeder:
    size = (work.population, work.genes)

    def run(generations):
        rng = np.random.default_rng(1)
        population = rng.uniform(-1, 1, size)
        errors = work.errors(population)
        for _ in range(generations):
            best = errors.argmin()
            entrants = rng.integers(work.population, size=(2, work.population, 2))
            winners = np.take_along_axis(entrants, errors[entrants].argmin(axis=2)[..., None], 2)
            a, b = population[winners[..., 0]]
            children = b + rng.uniform(-0.3, 1.3, size) * (a - b)
            strikes = rng.random(size) < 0.1
            children[strikes] += 0.2 * rng.standard_normal(strikes.sum())
            children[0] = population[best]
            population = children.clip(-1, 1)
            errors = work.errors(population)
        return population[errors.argmin()], errors.min()

    return Breeder("NumPy by hand", run)


def _sides(terms):
    """Return feet and slopes; a vertical side, an end of the universe, is put outside of it."""
    a, b, c, d = np.transpose(terms)
    a, d = np.where(a == b, b - 1, a), np.where(c == d, c + 1, d)
    return a, 1 / (b - a), d, 1 / (d - c)


def _degrees(values, sides):
    a, rise, d, fall = sides
    column = values[:, None]
    return np.clip(np.minimum((column - a) * rise, (d - column) * fall), 0, 1)


def _contender(block, sampling):
    def calls(points):
        return [block(np.array([point]))[0] for point in points]

    def batch(points):
        outputs = np.empty(len(points))
        for first in range(0, len(points), BLOCK):
            outputs[first : first + BLOCK] = block(points[first : first + BLOCK])
        return outputs

    return Contender("NumPy by hand", calls, batch, sampling)
