"""Learning from an expert on a plant of your own: collect, tune, steer in parallel, repeat.

The idea of IANFIS and IGBFLC for any plant. First the expert steers alone and a fuzzy system is
tuned to do what it did. Then both steer, their outputs added, and the system is tuned to do what
both together did; and again. With the sum as its target a system can get better than its
teacher: where the plant needs it, it acts about twice as strongly.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any, Generic, Protocol, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fuzzyrs._fuzzyrs import TSK, System, fit_anfis, fit_genetic
from fuzzyrs.errors import NoRuleFiresError, from_kind

__all__ = ["Imitation", "ImitationInterrupted", "Plant", "Round", "imitate"]

_Floats = NDArray[np.float64]
_System = TypeVar("_System", TSK, System)


class Plant(Protocol):
    """What is controlled: anything with these two methods."""

    def reset(self, episode: int, /) -> ArrayLike:
        """Begin an episode; return what the controllers see.

        The same number must begin the same episode: experts and learners are compared on it.
        """

    def step(self, output: Any, /) -> tuple[ArrayLike, bool]:
        """Act for one time step; return what the controllers see then, and whether it is over.

        An episode that is over before its last step counts as lost, and teaches nothing.
        """


@dataclasses.dataclass(frozen=True)
class Round(Generic[_System]):
    """One round of learning.

    Attributes
    ----------
    system : TSK or System
        What was learned.
    cost : float
        The mean cost of the episodes in which the system alone steers; infinite if all were lost.
    lost : int
        How many of them were lost: over too early, or no longer finite.
    samples : int
        From how many samples it was learned.
    error : float
        The root mean squared difference between the system and its target over them.
    """

    system: _System
    cost: float
    lost: int
    samples: int
    error: float


@dataclasses.dataclass(frozen=True)
class Imitation(Generic[_System]):
    """What came of `imitate`.

    Attributes
    ----------
    expert_cost : float
        The mean cost of the episodes in which the expert alone steers.
    expert_lost : int
        How many episodes the expert lost.
    rounds : list of Round
        The first learned from the expert alone.
    """

    expert_cost: float
    expert_lost: int
    rounds: list[Round[_System]]

    @property
    def best(self) -> Round[_System]:
        """The round whose system lost the fewest episodes and then cost least."""
        return min(self.rounds, key=lambda round_: (round_.lost, round_.cost))

    @property
    def system(self) -> _System:
        """The best round's system."""
        return self.best.system

    @property
    def beats_expert(self) -> bool:
        """Whether the best system lost no more episodes than the expert and cost less."""
        best = self.best
        return best.lost <= self.expert_lost and best.cost < self.expert_cost


class ImitationInterrupted(KeyboardInterrupt):
    """Ctrl-C came; `so_far` has the rounds that are done."""

    def __init__(self, so_far: Imitation[Any]) -> None:
        super().__init__(f"interrupted after {len(so_far.rounds)} rounds; they are in so_far")
        self.so_far = so_far


