"""The works that the libraries do, and what they come to by the equations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

POINTS = list[tuple[float, float]]


@dataclass(frozen=True)
class Tsk:
    """Inputs x and y on (0, 1), a Gaussian grid of rules, product, constants, weighted average."""

    name: str
    x: tuple[tuple[float, float], ...]
    """Mean and sigma of each term."""
    y: tuple[tuple[float, float], ...]
    constants: np.ndarray
    batch: int = 1_000_000

    def rules(self) -> list[tuple[int, int, float]]:
        """Return the term of x, the term of y and the constant of each rule."""
        return [(i, j, float(c)) for (i, j), c in np.ndenumerate(self.constants)]


@dataclass(frozen=True)
class Mamdani:
    """Inputs x and y on (0, 10), z on (0, 100), trapezoids; min, min, max and the centroid."""

    name: str
    x: tuple[tuple[float, ...], ...]
    """The vertices of each term."""
    y: tuple[tuple[float, ...], ...]
    z: tuple[tuple[float, ...], ...]
    table: np.ndarray
    """The term of z for each pair of terms."""
    batch: int = 100_000

    def rules(self) -> list[tuple[int, int, int]]:
        """Return the terms of x, y and z of each rule."""
        return [(i, j, int(k)) for (i, j), k in np.ndenumerate(self.table)]


Work = Tsk | Mamdani


@dataclass(frozen=True)
class Search:
    """A genetic search for the means and constants of 25 TSK rules that fit samples best."""

    name: str
    points: np.ndarray
    """Of x and y on (-1, 1)."""
    targets: np.ndarray
    sigma: float
    """The width of every Gaussian, which stays as it is."""
    population: int = 200
    means: int = 5
    """Terms of each input."""

    @property
    def genes(self) -> int:
        """All of them on (-1, 1): the means of x, those of y, the constants."""
        return 2 * self.means + self.means**2

    def errors(self, population: np.ndarray) -> np.ndarray:
        """Return the mean squared error of each row of genes, for all rows at once."""
        rows = len(population)
        means = population[:, : 2 * self.means].reshape(rows, 2, 1, self.means)
        table = population[:, 2 * self.means :].reshape(rows, self.means, self.means)
        degrees = gaussian(self.points.T[None, :, :, None], means, self.sigma)
        a, b = degrees[:, 0], degrees[:, 1]
        outputs = ((a @ table) * b).sum(axis=2) / (a.sum(axis=2) * b.sum(axis=2))
        return ((outputs - self.targets) ** 2).mean(axis=1)


@dataclass(frozen=True)
class Breeder:
    """A library's genetic algorithm at work."""

    name: str
    run: Callable[[int], tuple[np.ndarray, float]]
    """Run so many generations, return the best genes found and their error."""


@dataclass(frozen=True)
class Sampling:
    """Where the output's set is looked at, and what each sample weighs in the centroid."""

    name: str
    positions: np.ndarray = field(repr=False)
    weights: np.ndarray = field(repr=False)
    tolerance: float = 1e-9

    @classmethod
    def endpoints(cls, samples: int = 101) -> Sampling:
        """Both ends are samples, all weigh the same: MATLAB's."""
        return cls(f"{samples} end points", np.linspace(0, 100, samples), np.ones(samples))

    @classmethod
    def midpoints(cls, samples: int = 100) -> Sampling:
        """The middles of equal parts: fuzzylite's."""
        positions = (np.arange(samples) + 0.5) * (100 / samples)
        return cls(f"{samples} midpoints", positions, np.ones(samples))

    @classmethod
    def trapezoids(cls, samples: int = 101) -> Sampling:
        """The trapezoidal rule, in which the ends weigh half."""
        weights = np.ones(samples)
        weights[[0, -1]] = 0.5
        return cls(f"{samples} end points, trapezoidal rule", np.linspace(0, 100, samples), weights)

    @classmethod
    def exact(cls, tolerance: float = 1e-6, remark: str = "the exact set") -> Sampling:
        """Look so closely that the area is the exact one within the tolerance."""
        fine = cls.midpoints(100_000)
        return cls(remark, fine.positions, fine.weights, tolerance)


@dataclass(frozen=True)
class Contender:
    """A library's form of a work."""

    name: str
    calls: Callable[[POINTS], list[float]] | None
    """One call after the other, as a control loop would."""
    batch: Callable[[np.ndarray], np.ndarray] | None
    """All rows of an (n, 2) array."""
    sampling: Sampling | None = None
    """How it takes the centroid, if it does."""


