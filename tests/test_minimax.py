"""Matrix games and minimax-Q(λ): against a linear programme and plain NumPy."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.optimize import linprog

import fuzzyrs as fz


def value_by_linprog(payoffs):
    """max v subject to x'A >= v, the probabilities x summing to 1."""
    rows, columns = payoffs.shape
    found = linprog(
        [0.0] * rows + [-1.0],
        A_ub=np.hstack([-payoffs.T, np.ones((columns, 1))]),
        b_ub=np.zeros(columns),
        A_eq=[[1.0] * rows + [0.0]],
        b_eq=[1.0],
        bounds=[(0, None)] * rows + [(None, None)],
        method="highs",
    )
    assert found.success
    return -found.fun


def check_solution(payoffs):
    value, rows, columns = fz.solve_matrix_game(payoffs)
    for strategy in (rows, columns):
        assert (strategy >= 0).all()
        assert strategy.sum() == pytest.approx(1, abs=1e-12)
    secured, conceded = (rows @ payoffs).min(), (payoffs @ columns).max()
    margin = 1.01e-9 * np.ptp(payoffs) + 1e-14 * abs(payoffs).max()
    assert conceded - secured <= margin
    assert abs(value - (secured + conceded) / 2) <= margin
    return value


SIZES = st.tuples(st.integers(1, 12), st.integers(1, 22))


@given(SIZES.flatmap(lambda size: arrays(float, size, elements=st.floats(-10, 10))))
def test_matrix_games_have_the_value_of_the_linear_programme(payoffs):
    assert check_solution(payoffs) == pytest.approx(value_by_linprog(payoffs), abs=1e-6)


@given(SIZES.flatmap(lambda size: arrays(float, size, elements=st.integers(-1, 1))))
def test_so_have_games_that_are_full_of_ties(payoffs):
    assert check_solution(payoffs) == pytest.approx(value_by_linprog(payoffs), abs=1e-7)


def test_a_game_as_large_as_the_thesis_has():
    payoffs = np.random.default_rng(3).normal(size=(11, 21))
    assert check_solution(payoffs) == pytest.approx(value_by_linprog(payoffs), abs=1e-9)


@pytest.mark.parametrize(
    ("payoffs", "message"),
    [
        ([1, 2], r"payoffs: expected an array of shape \(rows, columns\)"),
        (np.zeros((0, 3)), "rows of a matrix game must be at least 1"),
        (np.zeros((3, 0)), "columns of a matrix game must be at least 1"),
        ([[1, np.nan]], r"payoffs\[1\] must be finite"),
        ([[1e308, -1e308]], "range of the payoffs must be finite"),
        ([["a"]], "payoffs must be real numbers"),
    ],
)
def test_what_is_no_matrix_game_is_refused(payoffs, message):
    with pytest.raises(fz.errors.FuzzyrsError, match=message):
        fz.solve_matrix_game(payoffs)


class FullSweep:
    """(8.1) with the traces of (2.47) and (2.48), over the whole table."""

    def __init__(self, states, actions, opponent_actions, discount, trace_decay, play):
        self.values = np.zeros((states, actions, opponent_actions))
        self.traces = np.zeros_like(self.values)
        self.discount, self.trace_decay, self.play = discount, trace_decay, play

    def value(self, state):
        payoffs = self.values[state]
        return value_by_linprog(payoffs) if self.play == "mixed" else payoffs.min(axis=1).max()

    def learn(self, state, action, other, reward, following, rate):
        ahead = 0.0 if following is None else self.value(following)
        error = reward + self.discount * ahead - self.values[state, action, other]
        self.traces *= self.discount * self.trace_decay
        self.traces[state] = 0
        self.traces[state, action, other] = 1
        self.values += rate * error * self.traces
        return error


@pytest.mark.parametrize("play", ["answer", "security", "mixed"])
def test_learning_is_that_of_the_equations(play):
    rng = np.random.default_rng(1)
    settings = {"discount": 0.8, "trace_decay": 0.6, "play": play}
    learner = fz.MinimaxQ(5, 3, 4, seed=2, **settings)
    sweep = FullSweep(5, 3, 4, **settings)
    state = 0
    for step in range(300 if play == "mixed" else 2000):
        own, other = learner.choose(state, exploration=0.4)
        following = None if step % 50 == 49 else int(rng.integers(5))
        reward = float(rng.normal())
        error = learner.learn(state, own, other, reward, following, 0.2)
        expected = sweep.learn(state, own, other, reward, following, 0.2)
        assert error == pytest.approx(expected, abs=1e-7)
        state = int(rng.integers(5)) if following is None else following
    np.testing.assert_allclose(learner.values, sweep.values, atol=1e-7)
    for state in range(5):
        assert learner.value(state) == pytest.approx(sweep.value(state), abs=1e-7)


