"""Agents that learn from reward: QLFIS, fuzzy actor-critic, the neural critic, Q(λ) on a grid."""

from __future__ import annotations

import copy
import json
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fuzzyrs as fz

TABLE_7_1 = [[-0.5, -0.25, 0.0], [-0.25, 0.0, 0.25], [0.0, 0.25, 0.5]]


def inputs(shape="gaussian_width"):
    return [fz.Variable.evenly(name, (-1, 1), "NZP", shape=shape) for name in ("angle", "rate")]


def actor(**options):
    return fz.TSK(inputs(), TABLE_7_1, **options)


MAKERS = {
    "qlfis": lambda seed=0: fz.QLFIS(actor(), seed=seed),
    "two outputs": lambda seed=0: fz.QLFIS([actor(), actor()], seed=seed),
    "fuzzy": lambda seed=0: fz.FuzzyActorCritic(actor(), seed=seed),
    "neural": lambda seed=0: fz.NeuralActorCritic(actor(), hidden=5, seed=seed),
    "table": lambda seed=0: fz.QLambdaAgent(
        fz.Discretiser([(-1, 1, 5), (-1, 1, 5)]), [-0.5, 0.0, 0.5], seed=seed
    ),
}
each = pytest.mark.parametrize("make", MAKERS.values(), ids=MAKERS)


def live(agent, steps, world):
    """Random experience; returns the actions and TD errors."""
    told = []
    x = world.uniform(-1, 1, 2)
    for _ in range(steps):
        action = agent.act(x)
        x = world.uniform(-1, 1, 2)
        told.append((*action, agent.learn(world.uniform(-1, 1), x)))
    return np.array(told)


class Printed:
    """Equations 7.7 and 7.10-7.15 in NumPy: a system's means, widths and consequents."""

    def __init__(self, consequents):
        self.mean = np.array([[-1.0, 0, 1], [-1, 0, 1]])
        self.width = np.array([v.terms["N"].parameters["width"] for v in inputs()])[:, None]
        self.width = np.repeat(self.width, 3, axis=1)
        self.consequents = np.array(consequents, dtype=float)
        self.traces = [np.zeros_like(of) for of in (self.mean, self.width, self.consequents)]

    def fire(self, x):
        degrees = np.exp(-(((x[:, None] - self.mean) / self.width) ** 2))
        return np.outer(*degrees)

    def __call__(self, x):
        strengths = self.fire(x)
        return (strengths * self.consequents).sum() / strengths.sum()

    def gradient(self, x):
        strengths = self.fire(x)
        shares = strengths / strengths.sum()
        pulls = (self.consequents - self(x)) * shares
        pulls = np.stack([pulls.sum(axis=1), pulls.sum(axis=0)])
        away = x[:, None] - self.mean
        return [
            pulls * 2 * away / self.width**2,
            pulls * 2 * away**2 / self.width**3,
            shares,
        ]

    def step(self, decay, gain, gradient, size):
        for trace, of, parameter in zip(
            self.traces, gradient, (self.mean, self.width, self.consequents), strict=True
        ):
            trace *= decay
            trace += gain * of
            parameter += size * trace
        self.mean.clip(-1, 1, out=self.mean)
        self.width.clip(0.02, 2, out=self.width)

    def parameters(self):
        terms = np.stack([self.mean, self.width], axis=2).ravel()
        return np.concatenate([terms, self.consequents.ravel()])


def test_qlfis_follows_the_printed_equations():
    agent = fz.QLFIS(actor(), clear_traces=False, seed=3)
    mine, critic = Printed(TABLE_7_1), Printed(np.zeros((3, 3)))
    world = np.random.default_rng(5)
    for episode in range(1, 6):
        agent.begin_episode()
        eta = 0.1 - 0.09 * episode / 1000
        x = world.uniform(-1.2, 1.2, 2)
        for _ in range(60):
            u_c = agent.act(x)[0]
            reached, reward = world.uniform(-1.2, 1.2, 2), world.uniform(-1, 1)
            error = reward + 0.95 * critic(reached) - critic(x)
            assert agent.learn(reward, reached) == pytest.approx(error, abs=1e-9)
            tried = (u_c - mine(x)) / 0.08
            critic.step(0.95 * 0.9, 1, critic.gradient(x), eta * error)
            mine.step(0, tried, mine.gradient(x), eta / 10 * error)
            x = reached
    assert agent.actor.parameters == pytest.approx(mine.parameters(), abs=1e-9)
    assert agent.critic.parameters == pytest.approx(critic.parameters(), abs=1e-9)
    assert np.abs(agent.actor.parameters - actor().parameters).max() > 0.01