def imitate(
    expert: Callable[[_Floats], ArrayLike],
    plant: Plant,
    system: _System,
    *,
    rounds: int = 2,
    episodes: Sequence[int] | int = 4,
    steps: int = 500,
    target: str = "sum",
    tune: str | Callable[[_System, _Floats, _Floats], _System] = "anfis",
    cost: Callable[[_Floats, _Floats], float] | None = None,
    stop_when_better: bool = False,
    seed: int = 0,
    progress: Callable[[Round[_System]], object] | None = None,
) -> Imitation[_System]:
    """Let a fuzzy system learn from an expert, and then beyond it.

    Parameters
    ----------
    expert : callable
        Takes what the plant shows, an array, and returns the output: a number, or as many as the
        system has. Any function, such as ``lambda x: pd(*x)`` for a `PD`.
    plant : Plant
        What is controlled.
    system : TSK or System
        Where learning begins; its inputs are what the plant shows. It is not changed.
    rounds : int, optional
        How often the system steers in parallel with the expert and learns from both, after the
        first time, when it learns from the expert alone.
    episodes : int or sequence of int, optional
        The episodes of each round: their number, or the numbers given to `plant.reset`.
    steps : int, optional
        The length of an episode.
    target : {"sum", "expert"}, optional
        What is learned while both steer: the sum of both outputs, or the expert's alone, which
        leaves the system as good as the expert.
    tune : {"anfis", "genetic"} or callable, optional
        How the system is tuned to samples: `fit_anfis`, `fit_genetic`, or a function of a system,
        an array of inputs and one of outputs that returns a system.
    cost : callable, optional
        What an episode costs: a function of what the plant showed, shape (n + 1, inputs), and of
        the outputs, shape (n, outputs). By default the mean square of the first thing shown.
    stop_when_better : bool, optional
        Whether to end as soon as a system beats the expert.
    seed : int, optional
        Of the tuning.
    progress : callable, optional
        Called with every `Round`.

    Returns
    -------
    Imitation

    Raises
    ------
    ImitationInterrupted
        On Ctrl-C; it has the finished rounds.
    InvalidValueError
        If the expert's outputs are not finite, or it loses every episode.

    Examples
    --------
    >>> import fuzzyrs as fz
    >>> class Tank:  # its level follows the inflow; the level is to become 1
    ...     def reset(self, episode):
    ...         self.level = 0.4 * episode
    ...         return [1 - self.level]
    ...
    ...     def step(self, flow):
    ...         self.level += 0.1 * (flow - 0.2 * self.level)
    ...         return [1 - self.level], False
    >>> error = fz.Variable.evenly("error", (-1, 1), "ABCDE")
    >>> learned = fz.imitate(lambda x: 2 * x[0], Tank(), fz.TSK([error], [0] * 5), steps=50)
    >>> learned.beats_expert
    True
    """
    _check(rounds, steps, target)
    numbers = list(range(episodes)) if isinstance(episodes, int) else list(episodes)
    if not numbers:
        raise from_kind("out_of_range", "episodes must be at least 1, got 0")
    stage = _Stage(plant, numbers, steps, cost or _mean_square)
    tuned = _tuner(tune, seed)

    teacher = _checked(expert, len(system.outputs) if isinstance(system, System) else 1)
    samples, expert_cost, expert_lost = stage.run(teacher)
    if expert_lost == len(numbers):
        message = "the expert lost every episode, so there is nothing to learn from it"
        raise from_kind("out_of_range", message)
    imitation: Imitation[_System] = Imitation(expert_cost, expert_lost, [])
    try:
        for number in range(rounds + 1):
            if number > 0:
                samples, _, _ = stage.run(_together(teacher, system, target))
            inputs, outputs = samples
            if not len(inputs):  # both together lost every episode
                break
            system = tuned(system, inputs, outputs)
            error = float(np.sqrt(np.mean((_outputs_of(system, inputs) - outputs) ** 2)))
            _, own_cost, lost = stage.run(_plain(system))
            learned = Round(system, own_cost, lost, len(inputs), error)
            imitation.rounds.append(learned)
            if progress is not None:
                progress(learned)
            if stop_when_better and imitation.beats_expert:
                break
    except KeyboardInterrupt as interruption:
        raise ImitationInterrupted(imitation) from interruption
    return imitation


def _check(rounds: int, steps: int, target: str) -> None:
    if rounds < 0:
        raise from_kind("out_of_range", f"rounds must be zero or more, got {rounds}")
    if steps < 1:
        raise from_kind("out_of_range", f"steps must be at least 1, got {steps}")
    if target not in {"sum", "expert"}:
        message = f"unknown target {target!r}; known: 'sum', 'expert'"
        raise from_kind("unknown_name", message)


