"""Random rule systems for hypothesis, and how they are built in fuzzyrs from text or objects."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from functools import cache, reduce
from typing import Any, TypeVar

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

import fuzzyrs as fz
from rule_oracle import (
    AGGREGATIONS,
    DEFUZZIFIERS,
    HEDGES,
    S_NORMS,
    T_NORMS,
    Conclusion,
    Evaluation,
    Formula,
    Function,
    Mamdani,
    NoRuleFiresError,
    OutsideError,
    Rule,
    Sugeno,
    System,
    Tree,
    Tsukamoto,
    UndefinedError,
    Variable,
)

T = TypeVar("T")
FUNCTIONS = ("gaussian", "gaussian_width", "triangular", "trapezoidal")
KINDS = ("is", "and", "or", "hedge")
WEIGHTINGS = ("weighted_average", "weighted_sum")
NO_RULE_FIRES = ("error", "nan", "previous", 0.75)
# The weakest strength under which an exact centroid is compared; one test expects to fail below.
WEAK = 1e-6
UNIVERSES = ((-2.0, 2.0), (-1.0, 3.0), (0.0, 1.0), (-0.5, 0.07))
OWN_HEDGES: dict[str, Formula] = {
    "rather": ("x^1.5", lambda x: x**1.5),
    "half": ("if(x > 0.5, 0.5, x)", lambda x: min(x, 0.5)),
    # One's own hedge goes before the built-in one of its name.
    "indeed": ("sin(pi*x/2)^2", lambda x: math.sin(math.pi * x / 2) ** 2),
}
# Of one input; the first four are linear.
FORMULAS: list[Formula] = [
    ("-1.5", lambda *_: -1.5),
    ("2*x - 0.5", lambda x, *_: 2 * x - 0.5),
    ("-(x + 3)/4 + x", lambda x, *_: -(x + 3) / 4 + x),
    ("x*2*pi + e^2", lambda x, *_: x * 2 * math.pi + math.e**2),
    ("-x^2 + abs(x)", lambda x, *_: -(x**2) + abs(x)),
    ("if(x > 0, sin(x), cos(x)) * 3", lambda x, *_: (math.sin(x) if x > 0 else math.cos(x)) * 3),
    ("min(1, x, 0.25) - max(x, 0)/2", lambda x, *_: min(1, x, 0.25) - max(x, 0) / 2),
    ("exp(-x^2/2) <= 0.5", lambda x, *_: float(math.exp(-(x**2) / 2) <= 0.5)),
]


@cache
def below(count: int) -> st.SearchStrategy[int]:
    return st.integers(0, count - 1)


@cache
def hundredths(low: float, high: float) -> st.SearchStrategy[float]:
    return st.integers(round(100 * low), round(100 * high)).map(lambda n: n / 100)


class Draw:
    """What hypothesis draws, from few strategies: making new ones is what takes it long."""

    def __init__(self, draw: Callable[..., Any]) -> None:
        self.draw = draw

    def pick(self, options: Iterable[T]) -> T:
        options = tuple(options)
        return options[self.draw(below(len(options)))]

    def some(self, least: int, most: int, make: Callable[[], T]) -> list[T]:
        return [make() for _ in range(self.pick(range(least, most + 1)))]

    def number(self, low: float, high: float) -> float:
        """Draw hundredths, so that corners and ties are met."""
        return self.draw(hundredths(low, high))

    def function(self, shapes: Sequence[str] = FUNCTIONS) -> Function:
        shape, middle = self.pick(shapes), self.number(-2, 2)
        if shape.startswith("gaussian"):
            return shape, [middle, self.number(0.3, 2)]
        left, right = self.number(0, 2), self.number(0.2, 2)
        core = [middle] if shape == "triangular" else [middle, middle + self.number(0, 1)]
        return shape, [middle - left, *core, core[-1] + right]

    def monotone_function(self) -> Function:
        middle, sign = self.number(-1, 1), self.pick([-1, 1])
        if self.pick(["sigmoid", "ramp"]) == "sigmoid":
            return "sigmoid", [middle, sign * self.number(0.5, 5)]
        return "ramp", [middle, middle + sign * self.number(0.2, 3)]

    def variable(self, name: str, function: Callable[[], Function]) -> Variable:
        return Variable(name, self.pick(UNIVERSES), named(self.some(1, 3, function)))

    def tree(self, inputs: Sequence[Variable], hedges: Sequence[str], depth: int, kinds=KINDS):
        """Draw an antecedent whose chains are no operands of chains of their kind."""
        kind = self.pick(kinds) if depth else "is"
        if kind == "is":
            variable = self.pick(inputs)
            words = self.some(0, 2, lambda: self.pick(hedges))
            return "is", variable.name, words, self.pick(variable.terms)
        if kind == "hedge":
            return "hedge", self.pick(hedges), self.tree(inputs, hedges, depth - 1)
        others = [other for other in KINDS if other != kind]
        return kind, self.some(2, 3, lambda: self.tree(inputs, hedges, depth - 1, others))

    def mamdani(self, name: str) -> Mamdani:
        return Mamdani(
            self.variable(name, self.function),
            self.pick(T_NORMS),
            self.pick(AGGREGATIONS),
            self.pick([*DEFUZZIFIERS, "height"]),
            self.pick(["endpoints", "midpoints"]),
            self.pick(range(2, 40)),
            self.pick(NO_RULE_FIRES),
        )

    def exact_mamdani(self, name: str) -> Mamdani:
        variable = self.variable(name, lambda: self.function(["triangular", "trapezoidal"]))
        implication = self.pick(["min", "product"])
        answer = self.pick(NO_RULE_FIRES)
        return Mamdani(variable, implication, sampling="exact", no_rule_fires=answer)

    def sugeno(self, name: str, inputs: int) -> Sugeno:
        def value():
            constant = self.number(-3, 3)
            coefficients = self.some(inputs, inputs, lambda: self.number(-3, 3))
            return self.pick([constant, [*coefficients, constant], self.pick(FORMULAS)])

        return Sugeno(
            name,
            named(self.some(1, 3, value)),
            self.pick(AGGREGATIONS),
            self.pick(WEIGHTINGS),
            self.pick(NO_RULE_FIRES),
        )

    def tsukamoto(self, name: str) -> Tsukamoto:
        variable = self.variable(name, self.monotone_function)
        return Tsukamoto(variable, self.pick(WEIGHTINGS), self.pick(NO_RULE_FIRES))

    def output(self, name: str, inputs: int) -> Mamdani | Sugeno | Tsukamoto:
        kind = self.pick(["mamdani", "exact_mamdani", "tsukamoto", "sugeno"])
        return self.sugeno(name, inputs) if kind == "sugeno" else getattr(self, kind)(name)

    def conclusion(self, output, hedges: Sequence[str]) -> Conclusion:
        if isinstance(output, Sugeno) and self.pick([False, True]):
            return Conclusion(output.name, self.pick(FORMULAS))
        term = self.pick(output.terms if isinstance(output, Sugeno) else output.variable.terms)
        sampled = isinstance(output, Mamdani) and output.sampling != "exact"
        if not sampled or output.defuzzifier == "height":
            return Conclusion(output.name, term)
        return Conclusion(output.name, term, self.some(0, 2, lambda: self.pick(hedges)))

    def rule(self, inputs, outputs, hedges: Sequence[str]) -> Rule:
        then = [self.conclusion(output, hedges) for output in outputs]
        return Rule(self.tree(inputs, hedges, 3), then, self.pick([1.0, 0.5, 0.73, 0.0]))


def named(values: Sequence[T]) -> dict[str, T]:
    return dict(zip(["low", "middle", "high"], values, strict=False))


@st.composite
def systems(draw, without: Sequence[str] = ()) -> System:
    """Draw a system of up to three inputs and outputs of any kind, without some hedges."""
    here = Draw(draw)
    inputs = [here.variable(name, here.function) for name in "xyz"[: here.pick([1, 2, 3])]]
    outputs = [here.output(name, len(inputs)) for name in "uvw"[: here.pick([1, 2, 3])]]
    own = [name for name in OWN_HEDGES if here.pick([False, True])]
    hedges = sorted({*HEDGES, *own}.difference(without))
    # The first rule concludes about each output, since each needs a rule; the others about one.
    rules = [here.rule(inputs, outputs, hedges)]
    rules += here.some(0, 4, lambda: here.rule(inputs, [here.pick(outputs)], hedges))
    return System(
        inputs,
        outputs,
        rules,
        here.pick(T_NORMS),
        here.pick(S_NORMS),
        {name: OWN_HEDGES[name] for name in own},
        here.pick(["keep", "clamp", "error"]),
    )


@st.composite
def points(draw, system: System) -> list[list[float]]:
    """Draw up to nine points, which fill more than eight lanes; some outside the universe."""
    here = Draw(draw)
    beyond = 0.5 if system.outside != "error" else 0.01
    ranges = [(low - beyond, high + beyond) for low, high in (v.universe for v in system.inputs)]
    return here.some(1, 9, lambda: [here.number(*ends) for ends in ranges])


# What is right


def outcome(model, points, before, noise=None):
    """Give the outputs of the oracle, or the exception that fits, or None."""
    evaluation = Evaluation(model, noise)
    try:
        outputs = evaluation.batch(points, before)
    except UndefinedError:
        return None
    except NoRuleFiresError:
        return fz.errors.NoRuleFiresError
    except OutsideError:
        return fz.errors.InvalidValueError
    return outputs if evaluation.weakest_in_exact > WEAK else None


def expected(model, points, before):
    """Give the outcome, unless rounding decides it: jumps are too near, or nothing is defined."""
    right = outcome(model, points, before)
    assume(right is not None)
    for seed in range(2):
        shaken = outcome(model, points, before, np.random.default_rng(seed))
        if isinstance(right, np.ndarray) and isinstance(shaken, np.ndarray):
            assume(np.allclose(shaken, right, rtol=1e-10, atol=1e-10, equal_nan=True))
        else:
            assume(shaken is right)
    return right


# Text


def text(tree: Tree, wrap: Callable[[str], str] = lambda part: part) -> str:
    """Write an antecedent; `wrap` may put parts into parentheses that they don't need."""
    if tree[0] == "is":
        _, variable, hedges, term = tree
        return wrap(f"{variable} is {' '.join([*hedges, term])}")
    if tree[0] == "hedge":
        _, hedge, operand = tree
        part = text(operand, wrap)
        return wrap(f"{hedge} ({part})" if operand[0] in ("and", "or") else f"{hedge} {part}")
    kind, operands = tree
    parts = [text(operand, wrap) for operand in operands]
    if kind == "and":
        pairs = zip(operands, parts, strict=True)
        parts = [f"({part})" if operand[0] == "or" else part for operand, part in pairs]
    return wrap(f" {kind} ".join(parts))


