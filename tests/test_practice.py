"""Agents of one's own in the package's games."""

from __future__ import annotations

import json

import numpy as np
import pytest

import fuzzyrs as fz

GAME = fz.OneOnOne()
STARTS = [(-6, 7), (2, 4), (3, -8)]


def pursuer(**settings):
    """QLFIS with inputs held within their universes."""
    inputs = [fz.Variable.evenly(name, (-1, 1), "NZP") for name in ("angle", "rate")]
    actor = fz.TSK(inputs, [-0.5] * 3 + [0] * 3 + [0.5] * 3, outside="clamp", no_rule_fires=0.0)
    return fz.QLFIS(actor, seed=1, **settings)


def table(inputs=2, outputs=1):
    actions = np.linspace(-1, 1, 5)[:, None].repeat(outputs, axis=1)
    return fz.QLambdaAgent(fz.Discretiser([(-1, 1, 5)] * inputs), actions, seed=3)


def test_a_pursuer_learns_and_is_an_ordinary_system():
    learned = fz.fit(GAME, pursuer(), episodes=60, seed=4, evaluate_every=20)
    assert all(episode.terminated for episode in learned.episodes[-20:])
    assert GAME.play_many(learned.controller, evader_starts=STARTS).captured.all()
    numbers, durations = learned.evaluations
    assert numbers.tolist() == [20, 40, 60]
    assert (durations < 0).all()
    assert durations.max() == learned.best_evaluation
    assert isinstance(learned.controller, fz.TSK)


def test_an_evader_learns_to_last_longer():
    practice = fz.Practice(GAME, "evader", starts=[(2, 4)], steps=100)
    learned = fz.fit(practice, table(), episodes=100, evaluate_every=10, evaluations=1)
    _, durations = learned.evaluations
    assert learned.best_evaluation == durations.max() > 4.5


def test_the_reward_is_the_way_gained():
    practice = fz.Practice(GAME, starts=[(2, 4)], steps=3)
    played = practice.learn(pursuer(), 1)
    assert played["steps"] == 3
    assert played["duration"] == 0.3
    assert not played["captured"]
    assert played["reward"] <= 3
    evader = fz.Practice(GAME, "evader", starts=[(2, 4)], steps=3)
    assert evader.learn(table(), 1)["reward"] < 0


def test_a_test_teaches_nothing():
    agent = pursuer()
    before = agent.to_json()
    practice = fz.Practice(GAME)
    first, again = practice.test(agent, 0), practice.test(agent, 0)
    assert first == again
    assert practice.test(agent, 0, seed=5) != practice.test(agent, 1, seed=5)
    assert agent.to_json() == before


@pytest.mark.parametrize("make", [pursuer, table])
def test_practice_is_resumed_to_the_bit(make, tmp_path):
    options = {"seed": 7, "evaluate_every": 4, "checkpoint_every": 3}
    whole = fz.fit(GAME, make(), episodes=11, **options)
    path = tmp_path / "practice.json"
    fz.fit(GAME, make(), episodes=6, checkpoint=path, **options)
    resumed = fz.fit(GAME, make(), episodes=11, checkpoint=path, **options)
    assert resumed.agent.to_json() == whole.agent.to_json()
    assert resumed.episodes == whole.episodes


def test_a_checkpoint_of_another_game_is_refused(tmp_path):
    path = tmp_path / "practice.json"
    fz.fit(GAME, table(), episodes=2, checkpoint=path)
    kept = path.read_text()
    for other, difference in {
        "role": fz.Practice(GAME, "evader"),
        "starts": fz.Practice(GAME, starts=STARTS),
        "capture_radius": fz.OneOnOne(capture_radius=0.2),
        "opponent": fz.Practice(GAME, opponent=fz.EvasiveTurn(0.5)),
    }.items():
        with pytest.raises(ValueError, match=f"does not fit: spaces.*{other}"):
            fz.fit(difference, table(), episodes=3, checkpoint=path)
    assert path.read_text() == kept
    assert json.loads(kept)["configuration"]["spaces"]["role"] == "pursuer"


def test_what_does_not_fit_a_game_is_refused():
    bad = fz.errors.InvalidValueError
    with pytest.raises(fz.errors.UnknownNameError, match='did you mean "evader"'):
        fz.Practice(GAME, "evador")
    with pytest.raises(bad, match="steps must be at least 1"):
        fz.Practice(GAME, steps=0)
    with pytest.raises(bad, match="number of starting positions must be at least 1"):
        fz.Practice(GAME, starts=np.empty((0, 2)))
    with pytest.raises(bad, match="starting x of the evader must be finite"):
        fz.Practice(GAME, starts=[(np.nan, 1)])
    with pytest.raises(TypeError, match="the evader must be"):
        fz.Practice(GAME, opponent=3)
    practice = fz.Practice(GAME)
    with pytest.raises(TypeError, match="agent must be a QLFIS"):
        practice.learn("classical", 1)
    with pytest.raises(ValueError, match="of an agent in this game: expected 2, got 1"):
        practice.learn(table(inputs=1), 1)
    with pytest.raises(ValueError, match="of an agent in this game: expected 1, got 2"):
        practice.test(table(outputs=2), 1)
    with pytest.raises(ValueError, match="observations have 2 numbers; the agent reads 1"):
        fz.fit(practice, table(inputs=1), episodes=1)
    with pytest.raises(bad, match="episode must be from 1"):
        practice.learn(table(), 0)
