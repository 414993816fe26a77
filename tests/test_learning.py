"""Learners on problems of the user's own, and the techniques that learn to pursue."""

from __future__ import annotations

import numpy as np
import pytest

import fuzzyrs as fz
import oracle

FEW_GAMES = fz.QLambdaTraining(episodes=30)
SMALL = fz.GeneticPhase(iterations=6, population=20)
TECHNIQUES = {
    "q_lambda": FEW_GAMES,
    "reward_ga": fz.RewardGaTraining(genetic=SMALL),
    "qlbgflc": fz.QlbgflcTraining(
        phase_1=FEW_GAMES, stage_1=SMALL, stage_2=fz.GeneticPhase(iterations=6, population=10)
    ),
}
each = pytest.mark.parametrize("settings", TECHNIQUES.values(), ids=TECHNIQUES)


def numbers(controller):
    """The numbers that a controller consists of."""
    is_table = isinstance(controller, fz.TableController)
    return controller.angles if is_table else controller.system.parameters


def sphere(population):
    return ((population - 0.3) ** 2).sum(axis=1)


def test_a_genetic_search_asks_and_is_told():
    search = fz.Genetic([(-1, 1), (0, 2), (0.3, 0.3)], population=20, seed=5)
    assert search.best is None
    assert search.generation == 0
    first = search.ask()
    assert first.shape == (20, 3)
    assert (first >= [-1, 0, 0.3]).all()
    assert (first <= [1, 2, 0.3]).all()
    np.testing.assert_array_equal(search.ask(), first)
    fitness = sphere(first)
    search.tell(fitness)
    genes, value = search.best
    assert value == fitness.min()
    np.testing.assert_array_equal(genes, first[fitness.argmin()])
    assert search.generation == 1


@pytest.mark.parametrize("seed", range(10))
def test_a_generation_is_elite_children_and_newcomers(seed):
    search = fz.Genetic(
        [(0, 1)] * 4,
        population=10,
        elite=4,
        immigrants=2,
        selection=fz.Selection.pairs(),
        crossover=fz.Crossover.one_point(),
        mutation=fz.Mutation.none(),
        seed=seed,
    )
    first = search.ask()
    ranked = first[np.argsort(sphere(first))]
    search.tell(sphere(first))
    second = search.ask()
    np.testing.assert_array_equal(second[:4], ranked[:4])
    for pair in range(2):
        parents, children = ranked[2 * pair :][:2], second[4 + 2 * pair :][:2]
        cuts = [
            cut
            for cut in (1, 2, 3)
            if np.array_equal(children[0], [*parents[0][:cut], *parents[1][cut:]])
            and np.array_equal(children[1], [*parents[1][:cut], *parents[0][cut:]])
        ]
        assert len(cuts) == 1
    assert not np.isin(second[8:], first).any()


def test_the_best_of_a_search_never_gets_worse():
    search = fz.Genetic([(-1, 1)] * 3, seed=2)
    best = []
    for _ in range(200):
        search.tell(sphere(search.ask()))
        best.append(search.best[1])
    assert best == sorted(best, reverse=True)
    assert best[-1] < 0.01 < best[0]


def test_a_fitness_that_is_not_a_number_never_wins():
    search = fz.Genetic([(0, 1)], population=4, seed=0)
    search.tell([np.nan, 2.0, np.nan, 3.0])
    assert search.best[1] == 2.0
    search.tell([np.nan] * 4)
    assert search.leader is None
    assert search.best[1] == 2.0


def test_a_search_may_start_from_known_vectors():
    search = fz.Genetic([(0, 1)] * 2, seed=0)
    search.start_from([[0.25, 0.5], [0.1, 0.2]])
    assert search.ask()[:2].tolist() == [[0.25, 0.5], [0.1, 0.2]]


