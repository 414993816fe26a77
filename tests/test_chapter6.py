"""Chapter 6, a learning pursuer: its experiments in small, and what is expected over many seeds."""

from __future__ import annotations

import json
import math
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache, partial

import numpy as np
import pytest

import fuzzyrs as fz
from fuzzyrs.experiments import find, reproduce
from fuzzyrs.experiments.chapter6_ablation import AblationConfig
from fuzzyrs.experiments.chapter6_agile import AgileConfig, escapes_of
from fuzzyrs.experiments.chapter6_studies import StudyConfig
from fuzzyrs.experiments.experiment import published
from fuzzyrs.experiments.tuned import rule_table
from small import CONFIG

DURATIONS = "duration of the games [s]"
FIRST_SEED = 40_000

SMALL = {
    "table-6-1": None,
    "table-6-2": CONFIG,
    "figure-6-6": StudyConfig(steps=(50, 600, 1200), learner=fz.QLambdaTraining(episodes=8)),
    "figure-6-8": StudyConfig(episodes=(4, 8)),
    "table-6-4": replace(
        AgileConfig(max_time=10.0, starts=((2.0, 4.0), (-4.0, 2.0))),
        q_lambda=CONFIG.q_lambda,
        reward_ga=CONFIG.reward_ga,
        qlbgflc=CONFIG.qlbgflc,
    ),
    "ablation-6-5": AblationConfig(CONFIG, budgets=(1, 3), starts=((2.0, 4.0), (-4.0, 2.0))),
}


@pytest.mark.parametrize("name", list(SMALL))
def test_experiments_run_and_draw(name, tmp_path, drawn):
    experiment = find(name)(SMALL[name])
    seeds = [3, 4]
    result = reproduce(experiment, seeds, tmp_path)
    written = json.loads((tmp_path / f"{name}.json").read_text(encoding="utf-8"))
    assert written["config"] == json.loads(json.dumps(experiment.config()))
    for path in drawn(experiment, tmp_path):
        assert path.stat().st_size > 1000
    for row in experiment.rows(result.outcomes * 10):
        assert row.verdict
        assert len(row.per_seed) == 20


def test_figures_are_found_where_they_are_shown():
    for figure, shown in {
        "figure-6-7": "figure-6-6",
        "figure-6-9": "figure-6-8",
        "figure-6-10": "table-6-2",
        "figure-6-11": "table-6-4",
        "figure-4-6": "table-4-4",
    }.items():
        assert find(figure) is find(shown)


def test_the_settings_are_the_printed_ones(tmp_path):
    rows = reproduce(find("table-6-1")(), [0], tmp_path).rows
    assert [row.verdict for row in rows] == ["reproduced", "reproduced"]
    other = fz.QlbgflcTraining(stage_2=fz.GeneticPhase(iterations=201, population=10))
    rows = reproduce(find("table-6-1")(other), [0], tmp_path).rows
    assert [row.verdict for row in rows] == ["reproduced", "differs"]


def test_limits_that_no_game_reaches_are_one_run():
    config = StudyConfig(steps=(100, 300, 6000), learner=fz.QLambdaTraining(episodes=30))
    outcome = find("figure-6-6")(config).run_seed(5, fz.Control())
    for index, steps in enumerate(config.steps):
        learner = fz.QLambdaTraining(episodes=30, steps=steps)
        durations = fz.train(fz.OneOnOne(), learner, seed=5).history[DURATIONS]
        assert outcome["mean duration"][index] == pytest.approx(durations.mean(), abs=1e-6)
        assert outcome["learning time"][index] == pytest.approx(durations.sum(), abs=1e-6)
    assert outcome["mean duration"][0] != outcome["mean duration"][2]


def test_fewer_games_are_the_beginning_of_more():
    outcome = find("figure-6-8")(StudyConfig(episodes=(10, 40))).run_seed(6, fz.Control())
    for index, episodes in enumerate((10, 40)):
        learner = fz.QLambdaTraining(episodes=episodes)
        durations = fz.train(fz.OneOnOne(), learner, seed=6).history[DURATIONS]
        assert outcome["mean duration"][index] == pytest.approx(durations.mean(), abs=1e-6)


def test_the_printed_learning_times_are_one_multiple_of_games_times_mean():
    printed = published("figure-6-8")
    times, means = printed["learning_time"], printed["capture_time"]
    first, second = (times[n] / (int(n) * means[n]) for n in ("200", "300"))
    assert first == pytest.approx(second, rel=0.003)


def test_terms_are_taken_in_the_order_of_their_means():
    angle = {"N": fz.gaussian(0.5, 1), "Z": fz.gaussian(-0.5, 1), "P": fz.gaussian(0.0, 1)}
    rate = {"N": fz.gaussian(-1, 1), "Z": fz.gaussian(1, 1), "P": fz.gaussian(0, 1)}
    inputs = [fz.Variable("angle", (-1, 1), angle), fz.Variable("rate", (-1, 1), rate)]
    system = fz.TSK(inputs, np.arange(9.0).reshape(3, 3))
    assert rule_table(system).tolist() == [[3, 5, 4], [6, 8, 7], [0, 2, 1]]


