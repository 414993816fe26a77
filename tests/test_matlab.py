"""Numbers that MATLAB's documentation prints."""

from __future__ import annotations

import numpy as np

import fuzzyrs as fz


def test_tips_are_those_of_evalfis():
    """evalfis(readfis('tipper'), [2 1; 4 5; 7 8]), with its 101 samples from end to end."""
    service = {
        name: fz.gaussian(5 * i, 1.5) for i, name in enumerate(["poor", "good", "excellent"])
    }
    food = {"rancid": fz.trapezoidal(0, 0, 1, 3), "delicious": fz.trapezoidal(7, 9, 10, 10)}
    tip = {
        "cheap": fz.triangular(0, 5, 10),
        "average": fz.triangular(10, 15, 20),
        "generous": fz.triangular(20, 25, 30),
    }
    rules = """
        if service is poor or food is rancid then tip is cheap
        if service is good then tip is average
        if service is excellent or food is delicious then tip is generous
    """
    inputs = [fz.Variable("service", (0, 10), service), fz.Variable("food", (0, 10), food)]
    tipper = fz.System(inputs, fz.Variable("tip", (0, 30), tip), rules)
    tips = tipper([[2, 1], [4, 5], [7, 8]])
    np.testing.assert_array_equal(np.round(tips, 4), [7.0169, 14.4585, 20.3414])
