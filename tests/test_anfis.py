"""ANFIS beside plain NumPy: least squares, gradients, MATLAB's errors, and what data may be."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fuzzyrs as fz
from fuzzyrs.estimators import ANFISRegressor

RANDOM = np.random.default_rng(3)
POINTS = RANDOM.uniform(-1, 1, (60, 2))
TARGETS = np.sin(3 * POINTS[:, 0]) * POINTS[:, 1] + POINTS[:, 0]


def grid(shape="gaussian", order=1, terms="NZP", **options):
    inputs = [fz.Variable.evenly(name, (-1, 1), terms, shape) for name in "xy"]
    sizes = [len(terms)] * 2 + ([3] if order else [])
    return fz.TSK(inputs, np.zeros(sizes), order=order, **options)


def design(system, points):
    """The matrix of (2.18), from the rules' strengths."""
    strengths = system.strengths(points)
    shares = strengths / strengths.sum(axis=1, keepdims=True)
    if not system.order:
        return shares
    factors = np.c_[points, np.ones(len(points))]
    return (shares[:, :, None] * factors[:, None, :]).reshape(len(points), -1)


def consequents(system, count):
    return system.parameters[-count:]


@pytest.mark.parametrize("order", [0, 1])
@pytest.mark.parametrize("solver", ["cholesky", "orthogonal"])
@pytest.mark.parametrize("ridge", [0.0, 1e-3])
def test_consequents_are_those_of_numpys_least_squares(order, solver, ridge):
    system = grid(order=order)
    fit = fz.fit_anfis(system, POINTS, TARGETS, premise="fixed", solver=solver, ridge=ridge)
    matrix = design(system, POINTS)
    extended = np.r_[matrix, np.sqrt(ridge) * np.eye(matrix.shape[1])]
    wanted = np.r_[TARGETS, np.zeros(matrix.shape[1])]
    expected = np.linalg.lstsq(extended, wanted, rcond=None)[0]
    np.testing.assert_allclose(consequents(fit.system, len(expected)), expected, atol=1e-6)
    error = np.sqrt(np.mean((matrix @ expected - TARGETS) ** 2))
    np.testing.assert_allclose(fit.history["training"], [error], rtol=1e-6)
    assert fit.stopped == "fixed"
    assert fit.best_epoch == 0


def test_fewer_samples_than_unknowns_have_the_solution_of_least_norm():
    few, wanted = POINTS[:8], TARGETS[:8]
    for solver in ["cholesky", "orthogonal"]:
        fit = fz.fit_anfis(grid(), few, wanted, premise="fixed", solver=solver)
        expected = np.linalg.pinv(design(grid(), few)) @ wanted
        np.testing.assert_allclose(consequents(fit.system, 27), expected, atol=1e-8)


SHAPES = ["gaussian", "gaussian_width", "bell", "two_sided_gaussian", "pi_shape", "cosine"]


@pytest.mark.parametrize("shape", [*SHAPES, "triangular", "trapezoidal", "spike"])
def test_a_batch_step_follows_the_gradient(shape):
    system = fz.fit_anfis(grid(shape), POINTS, TARGETS, premise="fixed", ridge=1e-6).system
    rate = 1e-3
    options = {"solver": None, "premise": "batch", "rate": rate, "epochs": 2}
    fit = fz.fit_anfis(system, POINTS, TARGETS, **options)
    assert fit.best_epoch == 1
    count = len(system.parameters) - 27

    def loss(premise):
        moved = system.with_parameters(np.r_[premise, system.parameters[count:]])
        return 0.5 * np.mean((moved(POINTS) - TARGETS) ** 2)

    start, size = system.parameters[:count], 1e-6
    steps = size * np.eye(count)
    slopes = [(loss(start + step) - loss(start - step)) / (2 * size) for step in steps]
    moved = fit.system.parameters[:count] - start
    # Vertices that the samples' kinks move through have one-sided slopes; they are few.
    np.testing.assert_allclose(moved, -rate * np.array(slopes), atol=1e-3 * rate)