@given(
    x=st.lists(st.floats(-2, 2), min_size=2, max_size=2),
    reached=st.lists(st.floats(-2, 2), min_size=2, max_size=2),
    reward=st.floats(-1e3, 1e3),
    terminated=st.booleans(),
)
@settings(deadline=None)
def test_one_step_of_fuzzy_actor_critic_is_linear_in_the_shares(x, reached, reward, terminated):
    agent = fz.FuzzyActorCritic(actor(), fz.TSK(inputs(), np.arange(9.0)), seed=1)
    before = agent.actor.consequents.ravel(), agent.critic.consequents.ravel()
    u, value = agent.actor(*x), agent.critic(*x)
    ahead = 0 if terminated else 0.95 * agent.critic(*reached)
    shares = Printed(TABLE_7_1).fire(np.array(x)).ravel()
    shares /= shares.sum()
    noise = (agent.act(x)[0] - u) / 0.08
    error = agent.learn(reward, reached, terminated)
    assert error == pytest.approx(reward + ahead - value, rel=1e-9, abs=1e-9)
    size = max(1, abs(error))
    assert agent.critic.consequents.ravel() == pytest.approx(
        before[1] + (0.1 - 0.09 / 1000) * error * shares, abs=1e-9 * size
    )
    assert agent.actor.consequents.ravel() == pytest.approx(
        before[0] + (0.01 - 0.009 / 1000) * error * noise * shares, abs=1e-9 * size
    )


def test_a_network_has_the_thesis_number_of_weights():
    agent = fz.NeuralActorCritic(actor(), seed=2)
    assert agent.weights.shape == (190,)
    assert np.abs(agent.weights).max() <= 0.1
    assert (agent.weights != fz.NeuralActorCritic(actor(), seed=3).weights).all()


@each
def test_the_same_seed_learns_the_same(make):
    runs = [live(make(seed), 50, np.random.default_rng(0)) for seed in (4, 4, 5)]
    assert (runs[0] == runs[1]).all()
    assert (runs[0] != runs[2]).any()


@each
def test_exploiting_neither_explores_nor_changes_anything(make):
    agent = make()
    live(agent, 30, np.random.default_rng(0))
    before = agent.to_json()
    actions = [agent.act([0.2, -0.4], explore=False) for _ in range(3)]
    assert (actions[0] == actions[1]).all()
    assert (actions[0] == actions[2]).all()
    assert agent.to_json() == before
    if hasattr(agent, "actors"):
        assert actions[0] == pytest.approx([each(0.2, -0.4) for each in agent.actors], abs=1e-12)


@each
@pytest.mark.parametrize("way", ["json", "file", "pickle", "copy"])
def test_learning_continues_with_the_same_numbers(make, way, tmp_path):
    agent, world = make(), np.random.default_rng(0)
    agent.begin_episode(7)
    live(agent, 25, world)
    agent.act([0.5, 0.5])
    if way == "json":
        again = type(agent).from_json(agent.to_json())
    elif way == "file":
        agent.save(tmp_path / "agent.json")
        again = type(agent).load(tmp_path / "agent.json")
    elif way == "pickle":
        again = pickle.loads(pickle.dumps(agent))
    else:
        again = copy.deepcopy(agent)
    assert type(again) is type(agent)
    assert again.episode == 7
    for of in (agent, again):
        of.learn(0.3, [0.1, 0.1])
        of.begin_episode()
        live(of, 25, np.random.default_rng(1))
    assert again.to_json() == agent.to_json()


