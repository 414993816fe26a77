"""Learning in environments of the user's own."""

from __future__ import annotations

import json

import numpy as np
import pytest

import fuzzyrs as fz


class Box:
    def __init__(self, low, high, dtype=np.float64):
        self.low, self.high = np.array(low, dtype=float), np.array(high, dtype=float)
        self.shape, self.dtype = self.low.shape, np.dtype(dtype)


class Discrete:
    def __init__(self, n, start=0):
        self.n, self.start = n, start


class Line:
    """A point is to come near 0; an episode ends there, or after 40 steps."""

    def __init__(self, discrete=False, start=0):
        self.observation_space = Box([-1], [1])
        self.action_space = Discrete(3, start) if discrete else Box([-0.2], [0.2])
        self.discrete, self.start = discrete, start
        self.seeds, self.actions, self.after = [], [], {}

    def reset(self, *, seed=None):
        self.seeds.append(seed)
        self.rng = np.random.default_rng(seed)
        self.x, self.steps = self.rng.uniform(-1, 1), 0
        return np.array([self.x]), {}

    def step(self, action):
        self.actions.append(action)
        self.steps += 1
        if len(self.actions) in self.after:
            return self.after[len(self.actions)](self)
        move = (action - self.start - 1) * 0.2 if self.discrete else action[0]
        before = self.x
        self.x = float(np.clip(self.x + move + 0.02 * self.rng.normal(), -1, 1))
        reached = abs(self.x) < 0.1
        over = self.steps == 40 and not reached
        return np.array([self.x]), abs(before) - abs(self.x) - 0.01, reached, over, {}


NAMES = ["qlfis", "fuzzy_actor_critic", "neural_actor_critic", "q_lambda"]


@pytest.mark.parametrize("agent", ["qlfis", "fuzzy_actor_critic", "q_lambda"])
def test_agents_learn_to_come_to_the_middle(agent):
    env = Line()
    learned = fz.fit(env, agent, episodes=200, seed=2)
    assert len(learned.returns) == len(learned.lengths) == 200
    assert learned.lengths[-20:].mean() < 12 < learned.lengths[:5].mean()
    assert learned.policy([0.8])[0] < 0 < learned.policy([-0.8])[0]
    numbers, returns = learned.evaluations
    assert (numbers == np.arange(10, 201, 10)).all()
    assert learned.best_evaluation == returns.max()
    actions = np.array(env.actions)
    assert np.abs(actions).max() <= 0.2


def test_what_is_learned_is_an_ordinary_system(tmp_path):
    learned = fz.fit(Line(), episodes=20)
    assert isinstance(learned.controller, fz.TSK)
    assert learned.controllers == [learned.controller]
    assert "u1" in str(learned.controller.explain(0.3))
    learned.controller.save(tmp_path / "controller.json")
    assert fz.load(tmp_path / "controller.json") == learned.controller
    table = fz.fit(Line(), "q_lambda", episodes=2)
    with pytest.raises(fz.errors.InvalidValueError, match="a table is no fuzzy system"):
        _ = table.controller


def test_discrete_actions_are_for_tables():
    env = Line(discrete=True, start=5)
    learned = fz.fit(env, "q_lambda", episodes=150, seed=1)
    assert set(env.actions) == {5, 6, 7}
    assert all(type(action) is int for action in env.actions)
    assert learned.policy([0.8])[0] == 5
    for agent in NAMES[:3]:
        with pytest.raises(fz.errors.InvalidValueError, match="discrete"):
            fz.fit(Line(discrete=True), agent, episodes=1)
    grid = fz.Discretiser([(-1, 1, 5)])
    with pytest.raises(fz.errors.InvalidValueError, match="from 0 to 2"):
        fz.fit(Line(discrete=True), fz.QLambdaAgent(grid, [0, 3]), episodes=1)


def test_a_time_limit_bootstraps_and_an_end_does_not():
    """A world with one state and reward 1: its value is 1/(1 - γ) if it goes on, else 1."""

    class Same:
        observation_space, action_space = Box([0], [1]), Box([-1], [1])

        def __init__(self, terminated):
            self.terminated = terminated

        def reset(self, *, seed=None):
            del seed
            return [0.5], {}

        def step(self, action):
            del action
            return [0.5], 1.0, self.terminated, not self.terminated, {}

    x = [fz.Variable.evenly("x", (0, 1), "ab")]
    for terminated, value in [(True, 1.0), (False, 2.0)]:
        agent = fz.QLFIS(fz.TSK(x, [0, 0]), discount=0.5, critic_rate=0.5, actor_rate=1e-6)
        learned = fz.fit(Same(terminated), agent, episodes=200, evaluate_every=0)
        assert learned.agent.critic(0.5) == pytest.approx(value, abs=1e-3)
        assert agent.critic(0.5) == 0  # the agent that was given is as it was
        assert {e.terminated for e in learned.episodes} == {terminated}
    cut = fz.fit(Line(), episodes=3, steps=2, evaluate_every=0)
    assert cut.lengths.max() <= 2


