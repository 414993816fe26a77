"""Everything that describes something can be pickled, copied and compared, but not hashed."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import fuzzyrs as fz

VARIABLE = fz.Variable.evenly("x", (0, 1), "ab", shape="trapezoidal")
TWO = [VARIABLE, fz.Variable.evenly("y", (0, 1), "ab")]
SYSTEM = fz.TSK(TWO, np.arange(12.0) / 7, order=1, output="z", no_rule_fires=0.1)
GRID = fz.Discretiser([(-1, 1, 3), (0, 0.1, 2)])
ROBOT = fz.Vehicle(1.5, 0.31, 0.7)

THINGS = [
    fz.gaussian(0.1, 1 / 3),
    VARIABLE,
    SYSTEM,
    GRID,
    ROBOT,
    fz.FuzzyController(SYSTEM),
    fz.FuzzyController(SYSTEM, angle_limit=0.9, rate_limit=2.0),
    fz.TableController(GRID, np.arange(6) / 10),
    fz.OneOnOne(ROBOT, capture_radius=0.2, time_step=0.05),
    fz.GeneticPhase(iterations=3, mutation=0.3),
    fz.GeneRanges(width=(0.2, 0.4)),
    fz.Gene.real(0.1, 1 / 3),
    fz.Gene.integer(-(2**53), 7),
    fz.Gene.bit(),
    fz.Selection.neighbours(),
    fz.Selection.tournament(7),
    fz.Crossover.average(0.1, 0.9),
    fz.Crossover.simulated_binary(1 / 3),
    fz.Mutation.none(),
    fz.Mutation.gaussian(0.1, 1 / 3),
    fz.QLambdaTraining(episodes=3, starts=[(1, 2), (3, 4)], bootstrap_at_capture=False),
    fz.RewardGaTraining(steps=7, ranges=fz.GeneRanges(mean=(-2, 2))),
    fz.QlfisTraining(tune="consequents", critic_rate=(0.2, 0.1)),
    fz.DaiTraining(hidden=5, learning={"noise": 0.2}),
    fz.QlbgflcTraining(steps=7, phase_1=fz.QLambdaTraining(points=5)),
    fz.Finding("gap", "no term between 2 and 3"),
    fz.points([(0.1, 1 / 3), (0.7, 1), (1e300, 0)]),
    fz.Vehicle(1.5, 0.31, 0.7, speed_law="cosine"),
    fz.OneOnOne(ROBOT, capture="swept"),
    fz.Schedule.linear(0.1, 1 / 3, 1000),
    fz.Schedule.power(0.1, 1 / 3),
    fz.PD(0.99, 0.02),
    fz.EvasiveTurn(1.6, wrapped=True),
    fz.Parallel(fz.PD(0.99, 0.02), "bang-bang"),
    fz.FuzzyRegulator.thesis_pruned(3),
    fz.FuzzyRegulator(SYSTEM, error_gain=1 / 3),
    fz.Wall.polyline([(0, 1 / 3), (2, 4)], sensing="vertical"),
    fz.WallFollowing(fz.Wall.jog(), robot=ROBOT, time_step=0.05, sensor_range=7.0),
    fz.WallGeneRanges(gain=(1, 3)),
    fz.MixedTableController(GRID, [-0.1, 1 / 3], [[1 / 3, 2 / 3]] * 6, seed=2**64 - 1),
    fz.MinimaxQTraining(play="mixed", ties="first", evader_actions=5),
    fz.TwoPursuers((ROBOT, fz.Vehicle(2, 0.3, 0.5)), aim="intercept", flight="nearest"),
    fz.TwoPursuersQLambdaTraining(episodes=3, clearance=1 / 3),
    fz.TwoPursuersQlbgflcTraining(phase_1={"spread": 4}, stage_2={"fresh_mutants": True}),
    fz.MDP.garnet(4, 2, 3, reward_noise=1 / 3, seed=1),
    fz.ManyOnMany([ROBOT, fz.Vehicle(2, 0.3, 0.5)], [ROBOT] * 2, time_step=0.05, capture="swept"),
    fz.CoupledRobotsTraining(steering="epsilon-greedy", discount=1 / 3),
    fz.CouplingTraining(reward="inv_f", rate_count="episodes"),
    fz.PairwiseTraining(objective="sum", robots=fz.CoupledRobotsTraining(points=5)),
    fz.WallIgbflcTraining(
        population=20, operators="modern", ranges=fz.WallGeneRanges(shift=(0, 0.1))
    ),
]
each = pytest.mark.parametrize("thing", THINGS, ids=lambda thing: type(thing).__name__)


@each
@pytest.mark.parametrize("protocol", range(2, pickle.HIGHEST_PROTOCOL + 1))
def test_pickles_come_back_equal(thing, protocol):
    assert pickle.loads(pickle.dumps(thing, protocol)) == thing


@each
def test_copies_are_equal(thing):
    assert copy.copy(thing) == thing == copy.deepcopy(thing)


@pytest.mark.parametrize("thing", [SYSTEM, THINGS[5], THINGS[6]])
def test_saved_files_come_back_equal_and_of_their_type(thing, tmp_path):
    thing.save(tmp_path / "thing.json")
    loaded = fz.load(tmp_path / "thing.json")
    assert type(loaded) is type(thing)
    assert loaded == thing


def test_a_file_of_another_type_is_refused_by_name(tmp_path):
    path = tmp_path / "other.json"
    path.write_text(SYSTEM.to_json().replace('"tsk"', '"mamdani"'), encoding="utf-8")
    with pytest.raises(fz.errors.FormatError, match='document type "mamdani" is not supported'):
        fz.load(path)


@each
def test_nothing_equals_another_type(thing):
    assert thing != 3
    assert [thing == other for other in THINGS].count(True) == 1


@each
def test_what_has_equality_without_a_hash_cannot_be_a_key(thing):
    with pytest.raises(TypeError, match="unhashable"):
        hash(thing)


@pytest.mark.parametrize("thing", [ROBOT, GRID, THINGS[8], *THINGS[9:11], *THINGS[16:20]])
def test_short_representations_are_the_constructor(thing):
    assert eval(repr(thing), vars(fz)) == thing
