"""Errors: every kind reaches its class, in the user's words, and nothing is left half done."""

from __future__ import annotations

import os
import pickle
import re
import subprocess
import sys

import numpy as np
import pytest

import fuzzyrs as fz
from fuzzyrs import _fuzzyrs as native
from fuzzyrs import errors

ANGLE = fz.Variable.evenly("angle", (-1, 1), "NZP")
RATE = fz.Variable.evenly("rate", (-1, 1), "NZP")
LEFT = fz.Variable.evenly("x", (0, 1), ["left", "right"])
GAUSSIANS = fz.Variable.evenly("y", (0, 1), ["low", "high"])
ONE = fz.TSK([ANGLE], [1, 2, 3], name="one")
TWO = fz.TSK([ANGLE, RATE], np.zeros((3, 3)), name="two")
GAME = fz.OneOnOne()
NAN, INF = float("nan"), float("inf")


def cancelled():
    control = fz.Control()
    control.cancel()
    return fz.train(GAME, fz.QLambdaTraining(episodes=2), control=control)


def late_start():
    search = fz.Genetic([(0, 1)], population=4)
    search.tell([1, 2, 3, 4])
    search.start_from([[0.5]])


def silent():
    far = fz.Variable("x", (0, 10), {"low": fz.triangular(0, 1, 2)})
    return fz.TSK([far], [3])(5.0)


def diverging():
    racer = fz.OneOnOne(fz.Vehicle(1e308, 1, 0.5), time_step=1)
    return racer.play(evader_start=(1000, 1000))


BY_KIND = {
    "not_finite": (lambda: fz.gaussian(NAN, 1), errors.InvalidValueError, ValueError),
    "out_of_range": (lambda: fz.gaussian(0, -1), errors.InvalidValueError, ValueError),
    "crossed_vertices": (lambda: fz.triangular(2, 1, 3), errors.InvalidValueError, ValueError),
    "duplicate_name": (
        lambda: fz.Variable.evenly("x", (0, 1), "aa"),
        errors.InvalidValueError,
        ValueError,
    ),
    "learning_diverged": (
        lambda: fz.QLambda(2, 2).learn(0, 0, 1e300, None, 1.0),
        errors.DivergedError,
        ArithmeticError,
    ),
    "bad_name": (lambda: fz.Variable("a.b", (0, 1), {}), errors.InvalidValueError, ValueError),
    "wrong_type": (lambda: TWO("a", "b"), errors.InvalidTypeError, TypeError),
    "wrong_shape": (lambda: TWO(1, 2, 3), errors.ShapeError, ValueError),
    "controller_inputs": (lambda: fz.FuzzyController(ONE), errors.ShapeError, ValueError),
    "unknown_name": (lambda: ANGLE["M"], errors.UnknownNameError, LookupError),
    "unsuitable": (
        lambda: fz.Output.tsukamoto(GAUSSIANS),
        errors.InvalidValueError,
        ValueError,
    ),
    "rule": (
        lambda: fz.System([LEFT], GAUSSIANS, "if x is left than y is low"),
        errors.RuleError,
        ValueError,
    ),
    "expression": (
        lambda: fz.System([LEFT], GAUSSIANS, "if x is left then y is low", hedges={"h": "x^"}),
        errors.RuleError,
        ValueError,
    ),
    "no_rule_fires": (silent, errors.NoRuleFiresError, ArithmeticError),
    "diverged": (diverging, errors.DivergedError, ArithmeticError),
    "format": (lambda: fz.TSK.from_json("{}"), errors.FormatError, ValueError),
    "unsupported": (
        lambda: fz.TSK.from_json(TWO.to_json().replace('"version": 1', '"version": 99')),
        errors.FormatError,
        ValueError,
    ),
    "file": (lambda: fz.load("no/such/file.json"), errors.FileError, OSError),
    "out_of_order": (late_start, errors.UsageError, RuntimeError),
    "memory": (
        lambda: fz.Genetic([(0, 1)], population=2**62),
        errors.MemoryLimitError,
        MemoryError,
    ),
    "cancelled": (cancelled, errors.CancelledError, RuntimeError),
}


