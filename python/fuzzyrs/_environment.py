"""Environments as Gymnasium has them, and the agents that fit their spaces.

Nothing here imports Gymnasium: whatever has its methods and spaces will do.
"""

from __future__ import annotations

import math
import pickle
from collections.abc import Sequence
from typing import Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fuzzyrs._fuzzyrs import (
    QLFIS,
    TSK,
    Discretiser,
    FuzzyActorCritic,
    NeuralActorCritic,
    OneOnOne,
    Practice,
    QLambdaAgent,
    Schedule,
    Variable,
)
from fuzzyrs.errors import from_kind

_Floats: TypeAlias = NDArray[np.float64]
Agent: TypeAlias = QLFIS | FuzzyActorCritic | NeuralActorCritic | QLambdaAgent
AGENTS = (QLFIS, FuzzyActorCritic, NeuralActorCritic, QLambdaAgent)
# What a random number is for.
_LEARNING, _TESTS = 0, 1
NAMES = ("qlfis", "fuzzy_actor_critic", "neural_actor_critic", "q_lambda")

TERMS = ("low", "middle", "high")
# What the defaults may need; more inputs want systems made with thought.
MOST_RULES = 729
MOST_STATES = 20_000


class Environment(Protocol):
    """What an agent learns in: a Gymnasium environment, or anything with these members."""

    @property
    def observation_space(self) -> Any:
        """A box: `low`, `high` and `shape` of one dimension."""

    @property
    def action_space(self) -> Any:
        """A box, or a discrete space: `n` actions from `start` (0 if it has none)."""

    def reset(self, *, seed: int | None = None) -> tuple[Any, dict[str, Any]]:
        """Begin an episode; return the first observation and anything else."""

    def step(self, action: Any, /) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Act; return observation, reward, terminated, truncated and anything else."""


class World:
    """An environment whose spaces have been looked at, and that says which number is wrong."""

    def __init__(self, env: Environment, steps: int | None) -> None:
        self.env: Any = env
        self.steps = steps
        for method in ("reset", "step", "observation_space", "action_space"):
            if not hasattr(env, method):
                message = f"an environment has {method}, as Gymnasium's do; {_name(env)} has none"
                raise from_kind("wrong_type", message)
        self.observation_low, self.observation_high = _box("observation", env.observation_space)
        space = env.action_space
        self.count: int | None = int(space.n) if hasattr(space, "n") else None
        self.start = int(getattr(space, "start", 0))
        if self.count is None:
            self.action_low, self.action_high = _box("action", space)
        self.place = ""

    @property
    def spaces(self) -> dict[str, Any]:
        """The bounds of the spaces, for checkpoints."""
        if self.count is not None:
            actions = {"action_first": [self.start], "action_count": [self.count]}
        else:
            low, high = self.action_low.tolist(), self.action_high.tolist()
            actions = {"action_low": low, "action_high": high}
        low, high = self.observation_low.tolist(), self.observation_high.tolist()
        return {"observation_low": low, "observation_high": high, **actions}

    def check(self, agent: Agent) -> None:
        """Refuse an agent that does not fit the spaces."""
        expected = len(self.observation_low)
        if agent.inputs != expected:
            message = f"observations have {expected} numbers; the agent reads {agent.inputs}"
            raise from_kind("unsuitable", message)
        if self.count is None:
            outputs = len(self.action_low)
            if agent.outputs != outputs:
                message = f"actions have {outputs} numbers; the agent gives {agent.outputs}"
                raise from_kind("unsuitable", message)
            return
        if not isinstance(agent, QLambdaAgent):
            message = "the actions are a discrete set; take agent='q_lambda' or a QLambdaAgent"
            raise from_kind("unsuitable", message)
        known = range(self.start, self.start + self.count)
        if any(action not in known for action in agent.actions.ravel()) or agent.outputs != 1:
            message = f"the agent's actions must be whole numbers from {known.start} to {known[-1]}"
            raise from_kind("unsuitable", message)

    def learn(self, agent: Agent, number: int, seed: int) -> tuple[float, int, bool]:
        """Let an agent learn in the episode with this number.

        Return the sum of its rewards, the steps, and whether the environment ended it.
        """
        name = f"episode {number}"
        agent.begin_episode(number)
        observation = self._reset(_seed(seed, _LEARNING, number), name)
        total, step = 0.0, 0
        while True:
            step += 1
            action = agent.act(observation)
            observation, reward, terminated, truncated = self._step(action, step, name)
            agent.learn(reward, observation, terminated)
            total += reward
            if terminated or truncated:
                return total, step, terminated

    def test(self, agent: Agent, number: int, seed: int) -> float:
        """Return what an agent reaches without exploration in a test that is always the same."""
        name = f"evaluation {number + 1}"
        observation = self._reset(_seed(seed, _TESTS, number), name)
        total, step = 0.0, 0
        while True:
            step += 1
            action = agent.act(observation, explore=False)
            observation, reward, terminated, truncated = self._step(action, step, name)
            total += reward
            if terminated or truncated:
                return total

    def _reset(self, seed: int, episode: str) -> _Floats:
        """Begin an episode."""
        self.place = f"{episode}, at its start"
        answer = self.env.reset(seed=seed)
        if not isinstance(answer, tuple) or len(answer) != 2:
            raise from_kind("wrong_shape", "reset must return an observation and a dictionary")
        return self._observation(answer[0])

    def _step(
        self, action: _Floats, number: int, episode: str
    ) -> tuple[_Floats, float, bool, bool]:
        """Act, within the bounds of actions; the step with this number may be the last."""
        self.place = f"{episode}, step {number}"
        answer = self.env.step(self._action(action))
        if not isinstance(answer, tuple) or len(answer) != 5:
            message = "step must return observation, reward, terminated, truncated and a dictionary"
            raise from_kind("wrong_shape", message)
        observation, reward, terminated, truncated, _ = answer
        reward = float(reward)
        if not math.isfinite(reward):
            raise from_kind("not_finite", f"the reward must be finite, got {reward} ({self.place})")
        over = bool(truncated) or number == self.steps
        return self._observation(observation), reward, bool(terminated), over

    def _observation(self, seen: Any) -> _Floats:
        observation = np.asarray(seen, dtype=float)
        if observation.shape != self.observation_low.shape:
            message = (
                f"observations have shape {self.observation_low.shape} by their space, "
                f"got {observation.shape} ({self.place})"
            )
            raise from_kind("wrong_shape", message)
        if not np.isfinite(observation).all():
            message = f"observations must be finite, got {observation} ({self.place})"
            raise from_kind("not_finite", message)
        return observation

    def _action(self, action: _Floats) -> Any:
        if self.count is not None:
            return int(action[0])
        space = self.env.action_space
        return np.clip(action, self.action_low, self.action_high).astype(space.dtype)


class GameWorld(World):
    """One of the package's games, whose episodes are played in Rust."""

    def __init__(self, practice: Practice, steps: int | None) -> None:
        robot = getattr(practice.game, practice.role)
        self.practice = practice if steps is None else _shorter(practice, steps)
        self.env, self.steps, self.count, self.start = None, self.practice.steps, None, 0
        # As far as the thesis's fuzzy sets reach, in rad and rad/s.
        self.observation_low, self.observation_high = np.full(2, -1.0), np.full(2, 1.0)
        self.action_low = np.array([-robot.max_steering])
        self.action_high = -self.action_low

    @property
    def spaces(self) -> dict[str, Any]:
        """What is played, for checkpoints."""
        practice = self.practice
        return {
            "game": practice.game.to_dict(),
            "role": practice.role,
            "opponent": pickle.dumps(practice.opponent, protocol=4).hex(),
            "starts": practice.starts.tolist(),
            "bootstrap_at_capture": practice.bootstrap_at_capture,
        }

    def learn(self, agent: Agent, number: int, seed: int) -> tuple[float, int, bool]:
        """Let an agent learn in the game with this number."""
        played = self.practice.learn(agent, number, seed)
        return played["reward"], played["steps"], played["captured"]

    def test(self, agent: Agent, number: int, seed: int) -> float:
        """Return the duration of a game [s], negative if it is to be short."""
        duration: float = self.practice.test(agent, number, seed)["duration"]
        return duration if self.practice.role == "evader" else -duration