def _tuner(
    tune: str | Callable[[_System, _Floats, _Floats], _System], seed: int
) -> Callable[[_System, _Floats, _Floats], _System]:
    if callable(tune):
        return tune
    if tune == "anfis":

        def by_anfis(system: _System, x: _Floats, y: _Floats) -> _System:
            # A round visits few rules; the ridge keeps the others from wild consequents.
            return cast("_System", fit_anfis(system, x, y, ridge=1e-3, seed=seed).system)

        return by_anfis
    if tune == "genetic":
        return lambda system, x, y: fit_genetic(system, x, y, seed=seed)[0]
    message = f"unknown way to tune {tune!r}; known: 'anfis', 'genetic', or a function"
    raise from_kind("unknown_name", message)


# What steers: from what the plant shows to the output applied and the one recorded.
_Driver = Callable[[_Floats], tuple[_Floats, _Floats]]


def _checked(expert: Callable[[_Floats], ArrayLike], outputs: int) -> _Driver:
    def drive(x: _Floats) -> tuple[_Floats, _Floats]:
        output = np.atleast_1d(np.asarray(expert(x), dtype=float))
        if output.shape != (outputs,) or not np.isfinite(output).all():
            wanted = "a finite number" if outputs == 1 else f"{outputs} finite numbers"
            message = f"the expert must return {wanted}, got {output} at {x}"
            raise from_kind("not_finite", message)
        return output, output

    return drive


def _plain(system: TSK | System) -> _Driver:
    def drive(x: _Floats) -> tuple[_Floats, _Floats]:
        output = np.atleast_1d(np.asarray(system(*x), dtype=float))
        return output, output

    return drive


def _together(teacher: _Driver, system: TSK | System, target: str) -> _Driver:
    learner = _plain(system)

    def drive(x: _Floats) -> tuple[_Floats, _Floats]:
        alone = teacher(x)[0]
        both = alone + learner(x)[0]
        return both, both if target == "sum" else alone

    return drive


def _outputs_of(system: TSK | System, inputs: _Floats) -> _Floats:
    outputs = np.asarray(system(inputs), dtype=float)
    return outputs.reshape(len(inputs), -1)


def _mean_square(shown: _Floats, outputs: _Floats) -> float:
    del outputs
    return float(np.mean(shown[:, 0] ** 2))


@dataclasses.dataclass
class _Stage:
    """Where episodes take place, and what they cost."""

    plant: Plant
    episodes: list[int]
    steps: int
    cost: Callable[[_Floats, _Floats], float]

    def run(self, drive: _Driver) -> tuple[tuple[_Floats, _Floats], float, int]:
        """Return the samples and the mean cost of the whole episodes, and how many were lost."""
        inputs: list[_Floats] = []
        targets: list[_Floats] = []
        costs: list[float] = []
        for episode in self.episodes:
            shown, applied, recorded, whole = self._episode(drive, episode)
            if whole:
                inputs.extend(shown[:-1])
                targets.extend(recorded)
                costs.append(self.cost(np.array(shown), np.array(applied)))
        lost = len(self.episodes) - len(costs)
        return (np.array(inputs), np.array(targets)), float(np.mean(costs or [np.inf])), lost

    def _episode(
        self, drive: _Driver, episode: int
    ) -> tuple[list[_Floats], list[_Floats], list[_Floats], bool]:
        """Return what was shown, applied and recorded, and whether the episode was whole."""
        x = _shown(self.plant.reset(episode))
        shown: list[_Floats] = [x]
        applied: list[_Floats] = []
        recorded: list[_Floats] = []
        for step in range(1, self.steps + 1):
            if not np.isfinite(x).all():
                return shown, applied, recorded, False
            try:
                output, record = drive(x)
            except NoRuleFiresError:
                return shown, applied, recorded, False
            seen, over = self.plant.step(output if len(output) > 1 else output.item())
            x = _shown(seen)
            shown.append(x)
            applied.append(output)
            recorded.append(record)
            if over and step < self.steps:
                return shown, applied, recorded, False
        return shown, applied, recorded, bool(np.isfinite(x).all())


def _shown(seen: ArrayLike) -> _Floats:
    return np.atleast_1d(np.asarray(seen, dtype=float))