@pytest.mark.parametrize("agent", NAMES)
def test_a_resumed_fit_equals_an_uninterrupted_one(agent, tmp_path):
    path = tmp_path / "checkpoint.json"
    options = {"seed": 5, "evaluate_every": 4, "evaluations": 2, "checkpoint_every": 3}
    whole = fz.fit(Line(), agent, episodes=17, **options)

    def interrupt(episode, so_far):
        del so_far
        if episode.number == 8:
            raise KeyboardInterrupt

    with pytest.raises(fz.FitInterrupted) as caught:
        fz.fit(Line(), agent, episodes=17, checkpoint=path, callback=interrupt, **options)
    assert len(caught.value.so_far.episodes) == 8
    assert len(json.loads(path.read_text(encoding="utf-8"))["episodes"]) == 6
    resumed = fz.fit(Line(), agent, episodes=17, checkpoint=path, **options)
    assert resumed.episodes == whole.episodes
    assert resumed.agent.to_json() == whole.agent.to_json()
    assert resumed.best_agent.to_json() == whole.best_agent.to_json()
    again = fz.fit(Line(), agent, episodes=17, checkpoint=path, **options)
    assert again.episodes == whole.episodes
    longer = fz.fit(Line(), agent, episodes=22, checkpoint=path, **options)
    straight = fz.fit(Line(), agent, episodes=22, **options)
    assert longer.episodes == straight.episodes
    assert longer.best_agent.to_json() == straight.best_agent.to_json()


def test_a_checkpoint_of_another_configuration_is_refused_in_words(tmp_path):
    path = tmp_path / "checkpoint.json"
    agent = fz.QLFIS(fz.TSK([fz.Variable.evenly("x", (-1, 1), "NZP")], [0, 0, 0]))
    other = fz.QLFIS(fz.TSK([fz.Variable.evenly("x", (-1, 1), "NZP")], [0, 0, 0]), discount=0.5)
    fz.fit(Line(), agent, episodes=2, checkpoint=path)
    for words, options in [
        (r"learner.settings.discount is 0.95 in it and 0.5 here", {"agent": other}),
        ("seed is 0 in it and 1 here", {"agent": agent, "seed": 1}),
        ("steps is null in it and 5 here", {"agent": agent, "steps": 5}),
        ('agent is "QLFIS" in it and "QLambdaAgent" here', {"agent": "q_lambda"}),
    ]:
        with pytest.raises(fz.errors.InvalidValueError, match=words):
            fz.fit(Line(), episodes=4, checkpoint=path, **options)
    anew = fz.fit(Line(), other, episodes=4, checkpoint=path, resume=False)
    assert len(anew.episodes) == 4
    for text in ["{", "[]", '{"type": "fit"}', agent.to_json()]:
        path.write_text(text, encoding="utf-8")
        with pytest.raises(fz.errors.FormatError, match="checkpoint"):
            fz.fit(Line(), agent, episodes=4, checkpoint=path)


def test_seeds_name_episodes():
    first, second, third = Line(), Line(), Line()
    fz.fit(first, episodes=3, evaluate_every=2, evaluations=2, seed=1)
    fz.fit(second, episodes=3, evaluate_every=0, seed=1)
    fz.fit(third, episodes=3, evaluate_every=0, seed=2)
    assert len(set(second.seeds)) == 3
    assert set(second.seeds) < set(first.seeds)
    assert not set(second.seeds) & set(third.seeds)
    learned, tested = first.seeds[:2] + first.seeds[4:5], first.seeds[2:4]
    assert learned == second.seeds
    assert first.seeds[5:7] == tested


def test_a_callback_sees_every_episode_and_may_end_it():
    seen = []

    def callback(episode, so_far):
        seen.append((episode.number, len(so_far.episodes)))
        return episode.number == 5

    learned = fz.fit(Line(), episodes=50, callback=callback, evaluate_every=2)
    assert seen == [(n, n) for n in range(1, 6)]
    assert learned.evaluations[0].tolist() == [2, 4, 5]
    seen.clear()
    fz.fit(Line(), episodes=3, callback=callback)
    assert seen == [(1, 1), (2, 2), (3, 3)]