def matlab():
    x = np.linspace(0, 10, 101)
    centres = zip("abcde", (0, 2.5, 5, 7.5, 10), strict=True)
    bells = {name: fz.bell(centre, 1.25, 2) for name, centre in centres}
    system = fz.TSK([fz.Variable("x", (0, 10), bells)], np.zeros((5, 2)), order=1)
    return system, x[:, None], np.sin(2 * x) / np.exp(x / 5)


def test_the_errors_that_matlab_prints_come_out_digit_for_digit():
    fit = fz.fit_anfis(*matlab(), epochs=8)
    errors = fit.history["training"]
    printed = f"{errors[0]:.7f} {errors[1]:.7f} {errors[2]:.6f}"
    assert printed == "0.0694086 0.0680259 0.066663"
    np.testing.assert_allclose(fit.history["rate"], [0.01] * 5 + [0.011] * 3)


@pytest.mark.parametrize("shape", ["triangular", "trapezoidal", "gaussian", "bell"])
@settings(max_examples=15, deadline=None)
@given(rate=st.floats(1e-4, 1e3), seed=st.integers(0, 99))
def test_no_step_makes_an_invalid_system_or_loses_the_best(shape, rate, seed):
    fit = fz.fit_anfis(
        grid(shape, no_rule_fires=0.0), POINTS, TARGETS, premise="shuffled", rate=rate, seed=seed,
        epochs=5, ridge=1e-6,
    )  # fmt: skip
    errors = fit.history["training"]
    assert errors[fit.best_epoch] == errors.min()
    reached = np.sqrt(np.mean((fit.system(POINTS) - TARGETS) ** 2))
    np.testing.assert_allclose(reached, errors.min(), rtol=1e-9)
    fit.system.with_parameters(fit.system.parameters)


def rules(outputs=2):
    inputs = [fz.Variable.evenly(name, (-1, 1), ["low", "high"]) for name in "xy"]
    sugeno = [
        fz.Output.sugeno(f"u{k}", {"a": [0, 0, 0], "b": 0, "c": "sin(x)*y"}) for k in range(outputs)
    ]
    said = [" and ".join(f"u{k} is {term}" for k in range(outputs)) for term in "abc"]
    text = [
        f"if x is low or y is very low then {said[0]}",
        f"if x is high then {said[1]}",
        f"if x is low and y is high then {said[2]}",
    ]
    return fz.System(inputs, sugeno, text)


def test_given_rules_with_several_outputs_are_fitted():
    system = rules()
    wanted = np.c_[TARGETS, POINTS @ [1, -2]]
    fit = fz.fit_anfis(system, POINTS, wanted, epochs=15, validation=(POINTS[:9], wanted[:9]))
    assert set(fit.history) == {"training", "validation", "rate"}
    validation = fit.history["validation"]
    assert fit.best_epoch == validation.argmin() > 0
    # The first epoch's consequents by NumPy: the formula is what has no parameters.
    w = system.strengths(POINTS)
    w /= w.sum(axis=1, keepdims=True)
    matrix = np.c_[w[:, :1] * np.c_[POINTS, np.ones(60)], w[:, 1]]
    rest = w[:, 2] * np.sin(POINTS[:, 0]) * POINTS[:, 1]
    first = fz.fit_anfis(system, POINTS, wanted, premise="fixed").system
    for k in range(2):
        expected = np.linalg.lstsq(matrix, wanted[:, k] - rest, rcond=None)[0]
        start = 8 + 4 * k
        np.testing.assert_allclose(first.parameters[start : start + 4], expected, atol=1e-9)


def test_the_same_seed_gives_the_same_bits():
    def run(seed):
        options = {"premise": "shuffled", "seed": seed, "epochs": 4}
        return fz.fit_anfis(grid(), POINTS, TARGETS, **options).system.parameters

    assert (run(1) == run(1)).all()
    assert (run(1) != run(2)).any()


def test_training_stops_when_it_is_told_to_or_gets_no_better():
    opposite = (POINTS, -TARGETS)
    options = {"premise": "batch", "rate": 0.5, "epochs": 500}
    fit = fz.fit_anfis(grid(), POINTS, TARGETS, validation=opposite, patience=2, **options)
    assert fit.stopped == "patience"
    assert len(fit.history["training"]) == fit.best_epoch + 3
    control = fz.Control()
    control.cancel()
    with pytest.raises(fz.errors.CancelledError):
        fz.fit_anfis(grid(), POINTS, TARGETS, control=control)
    lost = fz.fit_anfis(grid(), POINTS, TARGETS, premise="sequential", rate=1e300)
    assert lost.stopped == "diverged"
    assert "finite" in lost.reason
    assert lost.best_epoch == 0
    seen = []
    fz.fit_anfis(grid(), POINTS, TARGETS, epochs=3, progress=seen.append)
    assert seen[-1] == 3


