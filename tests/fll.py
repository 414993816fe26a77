"""A small reader of fuzzylite's language, for comparing systems that are written in it.

It knows what the examples of pyfuzzylite use; what it does not know is a KeyError or fails an
assertion, so that nothing is read as something else.
"""

from __future__ import annotations

import math
import operator
import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import fuzzyrs as fz

T_NORMS = {
    "Minimum": "min",
    "AlgebraicProduct": "product",
    "BoundedDifference": "lukasiewicz",
    "DrasticProduct": "drastic",
    "EinsteinProduct": "einstein",
    "HamacherProduct": "hamacher",
    "NilpotentMinimum": "nilpotent",
}
S_NORMS = {
    "Maximum": "max",
    "AlgebraicSum": "probabilistic_sum",
    "BoundedSum": "lukasiewicz",
    "DrasticSum": "drastic",
    "EinsteinSum": "einstein",
    "HamacherSum": "hamacher",
    "NilpotentMaximum": "nilpotent",
    "UnboundedSum": "sum",
}
DEFUZZIFIERS = {
    "Centroid": "centroid",
    "Bisector": "bisector",
    "MeanOfMaximum": "mean_of_maximum",
    "SmallestOfMaximum": "smallest_of_maximum",
    "LargestOfMaximum": "largest_of_maximum",
    "WeightedAverage": "weighted_average",
    "WeightedSum": "weighted_sum",
}
HEDGES = {"extremely": "indeed"}
"""Where a word means something else in fuzzyrs: that of fuzzylite intensifies the contrast."""

SAMPLES = 1000
"""Midpoints of an output's universe, if the defuzzifier names no other number."""

SHAPES = {
    "Arc": fz.arc,
    "Bell": fz.bell,
    "Binary": lambda at, direction: fz.step(at, math.copysign(1, direction)),
    "Concave": fz.concave,
    "Cosine": fz.cosine,
    "Discrete": lambda *xy: fz.points(list(zip(xy[::2], xy[1::2], strict=True))),
    "Gaussian": fz.gaussian,
    "GaussianProduct": fz.two_sided_gaussian,
    "PiShape": fz.pi_shape,
    "Ramp": fz.ramp,
    "Rectangle": fz.rectangle,
    "SShape": fz.s_shape,
    "SemiEllipse": fz.semi_ellipse,
    "Sigmoid": fz.sigmoid,
    "SigmoidDifference": lambda left, rise, fall, right: fz.sigmoid_difference(
        left, rise, right, fall
    ),
    "SigmoidProduct": lambda left, rise, fall, right: fz.sigmoid_product(left, rise, right, fall),
    "Spike": fz.spike,
    "Trapezoid": fz.trapezoidal,
    "Triangle": fz.triangular,
    "ZShape": fz.z_shape,
}
CRISP = {"Constant", "Linear", "Function"}
COMPARISONS = {"lt": operator.lt, "gt": operator.gt, "eq": operator.eq}


@dataclass
class Section:
    """An engine, a variable or a block of rules: its lines by their keys."""

    kind: str
    name: str
    lines: dict[str, list[str]] = field(default_factory=lambda: defaultdict(list))

    def __getitem__(self, key: str) -> str:
        """Return the value of a line that occurs once."""
        (value,) = self.lines[key]
        return value

    @property
    def universe(self) -> tuple[float, float]:
        low, high = map(float, self["range"].split())
        return low, high

    def terms(self) -> dict[str, tuple[str, str]]:
        """Return each term's shape and parameters; of several of a name the last counts."""
        parts = [line.split(maxsplit=2) for line in self.lines["term"]]
        return {name: (shape, parameters) for name, shape, parameters in parts}


@dataclass(frozen=True)
class Rule:
    antecedent: str
    conclusions: tuple[tuple[str, tuple[str, ...], str], ...]
    """Output, hedges and term."""
    weight: str

    @classmethod
    def parse(cls, text: str) -> Rule:
        words = (HEDGES.get(word, word) for word in text.split())
        match = re.fullmatch(r"if (.+) then (.+?)( with .+)?", " ".join(words))
        conclusions, hedges = [], ()
        for part in match[2].split(" and "):
            output, verb, *own, term = part.split()
            assert verb == "is", text
            # In fuzzylite the hedges of a conclusion change the conclusions after it too.
            hedges = (*own, *hedges)
            conclusions.append((output, hedges, term))
        return cls(match[1], tuple(conclusions), match[3] or "")

    def texts(self, outputs: list[str]) -> Iterator[str]:
        """Yield what the rule says about these outputs.

        In fuzzylite a hedge of a conclusion changes the rule's strength.
        """
        for output, hedges, term in self.conclusions:
            if output in outputs:
                assert not (hedges and self.weight)
                antecedent = " ".join([*hedges, f"({self.antecedent})"])
                yield f"if {antecedent} then {output} is {term}{self.weight}"


