"""The same mathematics in plain NumPy, written from the equations: slow, obvious, independent.

Numbers of equations are those of Desouky's thesis.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

# Membership functions of a single number. Parameters may be complex, for derivatives by the
# complex step; only their real parts decide on which side of a kink a point lies.


def gaussian(x, mean, sigma):
    return np.exp(-(((x - mean) / sigma) ** 2) / 2)


def gaussian_width(x, mean, width):
    return np.exp(-(((x - mean) / width) ** 2))


def two_sided_gaussian(x, left_mean, left_sigma, right_mean, right_sigma):
    left = gaussian(x, left_mean, left_sigma) if x < np.real(left_mean) else 1.0
    right = gaussian(x, right_mean, right_sigma) if x > np.real(right_mean) else 1.0
    return left * right


def bell(x, centre, width, slope):
    if x == np.real(centre):
        return 1.0
    distance = _absolute((x - centre) / width)
    return _logistic(-2 * slope * np.log(distance))


def sigmoid(x, centre, slope):
    return _logistic(slope * (x - centre))


def sigmoid_difference(x, left_centre, left_slope, right_centre, right_slope):
    return _absolute(sigmoid(x, left_centre, left_slope) - sigmoid(x, right_centre, right_slope))


def sigmoid_product(x, left_centre, left_slope, right_centre, right_slope):
    return sigmoid(x, left_centre, left_slope) * sigmoid(x, right_centre, right_slope)


def _absolute(number):
    return number if np.real(number) >= 0 else -number


def _logistic(z):
    """1/(1 + exp(-z)) without overflow."""
    return 1 / (1 + np.exp(-z)) if np.real(z) > 0 else np.exp(z) / (1 + np.exp(z))


def s_shape(x, a, b):
    middle = np.real(a + b) / 2
    if x >= np.real(b):
        return 1.0
    if x >= middle:
        return 1 - 2 * ((b - x) / (b - a)) ** 2
    if x >= np.real(a):
        return 2 * ((x - a) / (b - a)) ** 2
    return 0.0


def z_shape(x, a, b):
    return s_shape(-x, -b, -a)


def pi_shape(x, a, b, c, d):
    if np.real(b) <= x <= np.real(c):
        return 1.0
    return s_shape(x, a, b) if x < np.real(b) else z_shape(x, c, d)


def triangular(x, a, b, c):
    return trapezoidal(x, a, b, b, c)


def trapezoidal(x, a, b, c, d):
    if np.real(b) <= x <= np.real(c):
        return 1.0
    if np.real(a) <= x < np.real(b):
        return (x - a) / (b - a)
    if np.real(c) < x <= np.real(d):
        return (d - x) / (d - c)
    return 0.0


def ramp(x, start, end):
    share = (x - start) / (end - start)
    return min(max(share, 0.0, key=np.real), 1.0, key=np.real)


def rectangle(x, a, b):
    return 1.0 if np.real(a) <= x <= np.real(b) else 0.0


def singleton(x, place):
    return 1.0 if x == np.real(place) else 0.0


def step(x, at, direction):
    return 1.0 if (x - np.real(at)) * np.real(direction) >= 0 else 0.0


def concave(x, inflection, end):
    size, way = end - inflection, end - x
    return size / (size + way) if np.real(way / size) > 0 else 1.0


def cosine(x, centre, width):
    inside = abs(x - np.real(centre)) <= np.real(width) / 2
    return (1 + np.cos(2 * np.pi * (x - centre) / width)) / 2 if inside else 0.0


def semi_ellipse(x, a, b):
    """The height at x is the geometric mean of the two parts of the diameter."""
    inside = np.real(a) < x < np.real(b)
    return np.sqrt((x - a) * (b - x)) / ((b - a) / 2) if inside else 0.0


def arc(x, start, end):
    """The left half of the ellipse whose diameter begins at start and has its middle at end."""
    share = np.real((x - start) / (end - start))
    if not 0 < share < 1:
        return float(share >= 1)
    rest = (end - x) + (end - start)
    return np.sqrt((x - start) / (end - start) * rest / (end - start))


def spike(x, centre, width):
    return np.exp(-10 * _absolute((x - centre) / width))


def points(x, *numbers):
    places, degrees = numbers[::2], numbers[1::2]
    if x <= np.real(places[0]):
        return degrees[0]
    for index in range(1, len(places)):
        if x <= np.real(places[index]):
            (x0, x1), (y0, y1) = places[index - 1 : index + 1], degrees[index - 1 : index + 1]
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return degrees[-1]


SHAPES: dict[str, Callable[..., Any]] = {
    "gaussian": gaussian,
    "gaussian_width": gaussian_width,
    "two_sided_gaussian": two_sided_gaussian,
    "bell": bell,
    "sigmoid": sigmoid,
    "sigmoid_difference": sigmoid_difference,
    "sigmoid_product": sigmoid_product,
    "s_shape": s_shape,
    "z_shape": z_shape,
    "pi_shape": pi_shape,
    "triangular": triangular,
    "trapezoidal": trapezoidal,
    "ramp": ramp,
    "rectangle": rectangle,
    "singleton": singleton,
    "step": step,
    "concave": concave,
    "cosine": cosine,
    "semi_ellipse": semi_ellipse,
    "arc": arc,
    "spike": spike,
    "points": points,
}
# Points may be any number; in the systems of the tests they are three.
PARAMETERS = dict.fromkeys(SHAPES, 2) | {
    "two_sided_gaussian": 4,
    "bell": 3,
    "sigmoid_difference": 4,
    "sigmoid_product": 4,
    "pi_shape": 4,
    "triangular": 3,
    "trapezoidal": 4,
    "singleton": 1,
    "points": 6,
}


def tsk(shapes: Sequence[Sequence[str]], order: int, parameters: np.ndarray, x: Sequence[float]):
    """Weighted average (2.8) of a grid's rules, one after the other; NaN where none fires.

    `shapes` has the shapes of the terms of each input. `parameters` is the flat vector: the
    terms' parameters input by input, then the consequents, the last input's term changing
    fastest.
    """
    rest = list(parameters)
    degrees = []
    for value, terms in zip(x, shapes, strict=True):
        degrees.append([])
        for shape in terms:
            own, rest = rest[: PARAMETERS[shape]], rest[PARAMETERS[shape] :]
            degrees[-1].append(SHAPES[shape](value, *own))
    weighted = total = 0.0
    size = 1 if order == 0 else len(x) + 1
    for rule in itertools.product(*degrees):
        weight = np.prod(rule)
        own, rest = rest[:size], rest[size:]
        conclusion = own[0] if order == 0 else np.dot(own[:-1], x) + own[-1]
        weighted = weighted + weight * conclusion
        total = total + weight
    assert not rest
    return weighted / total if total != 0 else np.nan


def tsk_gradient(shapes, order, parameters, x) -> np.ndarray:
    """Derivatives of `tsk` to the parameters by the complex step, which has no rounding error.

    The step is large enough for its product with the weakest rule not to underflow.
    """
    step = 1e-100
    derivatives = []
    for index in range(len(parameters)):
        moved = np.array(parameters, dtype=complex)
        moved[index] += 1j * step
        derivatives.append(np.imag(tsk(shapes, order, moved, x)) / step)
    return np.array(derivatives)


# The game of section 6.5.2.


def wrap(angle: float) -> float:
    """Bring an angle into (-pi, pi]."""
    return -((np.pi - angle) % (2 * np.pi) - np.pi)


@dataclass(frozen=True)
class Car:
    """x' = V cos h, y' = V sin h, h' = (V/L) tan u with |u| <= u_max (6.1)."""

    speed: float
    wheelbase: float
    max_steering: float

    def move(self, pose: np.ndarray, steering: float, step: float) -> np.ndarray:
        """Turn first, then drive along the new heading."""
        x, y, heading = pose
        heading = heading + step * self.speed / self.wheelbase * np.tan(steering)
        way = step * self.speed
        return np.array([x + way * np.cos(heading), y + way * np.sin(heading), heading])