def rule_text(rule: Rule, wrap: Callable[[str], str] = lambda part: part) -> str:
    said = []
    for conclusion in rule.then:
        if isinstance(conclusion.term, str):
            said.append(f"{conclusion.output} is {' '.join([*conclusion.hedges, conclusion.term])}")
        else:
            said.append(f"{conclusion.output} = {conclusion.term[0]}")
    weight = "" if rule.weight == 1 else f" with {rule.weight}"
    return f"if {text(rule.when, wrap)} then {' and '.join(said)}{weight}"


# Objects


def variable(model: Variable) -> fz.Variable:
    terms = {
        name: fz.MembershipFunction(shape, parameters)
        for name, (shape, parameters) in model.terms.items()
    }
    return fz.Variable(model.name, model.universe, terms)


def output(model: Mamdani | Sugeno | Tsukamoto) -> fz.Output:
    if isinstance(model, Sugeno):
        terms = {n: v[0] if isinstance(v, tuple) else v for n, v in model.terms.items()}
        return fz.Output.sugeno(
            model.name,
            terms,
            aggregation=model.aggregation,
            defuzzifier=model.defuzzifier,
            no_rule_fires=model.no_rule_fires,
        )
    if isinstance(model, Tsukamoto):
        return fz.Output.tsukamoto(
            variable(model.variable),
            defuzzifier=model.defuzzifier,
            no_rule_fires=model.no_rule_fires,
        )
    return fz.Output.mamdani(
        variable(model.variable),
        implication=model.implication,
        aggregation=model.aggregation,
        defuzzifier=model.defuzzifier,
        sampling=model.sampling,
        samples=model.samples,
        no_rule_fires=model.no_rule_fires,
    )


