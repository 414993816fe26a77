"""pyfuzzylite: rules as text, NumPy inside, midpoints."""

import fuzzylite as fl
import numpy as np
from works import Contender, Mamdani, Sampling, Tsk


def tsk(work: Tsk) -> list[Contender]:
    constants = [fl.Constant(f"c{i}{j}", constant) for i, j, constant in work.rules()]
    output = fl.OutputVariable(
        "z", minimum=-1, maximum=1, defuzzifier=fl.WeightedAverage("TakagiSugeno"), terms=constants
    )
    inputs = [
        _input(name, 1, [fl.Gaussian(f"t{i}", *term) for i, term in enumerate(terms)])
        for name, terms in (("x", work.x), ("y", work.y))
    ]
    texts = [f"if x is t{i} and y is t{j} then z is c{i}{j}" for i, j, _ in work.rules()]
    return [_contender(inputs, output, fl.AlgebraicProduct(), texts, None)]


def mamdani(work: Mamdani) -> list[Contender]:
    output = fl.OutputVariable(
        "z",
        minimum=0,
        maximum=100,
        aggregation=fl.Maximum(),
        defuzzifier=fl.Centroid(100),
        terms=_trapezoids(work.z),
    )
    inputs = [
        _input(name, 10, _trapezoids(terms)) for name, terms in (("x", work.x), ("y", work.y))
    ]
    texts = [f"if x is t{i} and y is t{j} then z is t{k}" for i, j, k in work.rules()]
    return [_contender(inputs, output, fl.Minimum(), texts, Sampling.midpoints())]


def _trapezoids(terms):
    return [fl.Trapezoid(f"t{i}", *term) for i, term in enumerate(terms)]


def _input(name, high, terms):
    return fl.InputVariable(name, minimum=0, maximum=high, terms=terms)


def _contender(inputs, output, conjunction, texts, sampling):
    block = fl.RuleBlock(
        conjunction=conjunction,
        implication=fl.Minimum() if sampling else None,
        activation=fl.General(),
        rules=[fl.Rule.create(text) for text in texts],
    )
    engine = fl.Engine(
        "work", input_variables=inputs, output_variables=[output], rule_blocks=[block]
    )
    x, y = inputs

    def call(first, second):
        x.value, y.value = first, second
        engine.process()
        return output.value.item()

    def calls(points):
        return [call(first, second) for first, second in points]

    def batch(points):
        # Its samples of the output's set for all rows at once would not fit into the memory.
        return np.concatenate([rows(points[i : i + 4096]) for i in range(0, len(points), 4096)])

    def rows(points):
        engine.input_values = points
        engine.process()
        return output.value

    return Contender("pyfuzzylite", calls, batch, sampling)
