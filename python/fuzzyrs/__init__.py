"""Fuzzy controllers that learn.

Build a system from variables and rules, evaluate it, let a learner tune it, play games with it:

>>> import fuzzyrs as fz
>>> angle = fz.Variable.evenly("angle", (-1, 1), "NZP")
>>> rate = fz.Variable.evenly("rate", (-1, 1), "NZP")
>>> steer = fz.TSK([angle, rate], [[-0.5, -0.25, 0], [-0.25, 0, 0.25], [0, 0.25, 0.5]])
>>> game = fz.OneOnOne()
>>> game.play(steer, evader_start=(2, 4))
<Trajectory: captured after 5.0 s, nearest 0.059 m>
"""

from __future__ import annotations

# The processor is checked first: the core would crash on one that is too old.
from fuzzyrs import _cpu, errors, plot
from fuzzyrs._fuzzyrs import (
    TSK,
    Control,
    Discretiser,
    Explanation,
    Finding,
    FuzzyController,
    GeneRanges,
    Genetic,
    GeneticPhase,
    MembershipFunction,
    OneOnOne,
    Outcomes,
    Output,
    Proposition,
    QLambda,
    QLambdaTraining,
    QlbgflcTraining,
    RewardGaTraining,
    Rule,
    System,
    TableController,
    Trained,
    Trajectory,
    Variable,
    Vehicle,
    __version__,
    arc,
    bell,
    concave,
    cosine,
    fit_genetic,
    gaussian,
    gaussian_width,
    load,
    pi_shape,
    points,
    ramp,
    rectangle,
    rule_table,
    s_shape,
    semi_ellipse,
    sigmoid,
    sigmoid_difference,
    sigmoid_product,
    singleton,
    spike,
    step,
    train,
    trapezoidal,
    triangular,
    two_sided_gaussian,
    z_shape,
)
from fuzzyrs._sampled import sampled
from fuzzyrs.errors import FuzzyrsError

del _cpu

__all__ = [
    "TSK",
    "Control",
    "Discretiser",
    "Explanation",
    "Finding",
    "FuzzyController",
    "FuzzyrsError",
    "GeneRanges",
    "Genetic",
    "GeneticPhase",
    "MembershipFunction",
    "OneOnOne",
    "Outcomes",
    "Output",
    "Proposition",
    "QLambda",
    "QLambdaTraining",
    "QlbgflcTraining",
    "RewardGaTraining",
    "Rule",
    "System",
    "TableController",
    "Trained",
    "Trajectory",
    "Variable",
    "Vehicle",
    "__version__",
    "arc",
    "bell",
    "concave",
    "cosine",
    "errors",
    "fit_genetic",
    "gaussian",
    "gaussian_width",
    "load",
    "pi_shape",
    "plot",
    "points",
    "ramp",
    "rectangle",
    "rule_table",
    "s_shape",
    "sampled",
    "semi_ellipse",
    "sigmoid",
    "sigmoid_difference",
    "sigmoid_product",
    "singleton",
    "spike",
    "step",
    "train",
    "trapezoidal",
    "triangular",
    "two_sided_gaussian",
    "z_shape",
]
