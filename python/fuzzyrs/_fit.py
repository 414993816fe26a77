"""Learning from reward in environments of your own."""

from __future__ import annotations

import dataclasses
import json
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fuzzyrs._environment import AGENTS, Agent, Environment, World, agent_for, world_of
from fuzzyrs._fuzzyrs import TSK, OneOnOne, Practice, QLambdaAgent, write_text
from fuzzyrs.errors import DivergedError, from_kind

__all__ = ["Episode", "Fit", "FitDivergedError", "FitInterrupted", "fit"]

_Floats: TypeAlias = NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Episode:
    """One episode of learning.

    Attributes
    ----------
    number : int
        From 1 on.
    reward : float
        The sum of the rewards, exploration included.
    steps : int
        Its length.
    terminated : bool
        Whether the environment ended it, not a time limit.
    evaluation : float or None
        The mean sum of rewards of the controller alone, if it was evaluated after this episode.
    """

    number: int
    reward: float
    steps: int
    terminated: bool
    evaluation: float | None


@dataclasses.dataclass
class Fit:
    """What came of `fit`.

    Attributes
    ----------
    agent : QLFIS, FuzzyActorCritic, NeuralActorCritic or QLambdaAgent
        As it was after the last step.
    evaluated_best : the same, or None
        As it was when its controller alone had the largest mean sum of rewards in the evaluations,
        the first of several; None if there was no evaluation.
    best_evaluation : float
        That mean; NaN if there was no evaluation.
    episodes : list of Episode
        The learning curve.
    """

    agent: Agent
    evaluated_best: Agent | None
    best_evaluation: float
    episodes: list[Episode]

    @property
    def best_agent(self) -> Agent:
        """`evaluated_best`, or the last agent if there was no evaluation."""
        return self.agent if self.evaluated_best is None else self.evaluated_best

    @property
    def returns(self) -> _Floats:
        """The sum of the rewards of each episode, exploration included."""
        return np.array([episode.reward for episode in self.episodes])

    @property
    def lengths(self) -> NDArray[np.int64]:
        """The steps of each episode."""
        return np.array([episode.steps for episode in self.episodes], dtype=np.int64)

    @property
    def evaluations(self) -> tuple[NDArray[np.int64], _Floats]:
        """The episodes after which the controller alone was evaluated, and its mean returns."""
        done = [(e.number, e.evaluation) for e in self.episodes if e.evaluation is not None]
        numbers, returns = zip(*done, strict=True) if done else ((), ())
        return np.array(numbers, dtype=np.int64), np.array(returns, dtype=float)

    @property
    def controllers(self) -> list[TSK]:
        """The best agent's fuzzy systems, one for each number of the action."""
        if isinstance(self.best_agent, QLambdaAgent):
            message = "a table is no fuzzy system; use policy, or best_agent.greedy_actions"
            raise from_kind("unsuitable", message)
        return self.best_agent.actors

    @property
    def controller(self) -> TSK:
        """The best agent's fuzzy system, if an action is one number."""
        controllers = self.controllers
        if len(controllers) != 1:
            message = f"an action has {len(controllers)} numbers; see controllers"
            raise from_kind("wrong_shape", message)
        return controllers[0]

    def policy(self, observation: ArrayLike) -> _Floats:
        """The best agent's action at an observation, without exploration."""
        return self.best_agent.act(observation, explore=False)


class FitInterrupted(KeyboardInterrupt):
    """Ctrl-C came; `so_far` has what was learned."""

    def __init__(self, so_far: Fit) -> None:
        super().__init__(f"interrupted after {len(so_far.episodes)} episodes; see so_far")
        self.so_far = so_far


class FitDivergedError(DivergedError):
    """Learning diverged; `so_far` has what was learned before."""

    def __init__(self, message: str, so_far: Fit) -> None:
        super().__init__(message)
        self.kind = "learning_diverged"
        self.so_far = so_far