@dataclass(frozen=True)
class Training:
    """ANFIS: five Gaussians for each of x and y, 25 linear rules; all samples in each epoch."""

    name: str
    points: np.ndarray = field(repr=False)
    targets: np.ndarray = field(repr=False)
    means: tuple[float, ...] = (0.0, 0.25, 0.5, 0.75, 1.0)
    sigma: float = 0.11
    ridge: float = 1e-6
    rate: float = 0.01


@dataclass(frozen=True)
class Trainer:
    """A library's form of a training."""

    name: str
    train: Callable[[int], np.ndarray]
    """Train for so many epochs, and give the outputs at the samples."""


def gaussian(x: np.ndarray, mean: float, sigma: float) -> np.ndarray:
    """Return exp(-((x - mean) / sigma)² / 2)."""
    return np.exp(-0.5 * ((x - mean) / sigma) ** 2)


def trapezoid(x: np.ndarray, a: float, b: float, c: float, d: float) -> np.ndarray:
    """Return the degree of x; a vertical side belongs to the trapezoid."""
    rising = (x - a) / (b - a) if a < b else np.where(x < a, 0.0, 1.0)
    falling = (d - x) / (d - c) if c < d else np.where(x > d, 0.0, 1.0)
    return np.clip(np.minimum(rising, falling), 0.0, 1.0)


def reference(work: Work, points: np.ndarray, sampling: Sampling | None) -> np.ndarray:
    """Evaluate the work rule by rule, point by point."""
    if isinstance(work, Tsk):
        return np.array([_tsk(work, x, y) for x, y in points])
    sets = [trapezoid(sampling.positions, *vertices) for vertices in work.z]
    return np.array([_mamdani(work, x, y, sets, sampling) for x, y in points])


def _tsk(work, x, y):
    strengths = [gaussian(x, *work.x[i]) * gaussian(y, *work.y[j]) for i, j, _ in work.rules()]
    return np.dot(strengths, work.constants.ravel()) / np.sum(strengths)


def _mamdani(work, x, y, sets, sampling):
    union = np.zeros_like(sampling.positions)
    for i, j, k in work.rules():
        strength = min(trapezoid(x, *work.x[i]), trapezoid(y, *work.y[j]))
        union = np.maximum(union, np.minimum(strength, sets[k]))
    weighted = sampling.weights * union
    return weighted @ sampling.positions / weighted.sum()


def _tsk_work(rules: int, means: tuple[float, ...], sigma: float) -> Tsk:
    terms = tuple((mean, sigma) for mean in means)
    other = tuple((1 - mean, 1.1 * sigma) for mean in reversed(means))
    constants = np.round(np.sin(np.arange(rules)), 3).reshape(len(means), -1)
    return Tsk(f"TSK, {rules} rules", terms, other, constants)


def _partition(ends: float) -> tuple[tuple[float, ...], ...]:
    """Return five trapezoids whose degrees add up to one, their tops a tenth of the universe."""
    tops = [(0.0, 0.1), (0.22, 0.32), (0.45, 0.55), (0.68, 0.78), (0.9, 1.0)]
    feet = [0.0, *(end for _, end in tops[:-1])], [*(start for start, _ in tops[1:]), 1.0]
    vertices = zip(feet[0], tops, feet[1], strict=True)
    return tuple(tuple(round(v * ends, 9) for v in (a, *bc, d)) for a, bc, d in vertices)


WORKS: tuple[Work, ...] = (
    _tsk_work(9, (0.0, 0.45, 1.0), 0.25),
    _tsk_work(25, (0.0, 0.22, 0.5, 0.75, 1.0), 0.13),
    Mamdani(
        "Mamdani, 25 rules",
        _partition(10),
        _partition(10),
        _partition(100),
        np.add.outer(np.arange(5), np.arange(5)) // 2,
    ),
)


def training(samples: int = 1000) -> Training:
    """Draw samples of sin(3x)·cos(5y)."""
    points = np.random.default_rng(2).uniform(0, 1, (samples, 2))
    targets = np.sin(3 * points[:, 0]) * np.cos(5 * points[:, 1])
    return Training(f"ANFIS, 25 linear rules, {samples} samples", points, targets)


def _search() -> Search:
    points = np.random.default_rng(2).uniform(-1, 1, (200, 2))
    return Search("GA of 200 x 35, TSK error at 200 points", points, points.prod(axis=1), 0.3)


SEARCH = _search()


def draw(work: Work, count: int) -> np.ndarray:
    """Draw points of the inputs' universes."""
    ends = 1.0 if isinstance(work, Tsk) else 10.0
    return np.random.default_rng(1).uniform(0, ends, (count, 2))
