"""Rule systems in plain Python, from the definitions of the literature: slow, obvious, independent.

Norms: Klement, Mesiar, Pap, Triangular Norms (2000). Hedges: Zadeh (1972), Negnevitsky (2005).
Inference: Mamdani and Assilian (1975), Takagi and Sugeno (1985), Tsukamoto (1979). Maxima, the
bisector and samples follow MATLAB's `defuzz`; weights follow its `evalfis`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import reduce
from itertools import pairwise
from typing import Any

import numpy as np

import oracle

T_NORMS: dict[str, Callable[[float, float], float]] = {
    "min": min,
    "product": lambda a, b: a * b,
    "lukasiewicz": lambda a, b: max(0.0, a + b - 1),
    "drastic": lambda a, b: b if a == 1 else a if b == 1 else 0.0,
    "einstein": lambda a, b: a * b / (1 + (1 - a) * (1 - b)),
    "hamacher": lambda a, b: a * b / (a + b - a * b) if a + b > 0 else 0.0,
    "nilpotent": lambda a, b: min(a, b) if a + b > 1 else 0.0,
}
S_NORMS: dict[str, Callable[[float, float], float]] = {
    "max": max,
    "probabilistic_sum": lambda a, b: a + b - a * b,
    "lukasiewicz": lambda a, b: min(1.0, a + b),
    "drastic": lambda a, b: b if a == 0 else a if b == 0 else 1.0,
    "einstein": lambda a, b: (a + b) / (1 + a * b),
    "hamacher": lambda a, b: (a + b - 2 * a * b) / (1 - a * b) if a * b < 1 else 1.0,
    "nilpotent": lambda a, b: max(a, b) if a + b < 1 else 1.0,
}
AGGREGATIONS = {**S_NORMS, "sum": lambda a, b: a + b}
HEDGES: dict[str, Callable[[float], float]] = {
    "not": lambda x: 1 - x,
    "very": lambda x: x**2,
    "extremely": lambda x: x**3,
    "plus": lambda x: x**1.25,
    "minus": lambda x: x**0.75,
    "slightly": lambda x: x**1.7,
    "somewhat": math.sqrt,
    "more_or_less": math.sqrt,
    "indeed": lambda x: 2 * x**2 if x <= 0.5 else 1 - 2 * (1 - x) ** 2,
    "seldom": lambda x: math.sqrt(x / 2) if x <= 0.5 else 1 - math.sqrt((1 - x) / 2),
    "any": lambda _: 1.0,
}
SHAPES = {
    **oracle.SHAPES,
    "ramp": lambda x, start, end: min(max((x - start) / (end - start), 0.0), 1.0),
    "sigmoid": lambda x, centre, slope: 1 / (1 + math.exp(min(slope * (centre - x), 700))),
}

Function = tuple[str, Sequence[float]]
"""A shape and its parameters."""
Formula = tuple[str, Callable[..., float]]
"""A text and what it means, as a function of the inputs."""
Tree = tuple[Any, ...]
"""("is", variable, hedges, term), ("and" or "or", operands) or ("hedge", name, operand)."""


@dataclass
class Variable:
    name: str
    universe: tuple[float, float]
    terms: dict[str, Function]


@dataclass
class Mamdani:
    variable: Variable
    implication: str = "min"
    aggregation: str = "max"
    defuzzifier: str = "centroid"
    sampling: str = "endpoints"
    samples: int = 101
    no_rule_fires: str | float = "error"

    @property
    def name(self) -> str:
        return self.variable.name


@dataclass
class Sugeno:
    name: str
    terms: dict[str, float | list[float] | Formula]
    aggregation: str = "sum"
    defuzzifier: str = "weighted_average"
    no_rule_fires: str | float = "error"


@dataclass
class Tsukamoto:
    variable: Variable
    defuzzifier: str = "weighted_average"
    no_rule_fires: str | float = "error"

    @property
    def name(self) -> str:
        return self.variable.name


@dataclass
class Conclusion:
    output: str
    term: str | Formula
    hedges: list[str] = field(default_factory=list)


@dataclass
class Rule:
    when: Tree
    then: list[Conclusion]
    weight: float = 1.0


@dataclass
class System:
    inputs: list[Variable]
    outputs: list[Mamdani | Sugeno | Tsukamoto]
    rules: list[Rule]
    conjunction: str = "min"
    disjunction: str = "max"
    hedges: dict[str, Formula] = field(default_factory=dict)
    outside: str = "keep"


class NoRuleFiresError(Exception):
    """An output is undefined and nothing else is wanted."""


class OutsideError(Exception):
    """An input lies outside its universe."""


class UndefinedError(Exception):
    """A rule concludes a number that there is not."""


class Evaluation:
    """A system at work. `noise` multiplies every degree between 0 and 1 by 1 + up to 1e-13.

    Where that moves the outputs far, a jump is so near that rounding decides: both sides are right.
    """

    def __init__(self, system: System, noise: np.random.Generator | None = None) -> None:
        self.system = system
        self.noise = noise
        own = {name: meaning for name, (_, meaning) in system.hedges.items()}
        self.hedges = {**HEDGES, **own}
        self.silent = False
        self.weakest_in_exact = 1.0
        """The weakest strength that an exact centroid was taken of."""

    def batch(self, points: Sequence[Sequence[float]], before: Sequence[float]) -> np.ndarray:
        """Give each row's outputs; `before` is what they were before the first."""
        inputs = self.system.inputs
        admitted = [[self.admitted(*pair) for pair in zip(inputs, x, strict=True)] for x in points]
        rows = []
        for x in admitted:
            before = self.outputs(x, before)
            rows.append(before)
        if self.silent:
            raise NoRuleFiresError
        return np.array(rows)

    def outputs(self, x: Sequence[float], before: Sequence[float]) -> list[float]:
        strengths = [rule.weight * self.truth(rule.when, x) for rule in self.system.rules]
        outputs = []
        for output, last in zip(self.system.outputs, before, strict=True):
            value = self.output(output, strengths, x)
            outputs.append(self.choice(output.no_rule_fires, last) if value is None else value)
        return outputs

    def choice(self, no_rule_fires: str | float, last: float) -> float:
        if not isinstance(no_rule_fires, str):
            return no_rule_fires
        kept = no_rule_fires == "previous" and not math.isnan(last)
        self.silent |= not kept and no_rule_fires != "nan"
        return last if kept else math.nan

    def admitted(self, variable: Variable, x: float) -> float:
        low, high = variable.universe
        if self.system.outside == "error" and not low <= x <= high:
            raise OutsideError(variable.name)
        return min(max(x, low), high) if self.system.outside == "clamp" else x

    def degree(self, function: Function, x: float) -> float:
        shape, parameters = function
        return self.shaken(float(SHAPES[shape](x, *parameters)))

    def shaken(self, degree: float) -> float:
        degree = min(max(degree, 0.0), 1.0)  # a norm may be above 1 by rounding
        if self.noise is None or degree in (0, 1):
            return degree
        return min(1.0, degree * (1 + 1e-13 * self.noise.uniform(-1, 1)))

    def hedged(self, hedges: Sequence[str], degree: float) -> float:
        """What the words make of a degree; the last acts first."""
        return reduce(lambda degree, name: self.hedges[name](degree), reversed(hedges), degree)

    def truth(self, tree: Tree, x: Sequence[float]) -> float:
        if tree[0] == "is":
            _, name, hedges, term = tree
            inputs = self.system.inputs
            place = next(i for i, variable in enumerate(inputs) if variable.name == name)
            return self.hedged(hedges, self.degree(inputs[place].terms[term], x[place]))
        if tree[0] == "hedge":
            return self.shaken(self.hedges[tree[1]](self.truth(tree[2], x)))
        join = {
            "and": T_NORMS[self.system.conjunction],
            "or": S_NORMS[self.system.disjunction],
        }[tree[0]]
        degrees = [self.truth(operand, x) for operand in tree[1]]
        return reduce(lambda a, b: self.shaken(join(a, b)), degrees)

    def output(self, output, strengths: Sequence[float], x: Sequence[float]) -> float | None:
        fired = [
            (strength, conclusion)
            for rule, strength in zip(self.system.rules, strengths, strict=True)
            for conclusion in rule.then
            if conclusion.output == output.name and strength > 0
        ]
        if not fired:
            return None
        if isinstance(output, Sugeno):
            return self.sugeno(output, fired, x)
        terms = output.variable.terms
        if isinstance(output, Tsukamoto):
            return weighed(output, [(w, place_of(terms[c.term], w)) for w, c in fired])
        if output.defuzzifier == "height":
            return average([(w, centre(terms[c.term], output.variable)) for w, c in fired])
        if output.sampling == "exact":
            self.weakest_in_exact = min(self.weakest_in_exact, *(w for w, _ in fired))
            return exact_centroid(output, [(w, terms[c.term]) for w, c in fired])
        return self.sampled(output, fired)

    def sugeno(self, output: Sugeno, fired, x: Sequence[float]) -> float:
        """Weighted numbers; without "sum" the rules of one term count as one."""
        strengths: dict[Any, float] = {}
        for index, (strength, conclusion) in enumerate(fired):
            # A formula in a rule is a term of its own.
            alone = output.aggregation == "sum" or not isinstance(conclusion.term, str)
            term = (conclusion.term, index if alone else None)
            joined = AGGREGATIONS[output.aggregation](strengths.get(term, 0.0), strength)
            strengths[term] = joined
        return weighed(output, [(w, number(output, t, x)) for (t, _), w in strengths.items()])

    def sampled(self, output: Mamdani, fired) -> float | None:
        imply = T_NORMS[output.implication]
        join = AGGREGATIONS[output.aggregation]
        terms = output.variable.terms
        samples = sample(output)
        degrees = []
        for y in samples:
            shaped = [
                imply(w, self.hedged(c.hedges, self.degree(terms[c.term], y))) for w, c in fired
            ]
            degrees.append(reduce(join, shaped))
        if self.noise is not None and output.defuzzifier == "bisector":
            # Equal degrees on both sides of a sample are a tie, too.
            degrees = [degree * (1 + 1e-13 * self.noise.uniform(-1, 1)) for degree in degrees]
        if max(degrees) == 0:  # as if no rule fired
            return None
        return DEFUZZIFIERS[output.defuzzifier](samples, np.array(degrees))