def test_choices_without_exploration_are_those_of_the_readings():
    learner = fz.MinimaxQ(1, 2, 2, discount=0, trace_decay=0, play="answer")
    security = fz.MinimaxQ(1, 2, 2, discount=0, trace_decay=0, play="security")
    for one in (learner, security):
        for (own, other), payoff in np.ndenumerate([[1.0, 2.0], [3.0, 0.0]]):
            one.learn(0, own, other, payoff, None, 1)
            assert one.visits(0, own, other) == 1
    assert learner.choose(0) == (0, 0)
    assert security.choose(0) == (0, 1)
    assert learner.strategies(0)[1].tolist() == [1, 0]
    assert security.strategies(0)[1].tolist() == [0, 1]


def test_a_markov_game_is_learned_to_its_value():
    """Values by Shapley's iteration; four states, which joint actions lead between."""
    rng = np.random.default_rng(7)
    rewards, following = rng.normal(size=(4, 3, 3)), rng.integers(4, size=(4, 3, 3))
    values = np.zeros(4)
    for _ in range(60):
        values = np.array(
            [value_by_linprog(r + 0.6 * values[f]) for r, f in zip(rewards, following, strict=True)]
        )
    learner = fz.MinimaxQ(4, 3, 3, discount=0.6, trace_decay=0, seed=1)
    state = 0
    for _ in range(20_000):
        own, other = learner.choose(state, exploration=1.0)
        rate = 1 / (1 + learner.visits(state, own, other)) ** 0.6
        reached = int(following[state, own, other])
        learner.learn(state, own, other, rewards[state, own, other], reached, rate)
        state = reached
    np.testing.assert_allclose([learner.value(s) for s in range(4)], values, atol=1e-3)


def test_any_number_of_players_learn_independently():
    """Three players are rewarded if they all choose alike."""
    players = [fz.QLambda(1, 2, discount=0, trace_decay=0, seed=seed) for seed in range(3)]
    for game in range(1, 500):
        chosen = [player.choose(0, 1 / game**0.5, ties="random") for player in players]
        reward = float(len(set(chosen)) == 1)
        for player, action in zip(players, chosen, strict=True):
            player.learn(0, action, reward, None, 0.1)
    assert len({player.greedy_action(0) for player in players}) == 1


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda _: fz.MinimaxQ(0, 2, 2), "number of states must be at least 1"),
        (lambda _: fz.MinimaxQ(2, 0, 2), "number of actions must be at least 1"),
        (lambda _: fz.MinimaxQ(2, 2, 0), "number of the opponent's actions must be at least 1"),
        (lambda _: fz.MinimaxQ(2**40, 2**20, 2**20), "size of the table"),
        (lambda _: fz.MinimaxQ(2, 2, 2, discount=1.5), "discount must be between 0 and 1"),
        (lambda _: fz.MinimaxQ(2, 2, 2, play="pure"), 'unknown way to play "pure"'),
        (lambda learner: learner.choose(2), "state must be below 2"),
        (lambda learner: learner.choose(0, 1.5), "exploration rate must be between 0 and 1"),
        (lambda learner: learner.learn(0, 0, 3, 0.0, None, 0.1), "opponent_action must be below 3"),
        (lambda learner: learner.learn(0, 2, 0, 0.0, None, 0.1), "action must be below 2"),
        (lambda learner: learner.learn(0, 0, 0, 0.0, 2, 0.1), "next_state must be below 2"),
        (lambda learner: learner.learn(0, 0, 0, np.nan, 1, 0.1), "reward must be finite"),
        (lambda learner: learner.learn(0, 0, 0, 1e300, 1, 1.0), "a learning step"),
        (lambda learner: learner.learn(0, 0, 0, 1.0, 1, 2.0), "learning rate must be between"),
        (lambda learner: learner.value(5), "state must be below 2"),
        (lambda learner: learner.strategies(5), "state must be below 2"),
    ],
)
def test_bad_input_is_refused_and_changes_nothing(call, message):
    learner = fz.MinimaxQ(2, 2, 3)
    with pytest.raises(fz.errors.FuzzyrsError, match=message):
        call(learner)
    assert (learner.values == 0).all()


GRID = fz.Discretiser([(-1, 1, 11), (-1, 1, 11)])