def test_an_escape_is_a_distance_that_rises_again():
    assert escapes_of(np.array([2.0, 1.0, 0.5, 0.4, 0.7, 0.9, 0.3]), 0.6) == 1
    assert escapes_of(np.array([2.0, 0.5, 1.0, 0.5, 1.0]), 0.6) == 2
    assert escapes_of(np.array([2.0, 1.0, 0.5]), 0.6) == 0


def test_only_sampling_lets_the_agile_evader_escape_the_classical_pursuer():
    settings = AgileConfig()
    distance = settings.evader.switching_distance
    assert distance == pytest.approx(0.3 / math.tan(0.5))
    escapes = {}
    for game in (settings.game, settings.swept):
        paths = [game.play(evader=settings.evader, evader_start=s) for s in settings.starts]
        assert all(path.captured for path in paths)
        escapes[game.capture] = [escapes_of(path.distance, distance) for path in paths]
    assert np.mean(escapes["sampled"]) == 2.25
    assert not any(escapes["swept"])
    drawn = settings.game.play_many(evader=settings.evader, evader_starts=settings.drawn)
    assert drawn.capture_time.tolist() == [18.6, 11.9, 4.3, 10.2]


def test_stage_2_alone_plays_only_its_own_games():
    game = fz.OneOnOne()
    whole, alone = (
        fz.train(game, fz.QlbgflcTraining(prepared=prepared), seed=2) for prepared in (True, False)
    )
    assert list(alone.history) == list(whole.history)[3:]
    assert alone.controller.to_json() != whole.controller.to_json()
    assert "prepared=True" in repr(fz.QlbgflcTraining())
    # Stage 1, which is left out, need not keep enough for stage 2.
    few = fz.GeneticPhase(population=8, iterations=5)
    fz.train(game, fz.QlbgflcTraining(stage_1=few, prepared=False))
    with pytest.raises(fz.errors.InvalidValueError, match="stage 1 keeps for stage 2"):
        fz.train(game, fz.QlbgflcTraining(stage_1=few))


def verdicts(name, count, tmp_path, first=FIRST_SEED):
    rows = reproduce(find(name)(), range(first, first + count), tmp_path).rows
    return {row.name: row for row in rows}


@pytest.mark.parametrize(("name", "runs"), [("figure-6-6", 100), ("figure-6-8", 20)])
def test_the_studies_fall_and_then_hardly(name, runs, tmp_path):
    rows = verdicts(name, runs, tmp_path)
    assert rows["mean duration"].verdict == "reproduced", rows["mean duration"].reason
    assert rows["learning time"].verdict == "reproduced", rows["learning time"].reason


def test_few_runs_do_not_tell_whether_a_curve_falls(tmp_path):
    row = verdicts("figure-6-6", 20, tmp_path)["mean duration"]
    assert row.verdict == "can't be checked", row.reason


@cache
def means_by_games():
    """Mean durations after 200 and 1200 games, over the thesis's 100 runs."""
    study = find("figure-6-8")(StudyConfig(episodes=(200, 1200)))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        run = partial(study.run_seed, control=fz.Control())
        outcomes = list(pool.map(run, range(FIRST_SEED, FIRST_SEED + 100)))
    return np.mean([outcome["mean duration"] for outcome in outcomes], axis=0)


@pytest.mark.reproduction
@pytest.mark.xfail(reason="by 5.0 % on the seeds 0-99, by 8.0 % on these: more than expected")
def test_a_thousand_games_more_than_200_shorten_the_mean_by_less_than_a_twentieth():
    first, last = means_by_games()
    assert last > 0.95 * first


@pytest.mark.reproduction
def test_a_thousand_games_more_than_200_shorten_the_mean_by_less_than_an_eighth():
    first, last = means_by_games()
    assert 0.875 * first < last < first


@pytest.mark.reproduction
def test_qlbgflc_catches_the_agile_evader_better_than_q_lambda_and_worse_than_the_ga(tmp_path):
    rows = verdicts("table-6-4", 40, tmp_path)
    assert rows["qlbgflc"].verdict == "reproduced", rows["qlbgflc"].reason
    assert rows["classical, swept"].verdict == "differs"
    assert rows["mean duration, qlbgflc and q_lambda"].verdict == "reproduced"
    ranking = rows["mean duration, qlbgflc and reward_ga"]
    assert ranking.verdict == "differs", ranking.reason


@pytest.mark.reproduction
def test_phase_1_and_stage_1_contribute_nothing_at_the_thesiss_budget(tmp_path):
    rows = verdicts("ablation-6-5", 60, tmp_path)
    full = rows["full budget"]
    assert full.verdict == "differs", full.reason
    assert full.median[0] == pytest.approx(full.median[1], abs=0.1)
    assert rows["prepared"].median[0] > rows["random"].median[0]
    assert rows["Q(λ) alone with ε = 1/i, capture times"].verdict == "differs"
