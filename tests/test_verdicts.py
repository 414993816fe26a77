"""The verdicts of experiments, and the rows that they judge."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
import scipy.stats

from fuzzyrs.experiments import Result, Row
from fuzzyrs.experiments.experiment import median_seed
from fuzzyrs.experiments.result import total
from fuzzyrs.experiments.statistics import (
    at_most,
    interquartile_mean,
    interquartile_mean_interval,
    mean_interval,
    median_interval,
    paired,
    share_interval,
)
from fuzzyrs.experiments.verdict import (
    judge_exact,
    judge_mean_within,
    judge_means,
    judge_near,
    judge_ratio,
    judge_smaller,
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


BANDS = [(11.5, 16.0), (12.0, 16.5), (5.5, 10.0), (10.0, 15.0)]
INSIDE = [13.0, 14.0, 7.0, 12.0]


@pytest.mark.parametrize(
    ("per_seed", "published", "verdict"),
    [
        ([INSIDE] * 50, INSIDE, "reproduced"),
        ([INSIDE] * 50, [12.6, 14.0, 7.0, 12.0], "close"),  # the print is outside our range
        ([[10.0, 14.0, 7.0, 12.0]] * 50, INSIDE, "differs"),
        ([INSIDE] * 99 + [[None, *INSIDE[1:]]], INSIDE, "reproduced"),
        # Seven escapes of a hundred are more than a share of 3 % gives in one of twenty samples.
        ([INSIDE] * 93 + [[None, *INSIDE[1:]]] * 7, INSIDE, "close"),
        ([[None] * 4] * 20, INSIDE, "differs"),
        ([INSIDE] * 9, INSIDE, "can't be checked"),
    ],
)
def test_a_band_for_the_means_is_judged_with_chance_in_mind(per_seed, published, verdict):
    judged = judge_means(row(per_seed, published), BANDS, missing=0.03)
    assert judged.verdict == verdict, judged.reason
    assert judged.per_seed == per_seed


NEAR = [9.7, 10.5, 4.5, 8.6]
FAR = [12.0, 10.5, 4.5, 8.6]
SLOW = [20.0] * 4


@pytest.mark.parametrize(
    ("per_seed", "published", "verdict"),
    [
        ([NEAR] * 20, [9.7, 10.5, 4.5, None], "reproduced"),
        # Where 95 % of the seeds are near, 17 of 20 happen by chance, 16 seldom.
        ([NEAR] * 17 + [FAR] * 3, NEAR, "reproduced"),
        ([NEAR] * 16 + [FAR] * 4, NEAR, "close"),
        ([NEAR] * 16 + [[None, 10.5, 4.5, 8.6]] * 4, NEAR, "close"),
        ([NEAR] * 20, [9.8, 10.5, 4.5, None], "close"),
        ([[9.9, 10.6, 4.7, 8.8]] * 20, [9.9, 10.6, 4.7, 8.8], "reproduced"),  # just 0.2 s off
        ([[10.0, 10.6, 4.7, 8.8]] * 20, NEAR, "differs"),
        ([[None] * 4] * 20, NEAR, "differs"),
        ([NEAR] * 9, NEAR, "can't be checked"),
    ],
)
def test_what_should_be_near_is_judged_by_seeds_and_medians(per_seed, published, verdict):
    count = len(per_seed)
    judged = judge_near(
        row(per_seed, published),
        row([CLASSICAL] * count),
        margin=2.0,
        medians=(9.7, 10.4, 4.5, 8.6),
        within=0.2,
        better=(row([SLOW] * count), 0.9),
    )
    assert judged.verdict == verdict, judged.reason


def test_what_should_beat_another_row_must_do_so_on_most_seeds():
    def verdict(slower):
        other = row([SLOW] * (20 - slower) + [[0.0] * 4] * slower)
        near = {"margin": 2.0, "medians": NEAR, "within": 0.2}
        return judge_near(
            row([NEAR] * 20, NEAR), row([CLASSICAL] * 20), better=(other, 0.9), **near
        ).verdict

    assert [verdict(0), verdict(4), verdict(5)] == ["reproduced", "reproduced", "close"]


def test_learning_times_are_judged_by_their_ratio():
    def verdict(ours, printed=(32.0, 460.8, 30.0), count=20):
        names = ["q_lambda", "reward_ga", "qlbgflc"]
        times = Row("row", names, list(printed), [list(ours)] * count)
        return judge_ratio(times, "qlbgflc", "reward_ga", (0.05, 0.09), because="").verdict

    assert verdict([1.0, 1000.0, 68.0]) == "reproduced"
    assert verdict([1.0, 1000.0, 120.0]) == "differs"
    assert verdict([1.0, 1000.0, 68.0], printed=(32.0, 460.8, 47.8)) == "differs"
    assert verdict([1.0, None, 68.0]) == "can't be checked"
    assert verdict([1.0, 0.0, 0.0]) == "can't be checked"
    assert verdict([1.0, 1000.0, 68.0], count=9) == "can't be checked"


def test_probabilities_are_those_of_the_binomial_distribution():
    assert at_most(0, 1, 0.25) == pytest.approx(0.75)
    assert at_most(1, 3, 0.5) == pytest.approx(0.5)
    assert at_most(20, 20, 0.95) == pytest.approx(1.0)
    # Sums of large binomial coefficients overflowed.
    assert at_most(50_000, 100_000, 0.5) == pytest.approx(0.5, abs=0.01)


def test_intervals_of_means_and_medians():
    assert mean_interval([1.0, 3.0]) == pytest.approx((0.0, 4.0))
    assert mean_interval([1.0]) == (-math.inf, math.inf)
    # The 6th and the 15th of 20 values enclose the median with 95.9 %, the 7th and 14th with 88 %.
    assert median_interval(range(1, 21)) == (6, 15)
    assert median_interval([1.0, 2.0]) == (-math.inf, math.inf)


@pytest.mark.parametrize(("successes", "trials"), [(0, 20), (1, 20), (14, 20), (20, 20), (60, 99)])
def test_intervals_of_shares_are_clopper_and_pearsons(successes, trials):
    interval = scipy.stats.binomtest(successes, trials).proportion_ci(method="exact")
    assert share_interval(successes, trials) == pytest.approx(tuple(interval), abs=1e-9)


def test_nothing_is_known_of_a_share_without_trials():
    assert share_interval(0, 0) == (0.0, 1.0)


def test_pairs_are_compared_seed_by_seed():
    ours = [1.0] * 16 + [2.0, 2.0 + 1e-12, math.inf, math.inf]
    theirs = [1.5] * 16 + [1.0, 2.0, math.inf, 3.0]
    pairs = paired(ours, theirs)
    assert (pairs.smaller, pairs.larger, pairs.equal) == (16, 2, 2)
    assert pairs.share == share_interval(16, 18)
    assert pairs.decision == "smaller"
    assert (pairs.difference, pairs.interval) == (-0.5, (-0.5, -0.5))
    assert paired(theirs, ours).decision == "larger"
    assert "less on 16, more on 2 seeds, 2 ties" in str(pairs)


def test_a_ranking_takes_twenty_pairs_and_a_clear_majority():
    assert paired([1.0] * 19, [2.0] * 19).decision == "undecided"
    assert paired([1.0] * 20, [2.0] * 20).decision == "smaller"
    assert paired([1.0, 2.0] * 15, [2.0, 1.0] * 15).decision == "undecided"
    assert paired([1.0] * 20, [1.0] * 20).decision == "undecided"


@pytest.mark.parametrize(
    ("wins", "losses", "verdict"),
    [(20, 0, "reproduced"), (15, 5, "reproduced"), (12, 8, "differs"), (3, 17, "differs")],
)
def test_a_claim_that_one_column_is_smaller_is_judged_by_pairs(wins, losses, verdict):
    seeds = [[1.0, 2.0]] * wins + [[None, 2.0]] * losses
    judged = judge_smaller(Row("row", ["a", "b"], [None, None], seeds), "a", than="b")
    assert judged.verdict == verdict, judged.reason


def test_a_claim_about_pairs_is_not_judged_by_few():
    row = Row("row", ["a", "b"], [None, None], [[1.0, 2.0]] * 19)
    assert judge_smaller(row, "a", than="b").verdict == "can't be checked"


def test_a_sum_with_a_missing_value_is_missing():
    assert total([0.1, 0.2]) == 0.3
    assert total([0.1, None]) is None


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
            "interquartile_mean": [1.0, 2.0, None, 4.5],
            "interval": [[1.0, 1.0], [2.0, 2.0], [None, None], [4.5, 4.5]],
            "per_seed": [[1.0, 2.0, None, 4.5]],
            "verdict": "",
            "reason": "",
            "digits": 1,
        }
    ]
    assert text.endswith("}\n")
    assert Result.from_json(text) == result


def test_numbers_that_json_does_not_have_are_refused():
    with pytest.raises(ValueError, match="not JSON compliant"):
        Result("id", [0], {"limit": float("inf")}, [], {}).to_json()


def test_a_row_near_its_reference_on_average_may_be_far_in_a_cell():
    off = [12.5, 10.4, 4.5, 8.5]
    printed = [9.0, 10.4, 4.5, 8.5]
    assert judge_mean_within(row([off] * 40), CLASSICAL, 0.7).verdict == "differs"
    near = [[9.6, 10.4, 4.5, 8.5], off] * 20
    assert judge_mean_within(row(near), CLASSICAL, 0.8).verdict == "reproduced"
    assert judge_mean_within(row(near, printed), CLASSICAL, 0.8).verdict == "close"
    assert judge_mean_within(row(near), CLASSICAL, 0.7).verdict == "close"
    escapes = judge_mean_within(row([*near[:-8], *[[None, 10.4, 4.5, 8.5]] * 8]), CLASSICAL, 0.8)
    assert (escapes.verdict, escapes.reason[:14]) == ("close", "32 of 40 seeds")
    assert judge_mean_within(row(near[:5]), CLASSICAL, 0.8).verdict == "can't be checked"


def test_the_middle_half_is_the_trimmed_mean():
    values = np.random.default_rng(0).exponential(size=100)
    assert interquartile_mean(values) == pytest.approx(scipy.stats.trim_mean(values, 0.25))
    # Edges count in part: of three values the outer ones by a quarter of a value each.
    assert interquartile_mean([1.0, 2.0, 9.0]) == pytest.approx((0.25 + 2.0 + 2.25) / 1.5)
    assert interquartile_mean([5.0]) == 5.0


def test_escapes_count_where_they_reach_the_middle_half():
    assert interquartile_mean([1.0, 2.0, 3.0, math.inf]) == 2.5
    assert interquartile_mean([1.0, 2.0, math.inf, math.inf]) == math.inf
    low, high = interquartile_mean_interval([2.0] * 20 + [math.inf] * 3)
    assert (low, high) == (pytest.approx(2.0), math.inf)


@pytest.mark.filterwarnings("error")
def test_values_below_all_numbers_count_like_those_above():
    inf = math.inf
    for values in ([-inf, 1.0, 2.0, 3.0], [-inf, -inf, 1.0, 2.0], [1.0, inf, inf, inf, 3.0]):
        mirrored = [-value for value in values]
        assert interquartile_mean(mirrored) == -interquartile_mean(values)
    assert interquartile_mean([-inf, 1.0, 2.0, inf]) == 1.5
    assert interquartile_mean([-inf, -inf, 1.0, 2.0]) == -inf
    low, high = interquartile_mean_interval([-inf] * 3 + [2.0] * 20)
    assert (low, high) == (-inf, pytest.approx(2.0))
    # With both in the middle half there is no mean, and nothing is known of it.
    assert math.isnan(interquartile_mean([-inf, -inf, inf, inf]))
    assert interquartile_mean_interval([-inf] * 9 + [1.0] + [inf] * 9) == (-inf, inf)
    pairs = paired([-inf, inf, -inf, inf], [-inf, inf, inf, -inf])
    assert (pairs.equal, pairs.smaller, pairs.larger) == (2, 1, 1)
    assert math.isnan(paired([-inf, inf], [inf, -inf]).difference)


def test_the_bootstrap_interval_is_scipys():
    values = np.random.default_rng(1).normal(size=60)
    expected = scipy.stats.bootstrap(
        (values,),
        lambda sample, axis: scipy.stats.trim_mean(sample, 0.25, axis=axis),
        method="percentile",
        n_resamples=5000,
        rng=np.random.default_rng(2),
    ).confidence_interval
    assert interquartile_mean_interval(values) == pytest.approx(expected, abs=0.03)


def test_an_interval_holds_the_middle_of_nineteen_in_twenty_samples():
    generator = np.random.default_rng(3)
    samples = generator.normal(size=(400, 40))
    held = sum(low <= 0.0 <= high for low, high in map(interquartile_mean_interval, samples))
    assert 360 <= held <= 395