def _shorter(practice: Practice, steps: int) -> Practice:
    return Practice(
        practice.game,
        practice.role,
        opponent=practice.opponent,
        starts=practice.starts,
        steps=steps,
        bootstrap_at_capture=practice.bootstrap_at_capture,
    )


def world_of(env: Environment | Practice | OneOnOne, steps: int | None) -> World:
    """Return what an agent can be driven in."""
    if isinstance(env, OneOnOne):
        env = Practice(env)
    return GameWorld(env, steps) if isinstance(env, Practice) else World(env, steps)


def _seed(*parts: int) -> int:
    return int(np.random.SeedSequence(parts).generate_state(1)[0])


def _name(thing: object) -> str:
    return type(thing).__name__


def _box(what: str, space: Any) -> tuple[_Floats, _Floats]:
    """The bounds of a box of one dimension."""
    if not hasattr(space, "low") or not hasattr(space, "high"):
        raise from_kind("unsuitable", f"the {what} space must be a Box, got {space!r}")
    low, high = np.asarray(space.low, dtype=float), np.asarray(space.high, dtype=float)
    if low.ndim != 1 or low.shape != high.shape or not len(low):
        message = f"the {what} space must be a Box of one dimension, got {space!r}; flatten it"
        raise from_kind("unsuitable", message)
    return low, high


