"""Learners on tables: beside full sweeps in NumPy, on processes whose optimum is known."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fuzzyrs as fz
import oracle
from fuzzyrs import errors

NAN = float("nan")


def wander(states, actions, steps, seed):
    """Random steps through a table: state, action, reward and next state; None at an end."""
    rng = np.random.default_rng(seed)
    state = 0
    for step in range(steps):
        action = int(rng.integers(actions))
        follower = None if step % 40 == 39 else int(rng.integers(states))
        yield state, action, rng.uniform(-1, 1), follower
        state = 0 if follower is None else follower


@pytest.mark.parametrize("trace", ["replacing", "replacing_state", "accumulating"])
@pytest.mark.parametrize("cut", ["never", "watkins"])
@pytest.mark.parametrize(("discount", "trace_decay"), [(0.5, 0.3), (0.9, 0.7), (1.0, 1.0)])
def test_q_lambda_equals_the_full_sweep(trace, cut, discount, trace_decay):
    numbers = {"discount": discount, "trace_decay": trace_decay}
    learner = fz.QLambda(7, 4, trace=trace, cut=cut, first_value=0.25, **numbers)
    sweep = oracle.QTable(7, 4, **numbers, trace=trace, cut=cut)
    sweep.values[:] = 0.25
    for count, step in enumerate(wander(7, 4, 600, seed=4)):
        rate = 1 / (1 + learner.visits(*step[:2])) ** 0.7 / 5
        error = learner.learn(*step, rate)
        assert error == pytest.approx(sweep.learn(*step, rate), rel=1e-9, abs=1e-9)
        if count % 40 == 39:
            learner.clear_traces()
            sweep.traces[:] = 0
    np.testing.assert_allclose(learner.values, sweep.values, rtol=1e-8, atol=1e-9)


@pytest.mark.parametrize("counts", ["thesis", "exact"])
@pytest.mark.parametrize(("discount", "trace_decay"), [(0.5, 0.0), (0.9, 0.3), (0.9, 1.0)])
def test_model_building_equals_steps_1_to_11(counts, discount, trace_decay):
    numbers = {"discount": discount, "trace_decay": trace_decay}
    learner = fz.ModelBuildingQ(9, 3, counts=counts, first_value=1.5, **numbers)
    printed = oracle.ModelBuilding(9, 3, 1.5, counts=counts, **numbers)
    for step in wander(9, 3, 700, seed=2):
        learner.learn(*step, 0.3)
        printed.learn(*step, 0.3)
    np.testing.assert_allclose(learner.values, printed.q, rtol=0, atol=1e-9)
    np.testing.assert_allclose(learner.mean_rewards, printed.r, rtol=0, atol=1e-12)


def test_the_model_is_made_of_sample_means():
    learner = fz.ModelBuildingQ(4, 2)
    rewards = np.random.default_rng(0).normal(size=50)
    for count, reward in enumerate(rewards):
        learner.learn(1, 1, reward, [2, 3, 3][count % 3], 0.1)
    assert learner.mean_rewards[1, 1] == pytest.approx(rewards.mean(), abs=1e-14)
    assert learner.visits(1, 1) == 50
    # As a pair that is not the current one has them: n/(n + 1) in sum.
    np.testing.assert_allclose(learner.transitions(1, 1), [0, 0, 17 / 51, 33 / 51])
    assert learner.transitions(0, 0).sum() == 0


def test_optimistic_first_values_survive_only_exact_counts():
    left = {}
    for counts in ("thesis", "exact"):
        learner = fz.ModelBuildingQ(3, 2, counts=counts, first_value=5.0)
        for _ in range(40):
            learner.learn(0, 0, 0.0, 0, 1.0)
        left[counts] = learner.values[2, 1]
    assert left["exact"] == 5
    assert left["thesis"] < 0.1


def test_actor_critic_equals_the_printed_equations():
    learner = fz.ActorCritic(6, 3, discount=0.8, trace_decay=0.7, temperature=0.4)
    values, traces, preferences = np.zeros(6), np.zeros(6), np.zeros((6, 3))
    for state, action, reward, follower in wander(6, 3, 500, seed=1):
        error = reward + (0 if follower is None else 0.8 * values[follower]) - values[state]
        traces *= 0.56
        traces[state] = 1
        values += 0.2 * error * traces
        preferences[state, action] += 0.1 * error
        assert learner.learn(state, action, reward, follower, 0.2, 0.1) == pytest.approx(error)
    np.testing.assert_allclose(learner.values, values, atol=1e-10)
    np.testing.assert_allclose(learner.preferences, preferences, atol=1e-10)
    weights = np.exp(preferences[2] / 0.4)
    np.testing.assert_allclose(learner.probabilities(2), weights / weights.sum(), atol=1e-10)


def test_actor_critic_learns_the_optimal_policy_of_the_gridworld():
    mdp = fz.MDP.gridworld()
    learner = fz.ActorCritic(25, 4, discount=0.9, trace_decay=0.5, seed=3)
    walk = mdp.walk(0, seed=3)
    for _ in range(60_000):
        state = walk.state
        action = learner.choose(state)
        learner.learn(state, action, *walk.step(action), 0.1, 0.05)
    optimum, error = mdp.q_star(0.9)
    chosen = learner.preferences.argmax(axis=1)
    best = optimum[np.arange(25), chosen] >= optimum.max(axis=1) - 1e-6 - error
    assert best.sum() >= 20  # an action at random is best in 11 of 25 states


def frequencies(choose, count=20_000):
    return np.bincount([choose() for _ in range(count)], minlength=3) / count


def test_choices_follow_their_probabilities():
    learner = fz.QLambda(1, 3, seed=5)
    for action, value in enumerate([1.0, 1.0, 0.2]):
        learner.learn(0, action, value, None, 1.0)
    weights = np.exp(np.array([1.0, 1.0, 0.2]) / 0.5)
    margin = 5 * 0.5 / np.sqrt(20_000)
    drawn = frequencies(lambda: learner.choose(0, temperature=0.5))
    np.testing.assert_allclose(drawn, weights / weights.sum(), atol=margin)
    drawn = frequencies(lambda: learner.choose(0, 0.3, ties="random"))
    np.testing.assert_allclose(drawn, [0.45, 0.45, 0.1], atol=margin)
    assert {learner.choose(0) for _ in range(50)} == {0}
    assert {learner.choose(0, temperature=1e-300) for _ in range(50)} == {0, 1}


def value_iteration(mdp, discount, sweeps=2000):
    values = np.zeros((mdp.states, mdp.actions))
    for _ in range(sweeps):
        values = mdp.rewards + discount * mdp.transitions @ values.max(axis=1)
    return values


@pytest.mark.parametrize("mdp", [fz.MDP.garnet(20, 3, 5, seed=2), fz.MDP.gridworld(slip=0.2)])
def test_the_optimum_is_what_value_iteration_gives(mdp):
    values, error = mdp.q_star(0.95)
    assert 0 < error < 1e-9 * abs(values).max()
    assert abs(values - value_iteration(mdp, 0.95)).max() <= 2 * error


def test_the_gridworlds_values_are_the_textbooks():
    best = fz.MDP.gridworld().q_star(0.9)[0].max(axis=1).reshape(5, 5)
    assert best[0].round(1).tolist() == [22.0, 24.4, 22.0, 19.4, 17.5]
    assert best[4].round(1).tolist() == [14.4, 16.0, 14.4, 13.0, 11.7]


def test_walks_follow_the_process():
    mdp = fz.MDP([[[0.25, 0.75]], [[1, 0]]], [[2], [3]], reward_noise=0.5)
    walk = mdp.walk(seed=1)
    seen = []
    for _ in range(20_000):
        before = walk.state
        reward, after = walk.step(0)
        assert after == walk.state
        assert abs(reward - mdp.rewards[before, 0]) <= 0.5
        seen.append((before, reward, after))
    moved = [after for before, _, after in seen if before == 0]
    assert np.mean(moved) == pytest.approx(0.75, abs=5 * 0.433 / np.sqrt(len(moved)))
    rewards = [reward for before, reward, _ in seen if before == 0]
    assert np.mean(rewards) == pytest.approx(2, abs=5 * 0.289 / np.sqrt(len(rewards)))


processes = st.builds(
    fz.MDP.garnet,
    st.integers(3, 12),
    st.integers(1, 4),
    st.integers(1, 3),
    reward_noise=st.floats(0, 5),
    seed=st.integers(0, 2**64 - 1),
)


@settings(max_examples=60, deadline=None)
@given(
    processes,
    st.sampled_from(["thesis", "exact"]),
    st.floats(0, 0.98),
    st.floats(0, 1),
    st.floats(0, 1),
    st.tuples(st.floats(-9, 9), st.floats(0, 9)),
    st.integers(0, 99),
)
def test_model_building_never_breaks_its_bound(
    mdp, counts, discount, trace_decay, decay, first, seed
):
    trial = fz.learn_mdp(
        mdp,
        counts=counts,
        discount=discount,
        trace_decay=trace_decay,
        learning_rate_decay=decay,
        first_values=(first[0], first[0] + first[1]),
        checkpoints=[1, 10, 400],
        seed=seed,
    )
    assert trial.violations["used"] == 0
    assert trial.closest["used"] <= 1 + 1e-9
    assert (trial.largest <= trial.bounds * (1 + 1e-9)).all()
    assert abs(trial.values).max() == trial.largest[-1]
    assert abs(trial.values - trial.optimum).max() == trial.errors[-1]


@settings(max_examples=40, deadline=None)
@given(processes, st.floats(0, 0.98))
def test_the_optimum_satisfies_its_equation(mdp, discount):
    values, error = mdp.q_star(discount)
    right = mdp.rewards + discount * mdp.transitions @ values.max(axis=1)
    assert abs(values - right).max() <= 2 * error + 1e-15


def test_a_trial_is_the_same_by_hand():
    mdp = fz.MDP.garnet(8, 2, 3, seed=6)
    trial = fz.learn_mdp(mdp, exploration=0.0, checkpoints=[1, 300], first_values=(2, 2))
    # Greedy without noise: what is visited depends on the process alone, whose steps are drawn.
    again = fz.learn_mdp(mdp, exploration=0.0, checkpoints=[300], first_values=(2, 2))
    assert trial.values.tolist() == again.values.tolist()
    assert trial.checkpoints == [1, 300]
    other = fz.learn_mdp(mdp, exploration=0.0, checkpoints=[300], first_values=(2, 2), seed=1)
    assert trial.values.tolist() != other.values.tolist()


def test_a_deterministic_trial_equals_the_oracle():
    # One action and one successor each: no chance but the first state.
    ring = np.zeros((5, 1, 5))
    ring[np.arange(5), 0, (np.arange(5) + 1) % 5] = 1
    mdp = fz.MDP(ring, np.arange(5.0)[:, None])
    trial = fz.learn_mdp(mdp, learning_rate_decay=0.5, checkpoints=[1, 200])
    possible = []
    for start in range(5):
        printed = oracle.ModelBuilding(5, 1, 0.0, counts="thesis", discount=0.9, trace_decay=0.9)
        for step in range(200):
            state = (start + step) % 5
            rate = (1 + step // 5) ** -0.5
            printed.learn(state, 0, float(state), (state + 1) % 5, rate)
        possible.append(printed.q)
    assert min(abs(trial.values - q).max() for q in possible) < 1e-9


def test_values_beyond_all_numbers_are_reported():
    mdp = fz.MDP.garnet(20, 3, 5, seed=1)
    steps = [1000, 10_000, 60_000]
    trial = fz.learn_mdp(mdp, "q_lambda", learning_rate_decay=0.0, checkpoints=steps)
    assert 1000 < trial.diverged_at < 60_000
    assert np.isfinite(trial.errors[0])
    assert trial.errors[-1] == trial.largest[-1] == np.inf
    assert np.isfinite(trial.values).all()
    learner = fz.QLambda(2, 2)
    with pytest.raises(errors.DivergedError, match="learning diverged"):
        learner.learn(0, 0, 1e300, None, 1.0)


def test_trials_tell_progress_and_stop():
    told = []
    fz.learn_mdp(fz.MDP.gridworld(), checkpoints=[5000], progress=told.append)
    assert told[-1] == 5000
    control = fz.Control()
    control.cancel()
    with pytest.raises(errors.CancelledError):
        fz.learn_mdp(fz.MDP.gridworld(), control=control)


ROW = [[[1.0]]]
BAD_INPUT = [
    (lambda: fz.MDP([[[0.5, 0.4]], [[0, 1]]], [[0], [0]]), "state 0, action 0: sum of the trans"),
    (lambda: fz.MDP([[[1.5, -0.5]], [[0, 1]]], [[0], [0]]), "probability must be between 0 and 1"),
    (lambda: fz.MDP([[[NAN, 1]], [[0, 1]]], [[0], [0]]), "transition probability must be finite"),
    (lambda: fz.MDP([[1.0]], [[0]]), "an array of shape (states, actions, states)"),
    (lambda: fz.MDP([[[1.0, 0.0]]], [[0]]), "expected an array of shape (1, 1, 1)"),
    (lambda: fz.MDP(ROW, [0.0]), "rewards: expected an array of shape (1, 1)"),
    (lambda: fz.MDP(ROW, [[NAN]]), "mean rewards[0] must be finite"),
    (lambda: fz.MDP(ROW, [[0]], reward_noise=-1), "reward noise must be zero or more"),
    (lambda: fz.MDP(np.zeros((0, 1, 0)), np.zeros((0, 1))), "number of states must be at least 1"),
    (lambda: fz.MDP.garnet(3, 2, 4), "branching must be at most the number of states"),
    (lambda: fz.MDP.gridworld(slip=2), "slip must be between 0 and 1"),
    (lambda: fz.MDP(ROW, [[1]]).q_star(1.0), "discount must be from 0 to below 1"),
    (lambda: fz.MDP(ROW, [[1]]).q_star(0.9, tolerance=1e-20), "ask for a larger tolerance"),
    (lambda: fz.MDP(ROW, [[1]]).walk(1), "state must be below 1"),
    (lambda: fz.MDP(ROW, [[1]]).walk().step(1), "action must be below 1"),
    (lambda: fz.QLambda(2, 2, discount=1.1), "discount must be between 0 and 1"),
    (lambda: fz.QLambda(2, 2, trace_decay=NAN), "trace decay must be finite"),
    (lambda: fz.QLambda(2, 2, first_value=NAN), "first values[0] must be finite"),
    (lambda: fz.QLambda(2, 2, cut="watkin"), 'did you mean "watkins"?'),
    (lambda: fz.QLambda(2, 2, trace="accumulate"), "unknown trace"),
    (lambda: fz.QLambda(2, 2).choose(0, temperature=0.0), "temperature must be positive"),
    (lambda: fz.QLambda(2, 2).choose(0, 0.1, temperature=1.0), "leave one of the two out"),
    (lambda: fz.QLambda(2, 2).choose(0, ties="last"), "way to break ties"),
    (lambda: fz.QLambda(2, 2).visits(2, 0), "state must be below 2"),
    (lambda: fz.ModelBuildingQ(2, 2, counts="exakt"), 'did you mean "exact"?'),
    (lambda: fz.ModelBuildingQ(2, 2, trace_decay=-0.1), "trace decay must be between 0 and 1"),
    (lambda: fz.ModelBuildingQ(2, 2).learn(0, 0, NAN, 1, 0.1), "reward must be finite"),
    (lambda: fz.ModelBuildingQ(2, 2).learn(0, 2, 0, 1, 0.1), "action must be below 2"),
    (lambda: fz.ModelBuildingQ(2, 2).learn(0, 0, 0, 1, 1.1), "learning rate must be between"),
    (lambda: fz.ModelBuildingQ(2**20, 2**11), "the model would need 2147483648 × 131072 numbers"),
    (lambda: fz.ActorCritic(2, 2, temperature=0), "temperature must be positive"),
    (lambda: fz.ActorCritic(2, 2).learn(0, 0, NAN, 1, 0.1, 0.1), "reward must be finite"),
    (lambda: fz.ActorCritic(2, 2).learn(0, 0, 0, 1, 0.1, 2), "learning rate of the actor must be"),
    (lambda: fz.learn_mdp(fz.MDP(ROW, [[1]]), "sarsa"), "unknown learner"),
    (lambda: fz.learn_mdp(fz.MDP(ROW, [[1]]), checkpoints=[5, 4]), "each later than the one"),
    (lambda: fz.learn_mdp(fz.MDP(ROW, [[1]]), checkpoints=[]), "number of checkpoints must be"),
    (lambda: fz.learn_mdp(fz.MDP(ROW, [[1]]), discount=1), "discount must be from 0 to below 1"),
    (lambda: fz.learn_mdp(fz.MDP(ROW, [[1]]), learning_rate=1.5), "learning rate must be between"),
    (lambda: fz.learn_mdp(fz.MDP(ROW, [[1]]), per="visits"), 'did you mean "visit"?'),
    (lambda: fz.learn_mdp(fz.MDP(ROW, [[1]]), per="episode", episode=0), "steps of an episode"),
]


@pytest.mark.parametrize(("call", "words"), BAD_INPUT, ids=[words[:40] for _, words in BAD_INPUT])
def test_bad_input_is_refused_in_the_users_words(call, words):
    with pytest.raises(errors.FuzzyrsError, match=re.escape(words)):
        call()


def test_a_failed_step_leaves_no_trace():
    learner = fz.ModelBuildingQ(3, 2, counts="exact")
    learner.learn(0, 0, 1.0, 1, 0.5)
    before = learner.values
    with pytest.raises(errors.InvalidValueError):
        learner.learn(1, 1, NAN, 0, 0.5)
    np.testing.assert_array_equal(learner.values, before)
    assert learner.visits(1, 1) == 0