class Engine:
    """What an engine of fuzzylite computes, by a system of fuzzyrs.

    `without` names outputs that are left out.
    """

    def __init__(self, text: str, without: frozenset[str] = frozenset()) -> None:
        parts = list(_sections(text))
        inputs = [part for part in parts if part.kind == "InputVariable"]
        outputs = [part for part in parts if part.kind == "OutputVariable"]
        self._blocks = [part for part in parts if part.kind == "RuleBlock"]
        assert all(part["enabled"] == "true" for part in [*inputs, *outputs, *self._blocks])
        assert all(block["activation"] == "General" for block in self._blocks)
        rules = [Rule.parse(text) for block in self._blocks for text in block.lines["rule"]]
        rules = _without_chains([_with_terms(rule, inputs) for rule in rules], outputs)
        self.inputs = [part.name for part in inputs]
        self.outputs = [part.name for part in outputs if part.name not in without]
        (locked,) = {part["lock-range"] for part in inputs}
        self.system = fz.System(
            [_variable(part) for part in inputs],
            [self._output(part) for part in outputs if part.name in self.outputs],
            [text for rule in rules for text in rule.texts(self.outputs)],
            outside={"true": "clamp", "false": "keep"}[locked],
            **self._norms(),
        )

    def _norms(self):
        norms = {}
        for key, names in {"conjunction": T_NORMS, "disjunction": S_NORMS}.items():
            chosen = {block[key] for block in self._blocks} - {"none"}
            assert len(chosen) <= 1, f"the blocks of rules differ in their {key}"
            norms.update((key, names[name]) for name in chosen)
        return norms

    def _output(self, part):
        defuzzifier, *parameters = part["defuzzifier"].split()
        aggregation = "sum" if part["aggregation"] == "none" else S_NORMS[part["aggregation"]]
        options = {"defuzzifier": DEFUZZIFIERS[defuzzifier], "no_rule_fires": _silence(part)}
        if defuzzifier.startswith("Weighted"):
            if {shape for shape, _ in part.terms().values()} <= CRISP:
                terms = {name: _crisp(*term) for name, term in part.terms().items()}
                return fz.Output.sugeno(part.name, terms, aggregation=aggregation, **options)
            return fz.Output.tsukamoto(_variable(part), **options)
        (implication,) = {block["implication"] for block in self._blocks} - {"none"}
        return fz.Output.mamdani(
            _variable(part),
            implication=T_NORMS[implication],
            aggregation=aggregation,
            sampling="midpoints",
            samples=int(parameters[0]) if parameters else SAMPLES,
            **options,
        )


def _sections(text: str) -> Iterator[Section]:
    part = None
    for line in filter(str.strip, text.splitlines()):
        key, _, value = line.partition(":")
        if line[0] != " ":
            if part:
                yield part
            part = Section(key, value.strip())
        else:
            part.lines[key.strip()].append(value.strip())
    yield part


def _variable(part: Section) -> fz.Variable:
    """Make a variable; an input that only conclusions use gets the one term that it has to have."""
    terms = {name: _function(*term, part.universe) for name, term in part.terms().items()}
    return fz.Variable(part.name, part.universe, terms or {"all": fz.rectangle(*part.universe)})


def _function(shape: str, parameters: str, universe: tuple[float, float]):
    if shape != "Function":
        return SHAPES[shape](*map(float, parameters.split()))

    def degree(x):
        # Where the formula is negative, any other degree is larger.
        return max(0.0, float(eval(parameters, COMPARISONS, {"x": x})))

    return fz.sampled(degree, universe)


def _crisp(shape: str, parameters: str):
    """Return a conclusion as Output.sugeno takes it."""
    if shape == "Function":
        return parameters
    numbers = [float(number) for number in parameters.split()]
    return numbers if shape == "Linear" else numbers[0]


def _silence(part: Section):
    """Return what an output is where no rule fires."""
    if part["lock-previous"] == "true":
        return "previous"
    return "nan" if part["default"] == "nan" else float(part["default"])


def _with_terms(rule: Rule, inputs: list[Section]) -> Rule:
    """Write `input is any` as `input is any term`."""
    antecedent = rule.antecedent
    for part in inputs:
        for term in [*part.terms()][:1]:
            antecedent = re.sub(rf"\b{part.name} is any$", rf"\g<0> {term}", antecedent)
    return replace(rule, antecedent=antecedent)


def _without_chains(rules: list[Rule], outputs: list[Section]) -> list[Rule]:
    """Replace outputs in antecedents by the antecedents that lead to them.

    fuzzylite takes `output is term` for the strength with which the rules conclude just that.
    """
    joined = {output.name: output["aggregation"] for output in outputs}
    reasons = defaultdict(list)
    done = []
    for rule in rules:
        antecedent = rule.antecedent
        for output, term in re.findall(r"(\w+) is (\w+)", antecedent):
            if output in joined:
                assert joined[output] == "Maximum", "only this is the same as `or`"
                reason = " or ".join(f"({each})" for each in reasons[output, term])
                antecedent = antecedent.replace(f"{output} is {term}", f"({reason})")
        done.append(replace(rule, antecedent=antecedent))
        for output, _, term in rule.conclusions:
            reasons[output, term].append(antecedent)
    return done