def agent_for(
    name: str, world: World, ranges: Sequence[tuple[float, float]] | None, seed: int
) -> Agent:
    """The agent of this name with defaults made from the spaces."""
    if name not in NAMES:
        message = f"unknown agent {name!r}; known: {', '.join(NAMES)}"
        raise from_kind("unknown_name", message)
    universes = _universes(world, ranges)
    if name == "q_lambda":
        return _table(world, universes, seed)
    if world.count is not None:
        message = f"the actions are a discrete set, which {name!r} cannot do; take 'q_lambda'"
        raise from_kind("unsuitable", message)
    half = _finite_actions(world)
    rules = len(TERMS) ** len(universes)
    if rules > MOST_RULES:
        message = (
            f"{len(universes)} inputs of three terms make {rules} rules: make the agent yourself"
        )
        raise from_kind("unsuitable", message)
    names = [f"x{number}" for number in range(1, len(universes) + 1)]
    inputs = [Variable.evenly(*of, TERMS) for of in zip(names, universes, strict=True)]
    middles = (world.action_low + world.action_high) / 2
    actors = [
        TSK(inputs, [middle] * rules, name=f"u{number}", output=f"u{number}",
            no_rule_fires=middle, outside="clamp")
        for number, middle in enumerate(middles, 1)
    ]  # fmt: skip
    scale = float(half.min())
    rate = Schedule.constant(min(0.2 * scale, 1.0))
    noise = 0.5 * scale
    if name == "qlfis":
        return QLFIS(actors, actor_rate=rate, noise=noise, seed=seed)
    if name == "fuzzy_actor_critic":
        return FuzzyActorCritic(actors, actor_rate=rate, noise=noise, seed=seed)
    return NeuralActorCritic(actors, actor_rate=rate, noise=noise, seed=seed)


def _universes(
    world: World, ranges: Sequence[tuple[float, float]] | None
) -> list[tuple[float, float]]:
    count = len(world.observation_low)
    if ranges is not None:
        universes = [(float(low), float(high)) for low, high in ranges]
        if len(universes) != count:
            message = f"observation_range: expected {count} pairs, got {len(universes)}"
            raise from_kind("wrong_shape", message)
        return universes
    universes = list(
        zip(world.observation_low.tolist(), world.observation_high.tolist(), strict=True)
    )
    for number, (low, high) in enumerate(universes):
        # Gymnasium writes the largest float32 for "no bound", too.
        if not (math.isfinite(high - low) and high - low < float(np.finfo(np.float32).max)):
            message = (
                f"observation {number} ranges from {low} to {high}, and fuzzy sets need a finite "
                "range: give observation_range=[(low, high), ...], or an agent of your own"
            )
            raise from_kind("unsuitable", message)
    return universes


def _finite_actions(world: World) -> _Floats:
    """Half the range of each number of an action."""
    half = (world.action_high - world.action_low) / 2
    if not np.isfinite(half).all():
        message = "the actions have no finite range: give an agent of your own"
        raise from_kind("unsuitable", message)
    return half


def _table(world: World, universes: list[tuple[float, float]], seed: int) -> QLambdaAgent:
    points = {1: 31, 2: 15, 3: 9, 4: 6}.get(len(universes), 5)
    if points ** len(universes) > MOST_STATES:
        message = f"a grid over {len(universes)} observations is too large: make the agent yourself"
        raise from_kind("unsuitable", message)
    grid = Discretiser([(low, high, points) for low, high in universes])
    if world.count is not None:
        actions = np.arange(world.start, world.start + world.count)
    elif len(_finite_actions(world)) == 1:
        actions = np.linspace(world.action_low[0], world.action_high[0], 7)
    else:
        message = "actions of several numbers have no natural list: give a QLambdaAgent of your own"
        raise from_kind("unsuitable", message)
    return QLambdaAgent(grid, actions, seed=seed)