UNPROVOKED = {
    # No portable way to run out of threads; below is one for Linux.
    "threads": (errors.ThreadsError, RuntimeError),
}


@pytest.mark.parametrize("kind", native.ERROR_KINDS)
def test_every_kind_of_error_reaches_its_class(kind):
    if kind in UNPROVOKED:
        error, (expected, built_in) = errors.from_kind(kind, "no such thing"), UNPROVOKED[kind]
    else:
        provoke, expected, built_in = BY_KIND[kind]
        with pytest.raises(errors.FuzzyrsError) as caught:
            provoke()
        error = caught.value
    assert type(error) is expected
    assert isinstance(error, built_in)
    assert error.kind == kind
    assert len(str(error)) > 5


def test_python_knows_exactly_the_kinds_of_rust():
    assert set(errors._CLASSES) == set(native.ERROR_KINDS)
    public = {getattr(errors, name) for name in errors.__all__}
    assert set(errors._CLASSES.values()) == public - {errors.FuzzyrsError}


def test_errors_survive_a_process_pool():
    with pytest.raises(errors.FuzzyrsError) as caught:
        fz.gaussian(0, 0)
    again = pickle.loads(pickle.dumps(caught.value))
    assert (type(again), str(again), again.kind) == (
        errors.InvalidValueError,
        str(caught.value),
        "out_of_range",
    )