PURSUER = Car(2.0, 0.3, 0.5)
EVADER = Car(1.0, 0.3, 1.0)
RADIUS = 0.1
STEP = 0.1

Strategy = Callable[[float, float], float]


def classical(angle: float, rate: float) -> float:
    """Steer along the line of sight (6.3); the evader flees along the same line."""
    del rate
    return angle


@dataclass
class Path:
    pursuer: list[np.ndarray]
    evader: list[np.ndarray]
    steering: list[tuple[float, float]] = field(default_factory=list)
    captured: bool = False

    @property
    def distance(self) -> np.ndarray:
        between = np.array(self.evader)[:, :2] - np.array(self.pursuer)[:, :2]
        return np.hypot(between[:, 0], between[:, 1])


def play(
    start: tuple[float, ...],
    pursuer: Strategy = classical,
    evader: Strategy = classical,
    steps: int = 600,
) -> Path:
    """Play a game; a capture is tested at the samples, before the move."""
    path = Path([np.zeros(3)], [np.array([*start, 0.0][:3], dtype=float)])
    last: list[float] | None = None
    for _ in range(steps):
        p, e = path.pursuer[-1], path.evader[-1]
        if path.distance[-1] < RADIUS:
            break
        sight = np.arctan2(e[1] - p[1], e[0] - p[0])
        angles = [wrap(sight - p[2]), wrap(sight - e[2])]
        rates = [0.0, 0.0]
        if last is not None:
            rates = [wrap(now - then) / STEP for now, then in zip(angles, last, strict=True)]
        last = angles
        u_p = np.clip(pursuer(angles[0], rates[0]), -PURSUER.max_steering, PURSUER.max_steering)
        u_e = np.clip(evader(angles[1], rates[1]), -EVADER.max_steering, EVADER.max_steering)
        path.pursuer.append(PURSUER.move(p, u_p, STEP))
        path.evader.append(EVADER.move(e, u_e, STEP))
        path.steering.append((u_p, u_e))
    path.captured = bool(path.distance[-1] < RADIUS)
    return path