def test_a_plane_is_fitted_by_a_genetic_search():
    rng = np.random.default_rng(0)
    points = rng.uniform(-1, 1, (80, 2))
    targets = points @ [1.0, -0.5]
    inputs = [fz.Variable.evenly(name, (-1, 1), "NZP") for name in "xy"]
    start = fz.TSK(inputs, np.zeros((3, 3)))
    fitted, history = fz.fit_genetic(start, points, targets, generations=150, seed=1)
    assert history.shape == (150,)
    assert (np.diff(history) <= 0).all()
    error = np.mean((fitted(points) - targets) ** 2)
    assert history[-1] == pytest.approx(error, rel=1e-12)
    assert error < 0.5 * np.mean(targets**2)
    again, _ = fz.fit_genetic(start, points, targets, generations=150, seed=1)
    other, _ = fz.fit_genetic(start, points, targets, generations=150, seed=2)
    assert again == fitted != other


def test_a_fit_stays_within_its_bounds_and_begins_at_the_system(steer):
    points = np.random.default_rng(0).uniform(-1, 1, (30, 2))
    bounds = np.column_stack([steer.parameters, steer.parameters])
    bounds[20] = [0.4, 0.6]
    fitted, history = fz.fit_genetic(steer, points, steer(points), bounds=bounds, generations=3)
    assert history[0] == 0.0
    np.testing.assert_array_equal(fitted.parameters, steer.parameters)
    fitted, _ = fz.fit_genetic(steer, points, points[:, 0], bounds=bounds, generations=30)
    np.testing.assert_array_equal(fitted.parameters[:20], steer.parameters[:20])
    assert 0.4 <= fitted.parameters[20] <= 0.6


@pytest.mark.parametrize("trace", ["replacing", "replacing_state"])
@pytest.mark.parametrize(("discount", "trace_decay"), [(0.5, 0.3), (0.9, 0.5), (1.0, 0.0)])
def test_live_traces_equal_the_full_sweep(trace, discount, trace_decay):
    settings = {"discount": discount, "trace_decay": trace_decay}
    learner = fz.QLambda(13, 5, trace=trace, seed=3, **settings)
    sweep = oracle.QTable(13, 5, **settings, trace=trace)
    rng = np.random.default_rng(4)
    state = 0
    for step in range(3000):
        action = learner.choose(state, exploration=0.5)
        reward = rng.uniform(-1, 1)
        ended = step % 50 == 49
        follower = None if ended else int(rng.integers(13))
        error = learner.learn(state, action, reward, follower, 0.2)
        expected = sweep.learn(state, action, reward, follower, 0.2)
        assert error == pytest.approx(expected, abs=1e-9)
        state = 0 if follower is None else follower
        if step == 1500:
            learner.clear_traces()
            sweep.traces[:] = 0.0
    np.testing.assert_allclose(learner.values, sweep.values, rtol=0, atol=1e-9)
    assert learner.values.any()


def test_greedy_choices_take_the_first_of_the_best():
    learner = fz.QLambda(2, 3)
    assert learner.greedy_action(0) == 0
    learner.learn(0, 2, 1.0, None, 0.5)
    assert [learner.greedy_action(0), learner.choose(0), learner.greedy_action(1)] == [2, 2, 0]
    chosen = [learner.choose(0, exploration=1.0) for _ in range(300)]
    assert set(chosen) == {0, 1, 2}


def test_grids_round_to_the_nearest_point():
    grid = fz.Discretiser([(-1, 1, 11), (0, 3, 4)])
    assert grid.states == 44
    for state in range(grid.states):
        assert grid.state(grid.centre(state)) == state
    assert grid.centre(5).tolist() == [-0.8, 1.0]
    assert grid.state([-0.71, 0.49]) == 4
    assert grid.state([-99, 99]) == 3


@each
def test_a_technique_learns_a_pursuer(game, settings):
    trained = fz.train(game, settings, seed=1)
    assert numbers(trained.controller).any()
    played = game.play(trained.controller, evader_start=(2, 4))
    assert np.isfinite(played.distance).all()
    assert all(len(values) for values in trained.history.values())