@pytest.mark.skipif(sys.platform != "linux", reason="needs a limit of the address space")
def test_a_thread_that_could_not_be_started_was_a_panic():
    script = """
import resource
import fuzzyrs as fz
game, settings = fz.OneOnOne(), fz.QLambdaTraining(episodes=1)
used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + 2**20, -1))
try:
    fz.train(game, settings)
except fz.errors.ThreadsError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.stdout.startswith("cannot start 1 threads: "), done.stderr


ROWS = np.zeros((5, 2))
READ_ONLY = np.zeros(5)
READ_ONLY.flags.writeable = False
VECTOR = np.linspace(-1, 1, 5)


BAD_INPUT = [
    # Shapes
    (lambda: TWO(1.0), 'x for "two": expected 2 numbers or shape (n, 2), got a single number'),
    (lambda: TWO(np.zeros((4, 3))), "expected 2 numbers or shape (n, 2), got shape (4, 3)"),
    (lambda: TWO(), 'arguments of "two": expected 2, or one array, got 0'),
    (lambda: TWO(np.zeros(3), np.zeros(4)), "the inputs: expected arrays that broadcast"),
    (lambda: TWO([[1, 2], [3]]), "x must be numbers in a regular array"),
    (lambda: TWO.gradient(np.zeros(3)), 'inputs of "two": expected 2, got 3'),
    (lambda: TWO(ROWS, out=np.zeros(4)), "out must be a contiguous float64 array of shape (5,)"),
    (lambda: TWO(ROWS, out=np.zeros(5, "f4")), "out must be a contiguous float64 array of shape"),
    (lambda: TWO(ROWS, out=np.zeros((5, 2))[:, 0]), "out must be a contiguous float64 array"),
    (lambda: TWO(ROWS, out=[0] * 5), "out must be a contiguous float64 array of shape (5,)"),
    (lambda: TWO(ROWS, out=READ_ONLY), "out cannot be written"),
    (lambda: ONE(VECTOR, out=VECTOR), "out cannot be written"),
    (lambda: TWO(0, 0, out=np.zeros(1)), "out: expected inputs of shape (n,)"),
    (lambda: fz.TSK([ANGLE, RATE], np.zeros((9, 1))), "consequents: expected shape (3, 3)"),
    (lambda: fz.TSK([ANGLE], [1, 2]), 'consequent parameters of "system": expected 3, got 2'),
    (lambda: TWO.with_parameters(np.zeros(3)), 'parameters of "two": expected 21, got 3'),
    (lambda: GAME.play(evader_start=(1, 2, 3, 4)), "evader_start: expected x, y and perhaps a"),
    (lambda: GAME.play(evader_start=[(1, 2)] * 2), "starts of one game: expected 1, got 2"),
    (lambda: fz.fit_genetic(TWO, ROWS, np.zeros(4)), "one for each row of X: expected 5, got 4"),
    (lambda: fz.Genetic([(0, 1)], population=4).tell([1]), "fitness values: expected 4, got 1"),
    # Types
    (lambda: TWO(1j, 0), "the inputs must be real numbers, got dtype complex128"),
    (lambda: TWO(None, 0), "the inputs must be real numbers, got dtype object"),
    (lambda: TWO(10**400, 0), "the inputs must be real numbers, got dtype object"),
    (
        lambda: GAME.play(3, evader_start=(1, 2)),
        'the pursuer must be "classical", "bang-bang", a PD',
    ),
    (lambda: fz.train(GAME, 3), "settings must be QLambdaTraining, MinimaxQTraining, RewardGa"),
    (lambda: fz.GeneticPhase(iterations="many"), "iterations must be a whole number from 0 to"),
    (lambda: fz.GeneRanges(width=(1, 2, 3)), "width must be a pair of numbers"),
    (lambda: fz.TSK([ANGLE], [1, 2, 3], no_rule_fires=[]), '"nan", "previous" or a number'),
    # Not finite
    (lambda: TWO(NAN, 0), 'input "angle" must be finite, got NaN'),
    (lambda: TWO([[0, 0], [0, INF]]), 'input "rate" of point 1 must be finite, got inf'),
    (lambda: fz.TSK([ANGLE], [1, NAN, 3]), "consequents[1] must be finite, got NaN"),
    (lambda: ONE.with_parameters([NAN] * 9), "mean of a gaussian membership function must be fin"),
    (lambda: fz.Variable("x", (0, INF), {}), "upper end of the universe must be finite, got inf"),
    (lambda: GAME.play(evader_start=(1, NAN)), "starting y of the evader must be finite, got NaN"),
    (lambda: fz.QLambda(2, 2).learn(0, 0, NAN, None, 0.1), "reward must be finite, got NaN"),
    (lambda: fz.FuzzyController(TWO, rate_limit=NAN), "rate limit must be finite, got NaN"),
    # Ranges
    (lambda: fz.gaussian(0, 0), "sigma of a gaussian membership function must be positive, got 0"),
    (lambda: fz.gaussian_width(0, -1), "width of a gaussian_width membership function must be"),
    (lambda: fz.trapezoidal(0, 2, 1, 3), "vertices of a trapezoidal membership function must not"),
    (lambda: fz.triangular(1, 1, 1), "c of a triangular membership function must be above a (1)"),
    (lambda: fz.s_shape(2, 1), "the vertices of an s_shape membership function must not decrease"),
    (lambda: fz.bell(0, 1, 0), "slope of a bell membership function must be positive, got 0"),
    (lambda: fz.sigmoid(0, 0), "slope of a sigmoid membership function must be other than 0"),
    (lambda: fz.arc(1, 1), "end of an arc membership function must be different from start (1)"),
    (lambda: fz.step(0, 0), "direction of a step membership function must be 1 or -1"),
    (lambda: fz.points([(0, 0), (0, 1)]), "x1 of a points membership function must be above x0"),
    (lambda: fz.points([(0, 0), (1, 2)]), "y1 of a points membership function must be between 0"),
    (lambda: fz.points([(0, 0)]), "points membership function: expected an even number from 4, g"),
    (lambda: fz.points([0, 0, 1, 1]), "points: expected an array of shape (n, 2), got shape (4,)"),
    (lambda: fz.sampled(abs, (0, 1), 1), "samples must be at least 2, got 1"),
    (lambda: fz.sampled(abs, (1, 0)), "the universe must be two finite numbers that increase"),
    (lambda: fz.sampled(abs, (-2, 0), 3), "degrees must be between 0 and 1, got 2.0 at -2.0"),
    (lambda: fz.sampled(lambda x: x * NAN, (0, 1)), "must be between 0 and 1, got nan at 0.0"),
    (
        lambda: fz.sampled(lambda x: x[:-1], (0, 1), 3),
        "degrees: expected shape (3,), got shape (2,",
    ),
    (lambda: fz.sampled(str, (0, 1)), "degrees must be real numbers, got dtype <U"),
    (lambda: fz.gaussian(0, 1).core((1, 1)), "upper end of the universe must be above 1, got 1"),
    (lambda: fz.gaussian(0, 1).slope("x"), "x must be real numbers, got dtype <U1"),
    (lambda: fz.Variable("x", (1, 1), {}), "upper end of the universe must be above 1, got 1"),
    (lambda: fz.OneOnOne(time_step=0), "time step must be positive, got 0"),
    (lambda: GAME.play(evader_start=(1, 2), max_time=0), "max_time must be positive, got 0"),
    (lambda: GAME.play(evader_start=(1, 2), max_time=0.01), "number of time steps in max_time"),
    (lambda: fz.Vehicle(-1, 0.3, 0.5), "speed must be zero or more, got -1"),
    (lambda: fz.Vehicle(1, 0.3, 1.6), "steering limit must be above 0 and below π/2, got 1.6"),
    (lambda: fz.OneOnOne(capture_radius=0), "capture radius must be positive, got 0"),
    (lambda: fz.Genetic([(0, 1)], population=3), "population must be at least 4, got 3"),
    (lambda: fz.Genetic([(1, 0)]), "upper end of the range of gene 0 must be above 1, got 0"),
    (lambda: fz.Genetic([(0, 1)], elite=50), "together must be at most the population, 40, got 50"),
    (lambda: fz.train(GAME, fz.QLambdaTraining(steps=0)), "steps must be at least 1, got 0"),
    (lambda: fz.train(GAME, fz.QLambdaTraining(starts=np.empty((0, 2)))), "starting positions"),
    (lambda: fz.TSK([ANGLE], [1, 2, 3], order=-1), "order must be 0 or 1, got -1"),
    (lambda: fz.TSK([ANGLE], [1, 2, 3], order=300), "order must be 0 or 1, got 300"),
    (lambda: TWO(ROWS, threads=-1), "must be a whole number from 0 to 2^64 - 1, got -1"),
    (lambda: fz.QLambda(2, 2, seed=2**64), "whole number from 0 to 2^64 - 1, got 18446744073709"),
    (lambda: fz.QLambda(2, 2).learn(2, 0, 1, None, 0.1), "state must be below 2, got 2"),
    (lambda: fz.QLambda(2, 2).learn(0, 0, 1, -1, 0.1), "whole number from 0 to 2^64 - 1, got -1"),
    (lambda: fz.Discretiser([(0, 1, -1)]), "whole number from 0 to 2^64 - 1, got -1"),
    (lambda: fz.Discretiser([(0, 1, 1)]), "points of a grid must be at least 2, got 1"),
    # Names
    (lambda: LEFT["letf"], 'unknown term "letf"; did you mean "left"?'),
    (lambda: LEFT["up"], 'unknown term "up"; known: left, right'),
    (lambda: GAME.play("clasical", evader_start=(1, 2)), 'did you mean "classical"?'),
    (lambda: fz.MembershipFunction("triangle", [0, 1, 2]), 'did you mean "triangular"?'),
    (
        lambda: fz.Variable.evenly("x", (0, 1), "ab", shape="ramp"),
        'unknown shape of an even partition "ramp"; known: gaussian, gaussian_width, two_sided',
    ),
    (lambda: fz.TSK([ANGLE], [1, 2, 3], no_rule_fires="non"), 'did you mean "nan"?'),
    (lambda: fz.QLambda(2, 2, trace="replacing_stat"), 'did you mean "replacing_state"?'),
    (lambda: fz.TSK([ANGLE, ANGLE], np.zeros(9)), 'input "angle" appears twice in system "syste'),
    # Documents
    (lambda: fz.TSK.from_json("[1, 2"), "not a valid fuzzyrs JSON document"),
    (lambda: fz.TSK.from_json(TWO.to_json()[:-20]), "not a valid fuzzyrs JSON document: EOF"),
]


@pytest.mark.parametrize(("call", "words"), BAD_INPUT, ids=[words[:40] for _, words in BAD_INPUT])
def test_bad_input_is_refused_in_the_users_words(call, words):
    with pytest.raises(errors.FuzzyrsError, match=re.escape(words)):
        call()


def test_a_failed_call_leaves_no_trace():
    learner = fz.QLambda(2, 2, seed=1)
    learner.learn(0, 0, 1.0, None, 0.5)
    before = learner.values
    with pytest.raises(errors.InvalidValueError):
        learner.learn(0, 0, INF, None, 0.5)
    np.testing.assert_array_equal(learner.values, before)


def test_a_failed_save_leaves_the_old_file_and_nothing_else(tmp_path):
    folder = tmp_path / "full"
    folder.mkdir()
    (folder / "kept").write_text("old")
    with pytest.raises(errors.FileError, match=re.escape(f"cannot write {folder}: ")):
        TWO.save(folder)
    with pytest.raises(errors.FileError, match="cannot write"):
        TWO.save(tmp_path / "missing" / "system.json")
    assert [path.name for path in tmp_path.iterdir()] == ["full"]
    assert (folder / "kept").read_text() == "old"


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs a limit on the size of files")
def test_a_full_disk_leaves_the_old_file(tmp_path):
    path = tmp_path / "system.json"
    ONE.save(path)
    script = f"""