class QTable:
    """Q(λ) on a table by full sweeps (2.43-2.49)."""

    def __init__(self, states, actions, discount, trace_decay, *, trace, cut="never"):
        self.values = np.zeros((states, actions))
        self.traces = np.zeros((states, actions))
        self.discount, self.decay = discount, discount * trace_decay
        self.trace, self.cut = trace, cut

    def learn(self, state, action, reward, next_state, learning_rate) -> float:
        ahead = 0.0 if next_state is None else self.values[next_state].max()
        error = reward + self.discount * ahead - self.values[state, action]
        if self.cut == "watkins" and self.values[state, action] < self.values[state].max():
            self.traces[:] = 0.0
        self.traces *= self.decay
        if self.trace == "replacing_state":
            self.traces[state] = 0.0  # (2.47); without it (2.46)
        if self.trace == "accumulating":
            self.traces[state, action] += 1.0
        else:
            self.traces[state, action] = 1.0
        self.values += learning_rate * error * self.traces
        return error


class ModelBuilding:
    """Steps 4 to 9 of chapter 5 over whole tables; or with V from 0 and raised before its use."""

    def __init__(self, states, actions, first, *, discount, trace_decay, counts):
        self.literal = counts == "thesis"
        self.q = np.full((states, actions), first)
        self.e = np.full((states, actions), float(self.literal))
        self.v = np.full((states, actions), float(self.literal))
        self.r = np.zeros((states, actions))
        self.w = np.zeros((states, actions, states))
        self.discount, self.decay = discount, discount * trace_decay

    def learn(self, state, action, reward, next_state, learning_rate) -> None:
        pair = (state, action)
        self.v[pair] += not self.literal
        self.r[pair] += (reward - self.r[pair]) / self.v[pair]
        if next_state is not None:
            self.w[state, action, next_state] += 1
        p = self.w / np.maximum(self.v, 1)[:, :, None]
        self.v[pair] += self.literal
        self.e *= self.decay
        self.e[pair] = 1.0
        step = learning_rate * self.e
        target = self.r + self.discount * p @ self.q.max(axis=1)
        self.q = (1 - step) * self.q + step * target