GAP = fz.TSK([fz.Variable("x", (0, 10), {"low": fz.triangular(0, 1, 2)})], [0])
BAD = np.where(np.arange(120).reshape(60, 2) == 7, np.nan, POINTS)
MAMDANI = fz.System(
    fz.Variable.evenly("x", (0, 1), "ab"),
    fz.Variable.evenly("y", (0, 1), "ab"),
    "if x is a then y is a",
)


@pytest.mark.parametrize(
    ("work", "message"),
    [
        (lambda: fz.fit_anfis(grid(), BAD, TARGETS), "must be finite, got NaN"),
        (
            lambda: fz.fit_anfis(grid(), POINTS, BAD[:, 1]),
            "targets of the samples.* must be finite",
        ),
        (lambda: fz.fit_anfis(grid(), POINTS, TARGETS[:9]), "one for each row of X: expected 60"),
        (lambda: fz.fit_anfis(grid(), POINTS, POINTS), r"y: expected an array of shape \(n,\)"),
        (lambda: fz.fit_anfis(grid(), POINTS[:, :1], TARGETS), r"X: expected .*\(n, 2\)"),
        (lambda: fz.fit_anfis(rules(), POINTS, TARGETS), r"y: expected .*\(n, 2\)"),
        (lambda: fz.fit_anfis(grid(), POINTS[:0], TARGETS[:0]), "samples must be at least 1"),
        (lambda: fz.fit_anfis(grid(outside="error"), 2 * POINTS, TARGETS), 'input "[xy]" of point'),
        (lambda: fz.fit_anfis(GAP, [[1.0], [5.0]], [1, 1]), r"fires at sample 1 \[5.0\]"),
        (lambda: fz.fit_anfis(MAMDANI, [[1.0]], [1]), "constants or linear functions"),
        (lambda: fz.fit_anfis(grid(), POINTS, TARGETS, ridge=-1), "ridge must be zero or more"),
        (lambda: fz.fit_anfis(grid(), POINTS, TARGETS, rate=0), "must be positive"),
        (lambda: fz.fit_anfis(grid(), POINTS, TARGETS, epochs=0), "epochs must be at least 1"),
        (lambda: fz.fit_anfis(grid(), POINTS, TARGETS, patience=0), "patience must be at least 1"),
        (lambda: fz.fit_anfis(grid(), POINTS, TARGETS, solver="qr"), "unknown solver"),
        (lambda: fz.fit_anfis(grid(), POINTS, TARGETS, premise="batsh"), 'did you mean "batch"'),
        (
            lambda: fz.fit_anfis(grid(), POINTS, TARGETS, validation=(BAD, TARGETS)),
            "must be finite, got NaN",
        ),
        (lambda: fz.RecursiveLeastSquares(0), "unknowns must be at least 1"),
        (lambda: fz.RecursiveLeastSquares(2, forgetting=1.5), "forgetting factor"),
        (lambda: fz.RecursiveLeastSquares(2, covariance=[[1, 2], [0, 1]]), "symmetric"),
        (lambda: fz.RecursiveLeastSquares(2).update([1, np.nan], 1), "must be finite"),
        (lambda: fz.RecursiveLeastSquares(2).update([1, 1], [1, 2]), "targets of the row"),
        (lambda: fz.OnlineAnfis(grid()).learn([0, 0, 0], 1), "numbers in x"),
        (lambda: fz.OnlineAnfis(grid()).learn([0, 0], [1, 2]), "numbers in y"),
    ],
)
def test_what_cannot_be_fitted_is_refused_in_words(work, message):
    with pytest.raises(fz.FuzzyrsError, match=message):
        work()