import resource, signal
import fuzzyrs as fz
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
system = fz.load({str(path)!r})
resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))
try:
    system.with_parameters(system.parameters * 0.5).save({str(path)!r})
except fz.errors.FileError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.stdout.startswith(f"cannot write {path}: "), done.stderr
    assert fz.load(path) == ONE
    assert [path.name for path in tmp_path.iterdir()] == ["system.json"]


@pytest.mark.parametrize("points", [2**16, 2**32, 2**33, 2**63 + 1])
def test_a_grid_whose_number_of_states_wraps_is_refused(points):
    with pytest.raises(errors.ShapeError, match="states of a grid"):
        fz.Discretiser([(0, 1, points)] * 2)
    with pytest.raises(errors.ShapeError, match="states of a grid"):
        fz.train(fz.OneOnOne(), fz.QLambdaTraining(points=points))


@pytest.mark.parametrize("population", [2**61, 2**62, 2**64 - 1])
def test_a_population_that_no_memory_holds_is_refused(population):
    with pytest.raises(errors.FuzzyrsError, match="population"):
        fz.Genetic([(0, 1)] * 3, population=population)
    size = fz.GeneticPhase(population=population)
    with pytest.raises(errors.FuzzyrsError, match="population"):
        fz.train(fz.OneOnOne(), fz.RewardGaTraining(genetic=size))


def test_what_does_not_fit_is_found_before_the_first_game():
    stage_2 = fz.GeneticPhase(population=3)
    for settings in [fz.QlbgflcTraining(stage_2=stage_2), fz.QlbgflcTraining(starts=[[1, np.nan]])]:
        control = fz.Control()
        with pytest.raises(errors.FuzzyrsError):
            fz.train(fz.OneOnOne(), settings, control=control)
        assert control.done == 0


def test_names_that_share_nothing_are_not_proposed():
    with pytest.raises(errors.UnknownNameError, match="known: N, Z, P"):
        fz.Variable.evenly("x", (0, 1), "NZP")["Q"]