def proposition(tree: Tree, inputs: dict[str, fz.Variable]) -> fz.Proposition:
    if tree[0] == "is":
        _, name, hedges, term = tree
        return reduce(fz.Proposition.hedge, reversed(hedges), inputs[name][term])
    if tree[0] == "hedge":
        of = proposition(tree[2], inputs)
        return ~of if tree[1] == "not" else of.hedge(tree[1])
    operands = [proposition(operand, inputs) for operand in tree[1]]
    join = fz.Proposition.__and__ if tree[0] == "and" else fz.Proposition.__or__
    return reduce(join, operands)


def rule_object(rule: Rule, inputs: dict[str, fz.Variable], outputs: dict[str, fz.Output]):
    """Make a rule by operators."""
    said = []
    for conclusion in rule.then:
        named = outputs[conclusion.output][conclusion.term]
        said.append(reduce(fz.Proposition.hedge, reversed(conclusion.hedges), named))
    return (proposition(rule.when, inputs) >> said).weighted(rule.weight)


def build(model: System, rules: str | Sequence[str | fz.Rule] | None = None) -> fz.System:
    """Build the system, from text unless there are other rules."""
    return fz.System(
        [variable(one) for one in model.inputs],
        [output(one) for one in model.outputs],
        "\n".join(map(rule_text, model.rules)) if rules is None else rules,
        conjunction=model.conjunction,
        disjunction=model.disjunction,
        hedges={name: formula for name, (formula, _) in model.hedges.items()},
        outside=model.outside,
    )