# Numbers


def average(weighted: Sequence[tuple[float, float]]) -> float:
    return sum(w * z for w, z in weighted) / sum(w for w, _ in weighted)


def weighed(output, weighted: Sequence[tuple[float, float]]) -> float:
    if output.defuzzifier == "weighted_sum":
        return sum(w * z for w, z in weighted)
    return average(weighted)


def number(output: Sugeno, term: str | Formula, x: Sequence[float]) -> float:
    value = output.terms[term] if isinstance(term, str) else term
    if isinstance(value, tuple):
        return value[1](*x)
    return float(np.dot(value[:-1], x) + value[-1]) if isinstance(value, list) else value


def place_of(function: Function, degree: float) -> float:
    """Find the number of this degree by halving an interval that a monotone function crosses."""
    if function[0] == "sigmoid" and degree == 1:
        raise UndefinedError("a sigmoid doesn't get there")
    low, high = -1e3, 1e3
    rises = SHAPES[function[0]](high, *function[1]) > 0.5
    for _ in range(80):
        middle = (low + high) / 2
        if (SHAPES[function[0]](middle, *function[1]) < degree) == rises:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def centre(function: Function, variable: Variable) -> float:
    """Find the middle of the numbers of the universe with the greatest degree."""
    shape, parameters = function
    core = {
        "gaussian": parameters[:1],
        "gaussian_width": parameters[:1],
        "triangular": parameters[1:2],
        "trapezoidal": parameters[1:3],
    }[shape]
    return float(np.mean(np.clip(core, *variable.universe)))


