"""The verdicts of experiments, and the rows that they judge."""

from __future__ import annotations

import json

import pytest

from fuzzyrs.experiments import Result, Row
from fuzzyrs.experiments.chapter6 import (
    judge_exact,
    judge_learning_time,
    judge_near,
    judge_q_lambda,
    median_seed,
)

COLUMNS = ["a", "b", "c", "d"]
CLASSICAL = [9.6, 10.4, 4.5, 8.5]


def row(per_seed, published=CLASSICAL):
    return Row("row", COLUMNS[: len(published)], list(published), per_seed)


def test_statistics_count_what_is_missing_as_infinite():
    values = row([[1.0, 4.0, None], [3.0, None, None], [2.0, 6.0, None], [9.0, 5.0, 1.0]], [0] * 3)
    assert values.median == [2.5, 5.5, None]
    assert values.low == [1.0, 4.0, 1.0]
    assert values.high == [9.0, None, None]
    assert values.mean == [3.75, 5.0, 1.0]
    assert [values.missing(i) for i in range(3)] == [0, 1, 3]


def test_medians_of_decimal_fractions_stay_decimal():
    assert row([[0.1], [0.2]], [None]).median == [0.15]
    assert row([[9.6], [9.7], [9.8]], [None]).median == [9.7]


def test_a_row_without_any_value_has_none():
    empty = row([[None], [None]], [1.0])
    assert (empty.median, empty.low, empty.high, empty.mean) == ([None],) * 4


def test_rows_without_chance_must_be_equal():
    assert judge_exact(row([CLASSICAL] * 3)).verdict == "reproduced"
    assert judge_exact(row([CLASSICAL, [9.7, 10.4, 4.5, 8.5]])).verdict == "differs"
    assert judge_exact(row([[None, 10.4, 4.5, 8.5]])).verdict == "differs"


INSIDE = [13.0, 14.0, 7.0, 12.0]


@pytest.mark.parametrize(
    ("per_seed", "published", "verdict"),
    [
        ([INSIDE] * 50, INSIDE, "reproduced"),
        ([INSIDE] * 50, [12.6, 14.0, 7.0, 12.0], "close"),  # the print is outside our range
        ([[11.0, 14.0, 7.0, 12.0], [11.9, 14.0, 7.0, 12.0]], [11.5, 14.0, 7.0, 12.0], "close"),
        ([[10.0, 14.0, 7.0, 12.0]] * 50, INSIDE, "differs"),
        ([INSIDE] * 98 + [[None, *INSIDE[1:]]] * 2, INSIDE, "reproduced"),
        ([INSIDE] * 96 + [[None, *INSIDE[1:]]] * 4, INSIDE, "close"),  # too many escapes
        ([[None] * 4] * 3, INSIDE, "differs"),
    ],
)
def test_q_lambda_is_judged_by_its_means(per_seed, published, verdict):
    judged = judge_q_lambda(row(per_seed, published))
    assert judged.verdict == verdict
    assert judged.per_seed == per_seed
    assert "escapes of" in judged.reason


NEAR = [9.7, 10.5, 4.5, 8.6]


@pytest.mark.parametrize(
    ("per_seed", "published", "verdict"),
    [
        ([NEAR] * 20, [9.7, 10.5, 4.5, None], "reproduced"),
        ([NEAR] * 19 + [[12.0, 10.5, 4.5, 8.6]], NEAR, "reproduced"),  # 19 of 20 are 95 %
        ([NEAR] * 18 + [[12.0, 10.5, 4.5, 8.6]] * 2, NEAR, "close"),
        ([NEAR] * 19 + [[None, 10.5, 4.5, 8.6]], NEAR, "reproduced"),
        ([NEAR] * 20, [9.8, 10.5, 4.5, None], "close"),
        ([[10.0, 10.7, 4.8, 8.9]] * 20, [10.0, 10.7, 4.8, 8.9], "reproduced"),  # just 0.3 s off
        ([[10.1, 10.7, 4.8, 8.9]] * 20, NEAR, "differs"),
        ([[None] * 4] * 20, NEAR, "differs"),
    ],
)
def test_techniques_near_the_classical_one_are_judged_by_seeds_and_medians(
    per_seed, published, verdict
):
    medians = (9.7, 10.4, 4.5, 8.6)
    judged = judge_near(row(per_seed, published), CLASSICAL, margin=2.0, medians=medians)
    assert judged.verdict == verdict, judged.reason


def test_without_a_classical_time_nothing_is_near():
    judged = judge_near(row([NEAR]), [None] * 4, margin=2.0, medians=NEAR)
    assert "0 of 1 seeds" in judged.reason


def test_learning_times_are_judged_by_their_ratio():
    def verdict(ours, printed=(32.0, 460.8, 47.8)):
        return judge_learning_time(row([list(ours)], printed)).verdict

    assert verdict([1.0, 1000.0, 104.0]) == "reproduced"
    assert verdict([1.0, 1000.0, 113.0]) == "reproduced"
    assert verdict([1.0, 1000.0, 120.0]) == "differs"
    assert verdict([1.0, 1000.0, 68.0]) == "differs"
    assert verdict([1.0, None, 68.0]) == "differs"
    assert verdict([1.0, 0.0, 0.0]) == "differs"


def test_the_seed_in_the_middle_is_drawn():
    assert median_seed([[1, 9], [2, 2], [None, 3], [5, 1]]) == 3
    assert median_seed([[None]]) == 0


def test_the_json_layout_is_what_other_tools_read():
    result = Result("id", [7], {"a": 1}, [row([[1.0, 2.0, None, 4.5]])], {"seconds": 2.5})
    text = result.to_json()
    document = json.loads(text)
    assert list(document) == ["id", "version", "seeds", "config", "rows", "run"]
    assert document["rows"] == [
        {
            "name": "row",
            "columns": COLUMNS,
            "published": CLASSICAL,
            "median": [1.0, 2.0, None, 4.5],
            "low": [1.0, 2.0, None, 4.5],
            "high": [1.0, 2.0, None, 4.5],
            "per_seed": [[1.0, 2.0, None, 4.5]],
            "verdict": "",
        }
    ]
    assert text.endswith("}\n")


def test_numbers_that_json_does_not_have_are_refused():
    with pytest.raises(ValueError, match="not JSON compliant"):
        Result("id", [0], {"limit": float("inf")}, [], {}).to_json()