def test_what_has_no_answer_has_a_documented_outcome():
    constant = np.c_[POINTS[:, 0], np.full(60, 0.25)]
    assert np.isfinite(fz.fit_anfis(grid(), constant, TARGETS, epochs=3).history["training"]).all()
    filled = fz.TSK(GAP.inputs, [0], no_rule_fires=2.0)
    fit = fz.fit_anfis(filled, [[1.0], [5.0]], [1, 3], premise="fixed")
    np.testing.assert_allclose(fit.history["training"], np.sqrt(0.5))
    with pytest.raises(TypeError, match="a TSK or a System"):
        fz.fit_anfis(3, POINTS, TARGETS)


@pytest.mark.parametrize("forgetting", [1.0, 0.97])
def test_recursive_least_squares_is_weighted_least_squares(forgetting):
    matrix, wanted = design(grid(order=0), POINTS), np.c_[TARGETS, -TARGETS]
    running = fz.RecursiveLeastSquares(9, 2, forgetting=forgetting, covariance=1e4)
    for row, target in zip(matrix, wanted, strict=True):
        running.update(row, target)
    weights = forgetting ** np.arange(59, -1, -1.0)
    normal = matrix.T @ (weights[:, None] * matrix) + forgetting**60 / 1e4 * np.eye(9)
    expected = np.linalg.solve(normal, matrix.T @ (weights[:, None] * wanted))
    np.testing.assert_allclose(running.solution, expected.T, atol=1e-6)
    np.testing.assert_allclose(running.covariance, np.linalg.inv(normal), rtol=1e-5, atol=1e-8)
    np.testing.assert_allclose(running.predict(matrix[0]), running.solution @ matrix[0])
    for again in (copy.copy(running), pickle.loads(pickle.dumps(running))):
        again.update(matrix[0], [0, 0])
        assert (again.solution != running.solution).any()


@pytest.mark.parametrize("system", [grid(), rules()], ids=["grid", "rules"])
def test_a_stream_is_followed_as_all_samples_are_fitted(system):
    wanted = TARGETS if isinstance(system, fz.TSK) else np.c_[TARGETS, -TARGETS]
    online = fz.OnlineAnfis(system, covariance=1e8)
    for point, target in zip(POINTS[:30], wanted[:30], strict=True):
        online.learn(point, target)
    online = pickle.loads(pickle.dumps(online))
    online.learn(POINTS[30:], wanted[30:])
    fit = fz.fit_anfis(system, POINTS, wanted, premise="fixed").system
    np.testing.assert_allclose(online.system(POINTS), fit(POINTS), atol=1e-4)


def test_the_estimator_is_as_scikit_learn_asks():
    from sklearn.utils.estimator_checks import check_estimator

    # Nothing is exempted; skipped are only checks that need packages which are not installed.
    results = check_estimator(ANFISRegressor(), on_skip=None)
    assert {result["status"] for result in results} <= {"passed", "skipped"}


def test_the_estimator_fits_several_outputs_streams_and_given_systems():
    wanted = np.c_[TARGETS, POINTS @ [1, -2]]
    both = ANFISRegressor(terms=4).fit(POINTS, wanted)
    assert isinstance(both.system_, fz.System)
    assert both.predict(POINTS).shape == (60, 2)
    assert both.score(POINTS, wanted) > 0.99
    one = ANFISRegressor(terms=4).fit(POINTS, TARGETS)
    np.testing.assert_allclose(one.predict(POINTS), both.predict(POINTS)[:, 0], atol=0.05)

    stream = ANFISRegressor(terms=3)
    for part in np.array_split(np.arange(60), 6):
        stream.partial_fit(POINTS[part], TARGETS[part])
    assert stream.score(POINTS, TARGETS) > 0.98
    assert stream.partial_fit(POINTS, TARGETS).system_ is not one.system_

    given = ANFISRegressor(rules(1), validation_fraction=0.2, patience=2, random_state=0)
    assert given.fit(POINTS, TARGETS).n_iter_ == len(given.history_["validation"])
    with pytest.raises(ValueError, match="validation_fraction"):
        ANFISRegressor(validation_fraction=2).fit(POINTS, TARGETS)
    wide = ANFISRegressor().fit(np.c_[POINTS, RANDOM.uniform(size=(60, 4))], TARGETS)
    assert len(wide.system_.strengths(np.zeros(6))) == 27