# Sets


def sample(output: Mamdani) -> np.ndarray:
    low, high = output.variable.universe
    if output.sampling == "endpoints":
        return np.linspace(low, high, output.samples)
    width = (high - low) / output.samples
    return low + width * (np.arange(output.samples) + 0.5)


def bisector(samples: np.ndarray, degrees: np.ndarray) -> float:
    return samples[np.argmax(np.cumsum(degrees) >= np.sum(degrees) / 2)]


DEFUZZIFIERS: dict[str, Callable[[np.ndarray, np.ndarray], float]] = {
    "centroid": lambda y, degrees: np.dot(y, degrees) / np.sum(degrees),
    "bisector": bisector,
    "mean_of_maximum": lambda y, degrees: np.mean(y[degrees == degrees.max()]),
    "smallest_of_maximum": lambda y, degrees: y[degrees == degrees.max()].min(),
    "largest_of_maximum": lambda y, degrees: y[degrees == degrees.max()].max(),
}


def exact_centroid(output: Mamdani, fired: Sequence[tuple[float, Function]]) -> float | None:
    """Integrate the union of clipped or scaled trapezoids: two Gauss points on each straight piece.

    The nodes lie inside the pieces, so that jumps at their ends do no harm.
    """
    low, high = output.variable.universe
    sets = [trapezoid(output.implication, w, function) for w, function in fired]
    corners = sorted({low, high, *(y for _, ys in sets for y in ys if low < y < high)})
    area = moment = 0.0
    for left, right in pairwise(corners):
        if right - left < 1e-12:
            continue  # a corner twice, but for rounding
        lines = [straight(shape, left, right) for shape, _ in sets]
        meetings = [meeting(f, g) for f in lines for g in lines]
        inside = sorted(y for y in meetings if y is not None and left < y < right)
        ends = [left, *inside, right]
        for start, end in pairwise(ends):
            for node in (-1 / math.sqrt(3), 1 / math.sqrt(3)):
                y = (start + end + node * (end - start)) / 2
                degree = max(height + slope * (y - left) for slope, height, _ in lines)
                area += degree * (end - start) / 2
                moment += y * degree * (end - start) / 2
    return moment / area if area > 0 else None


def trapezoid(implication: str, w: float, function: Function):
    """Give a clipped or scaled trapezoid as a function, and the places of its corners."""
    shape, parameters = function
    a, b, c, d = parameters if shape == "trapezoidal" else [*parameters[:2], *parameters[1:]]
    if implication == "product":
        return lambda y: w * oracle.trapezoidal(y, a, b, c, d), [a, b, c, d]
    corners = [a, a + w * (b - a), d - w * (d - c), d]
    return lambda y: min(w, oracle.trapezoidal(y, a, b, c, d)), corners


def straight(shape: Callable[[float], float], left: float, right: float):
    """Give slope, height at `left` and `left` of what is straight between two places."""
    y0, y1 = left + (right - left) / 4, left + 3 * (right - left) / 4
    slope = (shape(y1) - shape(y0)) / (y1 - y0)
    return slope, shape(y0) - slope * (y0 - left), left


def meeting(f, g) -> float | None:
    if f[0] == g[0]:
        return None
    return f[2] + (g[1] - f[1]) / (f[0] - g[0])