def fit(
    env: Environment | Practice | OneOnOne,
    agent: str | Agent = "fuzzy_actor_critic",
    *,
    episodes: int,
    steps: int | None = None,
    seed: int = 0,
    evaluate_every: int = 10,
    evaluations: int = 5,
    observation_range: Sequence[tuple[float, float]] | None = None,
    callback: Callable[[Episode, Fit], object] | None = None,
    checkpoint: str | os.PathLike[str] | None = None,
    checkpoint_every: int = 10,
    resume: bool = True,
) -> Fit:
    """Let an agent learn from reward in an environment of your own.

    Any Gymnasium environment with observations in a box of one dimension will do, or anything with
    the same methods and spaces. Actions in a box are for all agents, discrete ones for Q(λ).
    Actions are brought into the bounds of their space. The value of what comes next counts unless
    the environment has terminated; a time limit does not change it.

    The package's own games are environments too, whose episodes are played in Rust: see
    `Practice`.

    Parameters
    ----------
    env : Environment, Practice or OneOnOne
        Where to learn; a game alone is `Practice(game)`. It must depend on nothing but the seeds
        given to `reset` and the actions.
    agent : str or agent, optional
        "qlfis", "fuzzy_actor_critic", "neural_actor_critic" or "q_lambda" with defaults made from
        the spaces (three Gaussians for each observation, zero-order rules that all say the middle
        of the actions; a grid) for rewards of the order of 1; or a `QLFIS`, `FuzzyActorCritic`,
        `NeuralActorCritic` or `QLambdaAgent`, which is not changed.
    episodes : int
        How many; with a checkpoint, those before included.
    steps : int, optional
        The longest episode; by default the environment decides.
    seed : int, optional
        Of the environment's episodes, and of an agent given by name.
    evaluate_every : int, optional
        After how many episodes, and after the last, the controller alone is evaluated; 0 for
        never.
    evaluations : int, optional
        In how many episodes, always the same.
    observation_range : sequence of (float, float), optional
        The range of each observation, for an agent given by name; by default that of the space,
        which may be infinite.
    callback : callable, optional
        Called after each episode with it and the `Fit` so far; True ends learning.
    checkpoint : str or os.PathLike, optional
        A file to which everything is saved now and then and at the end.
    checkpoint_every : int, optional
        After how many episodes.
    resume : bool, optional
        Whether to continue from the checkpoint if there is one: the result is the same to the bit
        as without a break.

    Returns
    -------
    Fit

    Raises
    ------
    FitInterrupted
        On Ctrl-C; `so_far` has what was learned.
    FitDivergedError
        If learning diverges; `so_far` has what was learned before. Any other exception carries a
        `so_far` as well.
    InvalidValueError
        If the spaces don't fit, an observation or a reward is not finite, or the checkpoint is of
        another configuration.

    Examples
    --------
    >>> import numpy as np
    >>> import fuzzyrs as fz
    >>> class Line:  # a point is to come near 0 quickly
    ...     class observation_space:
    ...         low, high = np.array([-1.0]), np.array([1.0])
    ...     class action_space:
    ...         low, high, dtype = np.array([-0.2]), np.array([0.2]), float
    ...     def reset(self, *, seed=None):
    ...         self.x = np.random.default_rng(seed).uniform(-1, 1)
    ...         return [self.x], {}
    ...     def step(self, action):
    ...         before, self.x = self.x, np.clip(self.x + action[0], -1, 1)
    ...         return [self.x], abs(before) - abs(self.x), bool(abs(self.x) < 0.1), False, {}
    >>> learned = fz.fit(Line(), episodes=150, steps=30, seed=1)
    >>> bool(learned.controller(0.8) < -0.1 and learned.controller(-0.8) > 0.1)
    True
    """
    _check_counts(episodes, steps, evaluate_every, evaluations, checkpoint_every)
    world = world_of(env, steps)
    agent = _agent(agent, world, observation_range, seed)
    measure = _Measure(world, seed, evaluate_every, evaluations)
    file = None if checkpoint is None else _Checkpoint(Path(checkpoint), measure, agent)
    so_far = file.read() if file is not None and resume and file.path.exists() else None
    if so_far is None:
        so_far = Fit(_copy(agent), None, float("nan"), [])
    try:
        for number in range(len(so_far.episodes) + 1, episodes + 1):
            episode = Episode(number, *world.learn(so_far.agent, number, seed), None)
            if measure.is_due(number):
                episode = measure.after(episode, so_far)
            so_far.episodes.append(episode)
            stop = callback is not None and callback(episode, so_far) is True
            last = stop or number == episodes
            if file is not None and (last or number % checkpoint_every == 0):
                file.write(so_far)
            if last:
                break
        measure.at_the_end(so_far)
    except KeyboardInterrupt as interruption:
        raise FitInterrupted(so_far) from interruption
    except DivergedError as error:
        message = f"episode {len(so_far.episodes) + 1}: {error}"
        raise FitDivergedError(message, so_far) from error
    except Exception as error:
        error.so_far = so_far  # type: ignore[attr-defined]
        raise
    return so_far


def _agent(
    agent: str | Agent,
    world: World,
    observation_range: Sequence[tuple[float, float]] | None,
    seed: int,
) -> Agent:
    """The agent that is to learn, if it fits the world."""
    if isinstance(agent, str):
        agent = agent_for(agent, world, observation_range, seed)
    elif not isinstance(agent, AGENTS):
        names = ", ".join(of.__name__ for of in AGENTS)
        came = type(agent).__name__
        raise from_kind("wrong_type", f"the agent must be a name or one of {names}, got {came}")
    world.check(agent)
    return agent