@each
def test_documents_of_others_are_refused(make):
    agent = make()
    text = agent.to_json()
    for other in MAKERS.values():
        kind = json.loads(other().to_json())["type"]
        if kind != json.loads(text)["type"]:
            with pytest.raises(fz.errors.FormatError, match=kind):
                type(agent).from_json(other().to_json())
    with pytest.raises(fz.errors.FormatError):
        type(agent).from_json(text[:-20])


@each
def test_bad_numbers_are_refused_and_change_nothing(make):
    agent = make()
    with pytest.raises(fz.errors.UsageError, match=r"act|learn from"):
        agent.learn(1.0, [0, 0])
    agent.act([0.1, 0.1])
    before = agent.to_json()
    for reward, reached, error, words in [
        (np.nan, [0, 0], fz.errors.InvalidValueError, "reward must be finite"),
        (1.0, [0, np.inf], fz.errors.InvalidValueError, r"next observation\[1\] must be finite"),
        (1.0, [0, 0, 0], fz.errors.ShapeError, "next observation: expected 2, got 3"),
        (1.0, [[0, 0]], fz.errors.ShapeError, "one-dimensional"),
        (1.0, ["a", 0], fz.errors.InvalidTypeError, "next observation must be"),
    ]:
        with pytest.raises(error, match=words):
            agent.learn(reward, reached)
    with pytest.raises(fz.errors.InvalidValueError, match=r"observation\[0\]"):
        agent.act([np.nan, 0])
    with pytest.raises(fz.errors.InvalidValueError, match="episode"):
        agent.begin_episode(0)
    assert agent.to_json() == before


@pytest.mark.parametrize("make", [MAKERS["qlfis"], MAKERS["fuzzy"], MAKERS["neural"]])
def test_a_step_that_diverges_is_an_error_that_changes_nothing(make):
    agent = make()
    agent.act([0.1, 0.1])
    before = agent.to_json()
    with pytest.raises(fz.errors.DivergedError, match="smaller learning rates") as caught:
        agent.learn(1e14, [0.1, 0.1])
    assert caught.value.kind == "learning_diverged"
    assert agent.to_json() == before


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"discount": 1.1}, "discount must be between 0 and 1, got 1.1"),
        ({"trace_decay": -0.1}, "trace decay of the critic"),
        ({"actor_trace_decay": np.nan}, "trace decay of the actor"),
        ({"critic_rate": 0.0}, "learning rate of the critic must be above 0 and at most 1"),
        ({"actor_rate": fz.Schedule.linear(0.1, 2, 10)}, "last learning rate of the actor"),
        ({"noise": 0.0}, "noise must be positive"),
        ({"noise": -1.0}, "noise must be positive"),
    ],
)
def test_settings_out_of_range_are_refused(options, words):
    for kind in (fz.QLFIS, fz.FuzzyActorCritic, fz.NeuralActorCritic):
        with pytest.raises(fz.errors.InvalidValueError, match=words):
            kind(actor(), **options)


def test_parts_that_do_not_fit_are_refused():
    one = fz.TSK(inputs()[:1], [0, 0, 0])
    with pytest.raises(fz.errors.ShapeError, match="beside those of the critic"):
        fz.QLFIS([actor(), one])
    with pytest.raises(fz.errors.ShapeError, match="beside those of the critic"):
        fz.QLFIS(actor(), one)
    with pytest.raises(fz.errors.ShapeError, match="systems of the actor"):
        fz.QLFIS([])
    with pytest.raises(fz.errors.InvalidTypeError, match="a TSK or a sequence of them"):
        fz.QLFIS("classical")
    with pytest.raises(fz.errors.InvalidTypeError, match="a TSK or a sequence of them"):
        fz.QLFIS([one, 3])
    with pytest.raises(fz.errors.InvalidValueError, match="let it keep or clamp them"):
        fz.QLFIS(actor(outside="error"))
    with pytest.raises(fz.errors.UnknownNameError, match="consequents"):
        fz.QLFIS(actor(), tune="consequent")
    with pytest.raises(fz.errors.InvalidValueError, match="narrowest width"):
        fz.QLFIS(actor(), narrowest=0)
    with pytest.raises(fz.errors.InvalidTypeError, match="a number or a Schedule"):
        fz.QLFIS(actor(), noise="0.1")
    with pytest.raises(fz.errors.ShapeError, match="see actors"):
        _ = MAKERS["two outputs"]().actor