def test_a_mixed_strategy_is_a_pure_function_of_what_is_seen(game):
    rng = np.random.default_rng(0)
    coin = fz.MixedTableController(GRID, [-1, 0, 1], rng.dirichlet([1, 1, 1], 121), seed=3)
    starts = rng.uniform(-9, 9, (40, 2))
    many = game.play_many("classical", coin, evader_starts=starts, max_time=30)
    alone = [game.play("classical", coin, evader_start=start, max_time=30) for start in starts]
    assert many.duration.tolist() == [path.duration for path in alone]
    assert len({u for path in alone for u in path.evader_steering}) == 3
    other = fz.MixedTableController(GRID, coin.angles, coin.probabilities, seed=4)
    again = game.play("classical", other, evader_start=starts[0], max_time=30)
    assert (again.evader_steering[:20] != alone[0].evader_steering[:20]).any()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((GRID, [0, 1], [[0.5, 0.6]] * 121), "sum of the probabilities in state 0 must be 1"),
        ((GRID, [0, 1], [[1.5, -0.5]] * 121), "probability in state 0 must be between 0 and 1"),
        ((GRID, [0, 1], [[0.5, 0.5]] * 120), "probabilities of all states: expected 242, got 240"),
        ((GRID, [0, 1], [[1.0]] * 121), r"probabilities: expected an array of shape \(n, 2\)"),
        ((GRID, [0, np.inf], [[0.5, 0.5]] * 121), "must be finite"),
        ((fz.Discretiser([(0, 1, 2)]), [0], [[1], [1]]), "reads 2 inputs"),
    ],
)
def test_what_is_no_mixed_strategy_is_refused(arguments, message):
    with pytest.raises(fz.errors.FuzzyrsError, match=message):
        fz.MixedTableController(*arguments)


SMALL = fz.MinimaxQTraining(episodes=30, steps=600)


def test_both_robots_learn_one_table(game):
    trained = fz.train(game, SMALL, evader=SMALL, seed=1)
    again = fz.train(game, SMALL, evader=SMALL, seed=1)
    other = fz.train(game, SMALL, evader=SMALL, seed=2)
    assert trained.controller == again.controller != other.controller
    assert trained.evader == again.evader != other.evader
    assert trained.controller.probabilities.shape == (121, 11)
    assert trained.evader.probabilities.shape == (121, 21)
    assert trained.evader.angles == pytest.approx(np.linspace(-1, 1, 21))
    # Pure readings: a state's probabilities are those of a tie, equal and few.
    shares = trained.controller.probabilities
    assert all(len(set(row[row > 0])) == 1 for row in shares)


def test_rewards_telescope(game):
    trained = fz.train(game, SMALL, evader=SMALL, seed=1)
    durations = trained.history["duration of the games [s]"]
    rewards = trained.history["pursuer's total reward in the games"]
    starts = {round(float(np.hypot(*start)) / 0.3, 6) for start in SMALL.starts}
    caught = durations < 59.95
    assert 0 < caught.sum() < 30
    for reward in rewards[caught]:
        # What is left at the capture is less than the radius.
        assert any(-1e-6 <= first - reward < 0.1 / 0.3 for first in starts)
    path = game.play("classical", trained.evader, evader_start=(2, 4))
    apart = (path.distance[0] - path.distance[-1]) / 0.3
    assert path.reward.sum() == pytest.approx(apart, abs=1e-9)


def test_a_given_evader_is_learned_from(game):
    trained = fz.train(game, fz.MinimaxQTraining(episodes=100, play="security"), seed=1)
    assert trained.evader is None
    starts = [(-6, 7), (-7, -7), (2, 4), (3, -8)]
    played = game.play_many(trained.controller, evader_starts=starts, max_time=120)
    assert played.captured.all()


def test_mixed_strategies_are_learned(game):
    settings = fz.MinimaxQTraining(episodes=20, steps=600, play="mixed")
    trained = fz.train(game, settings, evader=settings, seed=1)
    shares = trained.controller.probabilities
    np.testing.assert_allclose(shares.sum(axis=1), 1, atol=1e-12)
    assert (shares.max(axis=1) < 0.99).any()


def test_settings_that_do_not_fit_are_refused(game):
    other = fz.MinimaxQTraining(episodes=31, steps=600)
    with pytest.raises(fz.errors.FuzzyrsError, match="one table for both robots; give both"):
        fz.train(game, SMALL, evader=other)
    for bad, message in [
        ({"episodes": 0}, "episodes must be at least 1"),
        ({"actions": 1}, "actions must be at least 2"),
        ({"evader_actions": 1}, "actions of the evader must be at least 2"),
        ({"learning_rate": 0.0}, "learning rate must be above 0"),
        ({"exploration": 1.5}, "exploration rate must be"),
        ({"starts": np.zeros((0, 2))}, "number of starting positions"),
        ({"play": "pure"}, "way to play"),
    ]:
        with pytest.raises(fz.errors.FuzzyrsError, match=message):
            fz.train(game, fz.MinimaxQTraining(**bad))