def _check_counts(
    episodes: int, steps: int | None, evaluate_every: int, evaluations: int, checkpoint_every: int
) -> None:
    for what, count, least in (
        ("episodes", episodes, 1),
        ("steps", 1 if steps is None else steps, 1),
        ("evaluate_every", evaluate_every, 0),
        ("evaluations", evaluations, 1),
        ("checkpoint_every", checkpoint_every, 1),
    ):
        if count < least:
            raise from_kind("out_of_range", f"{what} must be at least {least}, got {count}")


def _copy(agent: Agent) -> Agent:
    return type(agent).from_json(agent.to_json())


@dataclasses.dataclass
class _Measure:
    """By what the best controller is told: its mean return in episodes that are always the same."""

    world: World
    seed: int
    every: int
    count: int

    def is_due(self, number: int) -> bool:
        """Whether the episode with this number is one to evaluate after."""
        return self.every > 0 and number % self.every == 0

    def at_the_end(self, so_far: Fit) -> None:
        """Evaluate after the last episode, too.

        That is no part of a checkpoint: a longer fit that continues from it has none here.
        """
        last = so_far.episodes[-1]
        if self.every > 0 and last.evaluation is None:
            so_far.episodes[-1] = self.after(last, so_far)

    def after(self, episode: Episode, so_far: Fit) -> Episode:
        """Evaluate the agent's controller after an episode, and keep it if it is the best."""
        agent, seed = so_far.agent, self.seed
        mean = float(np.mean([self.world.test(agent, each, seed) for each in range(self.count)]))
        if not mean <= so_far.best_evaluation:
            so_far.evaluated_best, so_far.best_evaluation = _copy(so_far.agent), mean
        return dataclasses.replace(episode, evaluation=mean)


class _Checkpoint:
    """A file with everything that a fit needs to continue."""

    def __init__(self, path: Path, measure: _Measure, agent: Agent) -> None:
        self.path = path
        self.kind = type(agent)
        self.configuration = {
            "agent": type(agent).__name__,
            "learner": json.loads(agent.to_json())["state"]["configuration"],
            "spaces": measure.world.spaces,
            "steps": measure.world.steps,
            "seed": measure.seed,
            "evaluate_every": measure.every,
            "evaluations": measure.count,
        }

    def write(self, so_far: Fit) -> None:
        """Replace the file."""
        best = so_far.evaluated_best
        document = {
            "format": "fuzzyrs",
            "version": 1,
            "type": "fit",
            "configuration": self.configuration,
            "agent": json.loads(so_far.agent.to_json()),
            "best_agent": None if best is None else json.loads(best.to_json()),
            "best_evaluation": None if best is None else so_far.best_evaluation,
            "episodes": [dataclasses.astuple(episode) for episode in so_far.episodes],
        }
        write_text(self.path, json.dumps(document) + "\n")

    def read(self) -> Fit:
        """Return what the file holds, if it belongs to this fit."""
        document = self._document()
        difference = _difference(document["configuration"], self.configuration, "")
        if difference:
            message = (
                f"the checkpoint {self.path} does not fit: {difference}; take another file, or "
                "resume=False to begin anew"
            )
            raise from_kind("unsuitable", message)
        best, evaluation = document["best_agent"], document["best_evaluation"]
        return Fit(
            self.kind.from_json(json.dumps(document["agent"])),
            None if best is None else self.kind.from_json(json.dumps(best)),
            float("nan") if evaluation is None else float(evaluation),
            [Episode(*episode) for episode in document["episodes"]],
        )

    def _document(self) -> Any:
        wanted = ("configuration", "agent", "best_agent", "best_evaluation", "episodes")
        try:
            document = json.loads(self.path.read_text(encoding="utf-8"))
        except (OSError, UnicodeDecodeError) as error:
            raise from_kind("file", f"cannot read {self.path}: {error}") from error
        except ValueError as error:
            raise from_kind("format", f"{self.path} is not a checkpoint: {error}") from error
        is_fit = isinstance(document, dict) and document.get("type") == "fit"
        if not is_fit or any(part not in document for part in wanted):
            raise from_kind("format", f"{self.path} is not a checkpoint of fit")
        return document


def _difference(there: Any, here: Any, path: str) -> str:
    """Where two configurations differ first, in words; empty if nowhere."""
    if isinstance(there, dict) and isinstance(here, dict) and there.keys() == here.keys():
        parts = [
            _difference(there[key], here[key], f"{path}.{key}" if path else key) for key in here
        ]
        return next(filter(None, parts), "")
    if isinstance(there, list) and isinstance(here, list) and len(there) == len(here):
        parts = [
            _difference(*of, f"{path}[{at}]") for at, of in enumerate(zip(there, here, strict=True))
        ]
        return next(filter(None, parts), "")
    return (
        "" if there == here else f"{path} is {json.dumps(there)} in it and {json.dumps(here)} here"
    )