def test_tables_that_cannot_be_are_refused():
    grid = fz.Discretiser([(-1, 1, 3)])
    for actions, error in [
        ([1.0], fz.errors.InvalidValueError),
        ([1.0, np.nan], fz.errors.InvalidValueError),
        ([[[1.0], [2.0]]], fz.errors.ShapeError),
        (["a", "b"], fz.errors.InvalidTypeError),
    ]:
        with pytest.raises(error):
            fz.QLambdaAgent(grid, actions)
    for options in [{"learning_rate": 0}, {"learning_rate": 1.5}, {"exploration": -0.1}]:
        with pytest.raises(fz.errors.InvalidValueError, match="rate"):
            fz.QLambdaAgent(grid, [0, 1], **options)


def test_a_table_is_the_learner_behind_a_grid():
    agent = fz.QLambdaAgent(
        fz.Discretiser([(0, 2, 3)]), [[0, 0.5], [1, -0.5]], discount=0.5, trace_decay=0,
        learning_rate=0.25, exploration=0.0,
    )  # fmt: skip
    assert agent.act([0.9]).tolist() == [0, 0.5]
    assert agent.learn(1.0, [2.4], terminated=True) == 1.0
    assert agent.values.tolist() == [[0, 0], [0.25, 0], [0, 0]]
    assert agent.greedy_actions.shape == (3, 2)
    assert agent.states.states == 3
    assert agent.actions.tolist() == [[0, 0.5], [1, -0.5]]


def test_widths_stay_where_they_should_and_that_is_told():
    agent = fz.QLFIS(actor(), critic_rate=1.0, narrowest=0.2, seed=1)
    world = np.random.default_rng(2)
    x = world.uniform(-1, 1, 2)
    for _ in range(300):
        agent.act(x)
        x = world.uniform(-1, 1, 2)
        agent.learn(3 * world.uniform(-1, 1), x)
    assert agent.held > 0
    widths = [term.parameters["width"] for v in agent.critic.inputs for term in v.terms.values()]
    assert all(0.4 <= width <= 2 for width in widths)


def test_where_no_rule_fires_nothing_is_learned():
    agent = fz.QLFIS(actor())
    before = agent.actor.parameters, agent.critic.parameters
    assert abs(agent.act([1e9, 1e9])[0]) < 1  # noise alone
    agent.learn(5.0, [1e9, 1e9])
    assert (agent.actor.parameters == before[0]).all()
    assert (agent.critic.parameters == before[1]).all()


def test_schedules():
    linear = fz.Schedule.linear(0.1, 0.01, 1000)
    assert [linear.at(i) for i in (500, 1000, 5000)] == pytest.approx([0.055, 0.01, 0.01])
    assert fz.Schedule.power(0.1, 0.7).at(8) == pytest.approx(0.1 / 8**0.7)
    assert fz.Schedule.constant(3.0).at(9) == 3.0
    for schedule in (linear, fz.Schedule.power(0.1, 0.7), fz.Schedule.constant(3.0)):
        assert eval(repr(schedule), vars(fz)) == schedule
        assert pickle.loads(pickle.dumps(schedule)) == schedule
    with pytest.raises(fz.errors.InvalidValueError):
        fz.Schedule.constant(-1)
    with pytest.raises(fz.errors.InvalidValueError):
        fz.Schedule.power(1, -1)
    with pytest.raises(fz.errors.InvalidValueError):
        fz.Schedule.linear(1, 0.1, 0)
    with pytest.raises(fz.errors.InvalidValueError):
        linear.at(0)


def test_representations_are_short():
    assert repr(MAKERS["two outputs"]()) == "<QLFIS: 2 inputs, 2 outputs, episode 0>"