@each
def test_the_seed_decides_what_is_learned(game, settings):
    first, again, other = (fz.train(game, settings, seed=seed) for seed in (7, 7, 8))
    assert numbers(first.controller).tobytes() == numbers(again.controller).tobytes()
    assert numbers(first.controller).tobytes() != numbers(other.controller).tobytes()
    assert first.learning_time == again.learning_time
    for phase, values in first.history.items():
        np.testing.assert_array_equal(values, again.history[phase])


@each
def test_learning_depends_on_how_the_evader_steers(game, steer, settings):
    classical, fuzzy = (
        np.concatenate(list(fz.train(game, settings, evader=evader).history.values()))
        for evader in ["classical", fz.FuzzyController(steer)]
    )
    assert classical.tobytes() != fuzzy.tobytes()


def test_the_learning_time_is_the_time_that_the_robots_played(game):
    trained = fz.train(game, FEW_GAMES, seed=3)
    durations = trained.history["duration of the games [s]"]
    assert len(durations) == 30
    assert trained.learning_time == pytest.approx(durations.sum(), rel=1e-12)
    # From 50 m away nobody is caught in 5 steps, so every game lasts 0.5 s.
    far = {"starts": [(50, 50)], "steps": 5}
    twelve = fz.QLambdaTraining(episodes=12, **far)
    tuning = fz.GeneticPhase(iterations=4, population=10)
    both = fz.QlbgflcTraining(phase_1=twelve, stage_1=SMALL, stage_2=tuning, **far)
    search = fz.RewardGaTraining(genetic=SMALL, **far)
    for settings, count in [(twelve, 12), (search, 6 * 20), (both, 12 + 4 * 10)]:
        assert fz.train(game, settings).learning_time == pytest.approx(0.5 * count, rel=1e-12)


def test_a_learned_table_has_only_the_actions_of_the_settings(game):
    trained = fz.train(game, fz.QLambdaTraining(episodes=20, points=5, actions=3), seed=0)
    table = trained.controller
    assert table.states == fz.Discretiser([(-1, 1, 5), (-1, 1, 5)])
    assert set(table.angles) <= {-0.5, 0.0, 0.5}


def test_the_genes_of_a_tuned_pursuer_lie_in_their_ranges(game):
    ranges = fz.GeneRanges(width=(0.3, 0.4), mean=(-0.2, 0.2), consequent=(0.1, 0.2))
    settings = fz.RewardGaTraining(genetic=SMALL, ranges=ranges)
    controller = fz.train(game, settings).controller
    gaussians = [t.parameters for v in controller.system.inputs for t in v.terms.values()]
    assert all(0.3 <= g["width"] <= 0.4 and -0.2 <= g["mean"] <= 0.2 for g in gaussians)
    assert (controller.system.consequents >= 0.1).all()
    assert (controller.system.consequents <= 0.2).all()
    assert (controller.angle_limit, controller.rate_limit) == (1.0, 1.0)


def test_defaults_are_the_thesis_values():
    q, ga, both = fz.QLambdaTraining(), fz.RewardGaTraining(), fz.QlbgflcTraining()
    assert (q.episodes, q.steps, q.discount, q.trace_decay) == (1000, 6000, 0.5, 0.3)
    assert (q.learning_rate, q.learning_rate_decay, q.exploration) == (1.0, 0.7, 0.1)
    assert (q.points, q.actions, len(q.starts)) == (11, 11, 64)
    assert ga.genetic == fz.GeneticPhase(
        iterations=1000, population=40, crossover=0.2, mutation=0.1
    )
    assert (both.phase_1.episodes, both.steps, ga.steps) == (200, 300, 300)
    assert (both.stage_1.iterations, both.stage_1.population) == (800, 40)
    assert (both.stage_2.iterations, both.stage_2.population) == (200, 10)