def test_the_best_controller_survives_divergence_and_mistakes():
    env = Line()
    huge = lambda env: (np.array([env.x]), 1e15, env.steps == 40, False, {})  # noqa: E731
    env.after = dict.fromkeys(range(1500, 3000), huge)
    with pytest.raises(fz.FitDivergedError, match="smaller learning rates") as caught:
        fz.fit(env, episodes=200, evaluate_every=5)
    assert isinstance(caught.value, fz.errors.DivergedError)
    so_far = caught.value.so_far
    assert 0 < len(so_far.episodes) < 200
    assert so_far.best_evaluation == so_far.evaluations[1].max()
    assert so_far.controller(0.5) is not None

    def broken(env):
        raise ZeroDivisionError(str(env.steps))

    env = Line()
    env.after = {600: broken}
    with pytest.raises(ZeroDivisionError) as mistake:
        fz.fit(env, episodes=200)
    assert len(mistake.value.so_far.episodes) > 0


@pytest.mark.parametrize(
    ("answer", "error", "words"),
    [
        (([0.0], np.nan, False, False, {}), fz.errors.InvalidValueError, "reward must be finite"),
        (([np.nan], 0.0, False, False, {}), fz.errors.InvalidValueError, "observations must be"),
        (([0.0, 1.0], 0.0, False, False, {}), fz.errors.ShapeError, r"shape \(1,\) by their space"),
        (([0.0], 0.0, False, {}), fz.errors.ShapeError, "terminated, truncated"),
    ],
)
def test_worlds_that_misbehave_are_told_where(answer, error, words):
    env = Line()
    env.after = {3: lambda _: answer}
    with pytest.raises(error, match=words):
        fz.fit(env, episodes=5)


def test_spaces_that_do_not_fit_are_refused():
    def with_spaces(observations, actions):
        env = Line()
        env.observation_space, env.action_space = observations, actions
        return env

    box = Box([-1], [1])
    for env, agent, words in [
        (with_spaces(Discrete(3), box), "qlfis", "observation space must be a Box"),
        (with_spaces(Box([[-1]], [[1]]), box), "qlfis", "one dimension"),
        (with_spaces(Box([-np.inf], [1]), box), "qlfis", "observation_range="),
        (with_spaces(Box([-3.4e38], [3.4e38]), box), "qlfis", "observation_range="),
        (with_spaces(box, Box([-np.inf], [1])), "qlfis", "no finite range"),
        (with_spaces(Box([-1] * 8, [1] * 8), box), "qlfis", "make the agent yourself"),
        (with_spaces(box, Box([-1, -1], [1, 1])), "q_lambda", "of your own"),
        (with_spaces(Box([-1, -1], [1, 1]), box), fz.QLFIS(_one()), "observations have 2"),
        (with_spaces(box, Box([-1, -1], [1, 1])), fz.QLFIS(_one()), "actions have 2"),
    ]:
        with pytest.raises(fz.errors.InvalidValueError, match=words):
            fz.fit(env, agent, episodes=1)
    infinite = with_spaces(Box([-np.inf], [np.inf]), box)
    learned = fz.fit(infinite, episodes=2, steps=5, observation_range=[(-1, 1)])
    assert learned.controller.inputs[0].universe == (-1, 1)
    with pytest.raises(fz.errors.ShapeError, match="observation_range"):
        fz.fit(infinite, episodes=2, observation_range=[(-1, 1)] * 2)
    two = fz.fit(with_spaces(box, Box([-1, -2], [1, 2])), episodes=2, steps=5)
    assert len(two.controllers) == 2
    with pytest.raises(fz.errors.ShapeError, match="see controllers"):
        _ = two.controller


def _one():
    return fz.TSK([fz.Variable.evenly("x", (-1, 1), "NZP")], [0, 0, 0])


def test_arguments_that_make_no_sense_are_refused():
    with pytest.raises(fz.errors.UnknownNameError, match="q_lambda"):
        fz.fit(Line(), "q", episodes=1)
    with pytest.raises(fz.errors.InvalidTypeError, match="QLFIS, FuzzyActorCritic"):
        fz.fit(Line(), 3, episodes=1)
    with pytest.raises(fz.errors.InvalidTypeError, match="reset"):
        fz.fit(3, episodes=1)
    for name in ("episodes", "steps", "evaluations", "checkpoint_every"):
        with pytest.raises(fz.errors.InvalidValueError, match=f"{name} must be at least 1"):
            fz.fit(Line(), **{"episodes": 1, name: 0})


def test_gymnasium_environments_will_do():
    gymnasium = pytest.importorskip("gymnasium")
    pendulum = gymnasium.make("Pendulum-v1")
    learned = fz.fit(pendulum, episodes=2, steps=30, evaluations=1)
    assert learned.controller.inputs[2].universe == (-8, 8)
    cart = gymnasium.make("CartPole-v1")
    with pytest.raises(fz.errors.InvalidValueError, match="observation_range="):
        fz.fit(cart, "q_lambda", episodes=1)
    ranges = [(-2.4, 2.4), (-3, 3), (-0.21, 0.21), (-3, 3)]
    balanced = fz.fit(cart, "q_lambda", episodes=3, observation_range=ranges, evaluations=1)
    assert (balanced.lengths > 0).all()
