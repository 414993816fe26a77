"""What a study file may run: an experiment, a technique that learns a pursuit, a function."""

from __future__ import annotations

import importlib
import inspect
import math
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, Protocol

import fuzzyrs._fuzzyrs as native
from fuzzyrs._fuzzyrs import Control, OneOnOne
from fuzzyrs.errors import CancelledError, from_kind
from fuzzyrs.studies.settings import changed, unknown
from fuzzyrs.studies.store import Point, Run
from fuzzyrs.studies.work import FunctionWork, Work, timed


class Subject(Protocol):
    """What is studied: it knows its settings, and becomes work once some of them are fixed."""

    @property
    def name(self) -> str:
        """What it is called in a database."""

    def exists(self) -> None:
        """Raise an error if there is no such experiment, technique or function."""

    def check(self, changes: Mapping[str, Any]) -> None:
        """Raise an error if these settings can't be changed, or not to these values."""

    def work(self, fixed: Mapping[str, Any], record: bool) -> Work:
        """Return what runs the points of a grid, with some settings that all of them share."""


@dataclass(frozen=True)
class ExperimentSubject:
    """An experiment with other settings than the thesis's; its outcome is that of a seed.

    Attributes
    ----------
    id : str
        Such as "table-6-3".
    """

    id: str

    @property
    def name(self) -> str:
        """The experiment's id, as its kind and itself."""
        return f"experiment {self.id}"

    def exists(self) -> None:
        """Make the experiment."""
        self.experiment({})

    def check(self, changes: Mapping[str, Any]) -> None:
        """Make the experiment with these settings."""
        self.experiment(changes)

    def experiment(self, changes: Mapping[str, Any]) -> Any:
        """Return the experiment with some other settings."""
        # The experiments need the studies' database, so they can't be there first.
        from fuzzyrs.experiments.registry import find

        kind: Any = find(self.id)
        default = getattr(kind(), "settings", None)
        if default is None:
            raise from_kind("unsuitable", f"the experiment {self.id!r} has no settings to change")
        return kind(changed(default, changes))

    def work(self, fixed: Mapping[str, Any], record: bool) -> Work:
        """Return what runs the experiment's seeds."""
        return _SettingsWork(self, dict(fixed), record)

    def run(self, changes: Mapping[str, Any], seed: int, control: Control) -> dict[str, Any]:
        """Run one seed; times are the database's."""
        outcome = dict(self.experiment(changes).run_seed(seed, control))
        outcome.pop("seconds", None)
        return outcome


#: The techniques by which a pursuer learns, with the thesis's settings.
TECHNIQUES: dict[str, Callable[[], Any]] = {
    "q_lambda": native.QLambdaTraining,
    "minimax_q": native.MinimaxQTraining,
    "reward_ga": native.RewardGaTraining,
    "qlbgflc": native.QlbgflcTraining,
    "qlfis": native.QlfisTraining,
    "dai": native.DaiTraining,
    "ianfis": native.IanfisTraining,
    "igbflc": native.IgbflcTraining,
}


@dataclass(frozen=True)
class Pursuit:
    """The settings of a pursuit that is learned and then tested.

    Attributes
    ----------
    learner : settings
        The technique's.
    game : OneOnOne
        The game.
    starts : tuple of (float, float)
        Where the evader starts in the test games (m); there may be none.
    max_time : float
        When a test game is given up (s).
    """

    learner: Any
    game: OneOnOne = field(default_factory=OneOnOne)
    starts: tuple[tuple[float, float], ...] = ()
    max_time: float = 60.0

    def test(self, pursuer: Any, control: Control) -> native.Outcomes:
        """Let a pursuer play from the starts."""
        return self.game.play_many(
            pursuer, evader_starts=self.starts, max_time=self.max_time, control=control
        )


@dataclass(frozen=True)
class TechniqueSubject:
    """A technique by which a pursuer learns to capture an evader that flees along a line.

    Its outcomes are the learning time (s), mean and last value of what the technique tells of its
    progress, and the time of capture (s) from each start, which is missing where there was none.

    Attributes
    ----------
    technique : str
        One of `TECHNIQUES`.
    """

    technique: str

    @property
    def name(self) -> str:
        """The technique's name, as its kind and itself."""
        return f"technique {self.technique}"

    def exists(self) -> None:
        """Make the settings."""
        self._pursuit({})

    def check(self, changes: Mapping[str, Any]) -> None:
        """Make the settings, and see whether a training and the tests take them."""
        pursuit = self._pursuit(changes)
        stopped = Control()
        stopped.cancel()
        # What is stopped at once has looked at its settings.
        with suppress(CancelledError):
            native.train(pursuit.game, pursuit.learner, control=stopped)
        if pursuit.starts:
            with suppress(CancelledError):
                pursuit.test(None, stopped)

    def _pursuit(self, changes: Mapping[str, Any]) -> Pursuit:
        if self.technique not in TECHNIQUES:
            raise unknown("technique", self.technique, TECHNIQUES)
        pursuit: Pursuit = changed(Pursuit(TECHNIQUES[self.technique]()), changes)
        return pursuit

    def work(self, fixed: Mapping[str, Any], record: bool) -> Work:
        """Return what trains and tests."""
        return _SettingsWork(self, dict(fixed), record)

    def run(self, changes: Mapping[str, Any], seed: int, control: Control) -> dict[str, Any]:
        """Train once, and test."""
        pursuit = self._pursuit(changes)
        trained = native.train(pursuit.game, pursuit.learner, seed=seed, control=control)
        outcome = {"learning time": trained.learning_time}
        for name, values in trained.history.items():
            if len(values):
                outcome[f"mean of {name}"] = float(values.mean())
                outcome[f"last of {name}"] = float(values[-1])
        if pursuit.starts:
            tested = pursuit.test(trained.controller, control)
            for start, time in zip(pursuit.starts, tested.capture_time, strict=True):
                place = ", ".join(f"{number:g}" for number in start)
                outcome[f"capture time from ({place})"] = float(time)
        return {name: None if math.isnan(value) else value for name, value in outcome.items()}


class _Changeable(Protocol):
    def run(self, changes: Mapping[str, Any], seed: int, control: Control) -> dict[str, Any]:
        """Run once with changed settings."""


@dataclass(frozen=True)
class _SettingsWork:
    """Work whose points are changes of settings."""

    subject: _Changeable
    fixed: dict[str, Any]
    record: bool

    def run(self, point: Point, seed: int, control: Control | None = None) -> Run:
        """Run once with the settings of a point."""
        changes = {**self.fixed, **point}
        return timed(
            lambda: self.subject.run(changes, seed, control or Control()),
            point,
            seed,
            record=self.record,
        )


@dataclass(frozen=True)
class FunctionSubject:
    """A function of the user's, by its place.

    Attributes
    ----------
    place : str
        As "module:function".
    folders : sequence of pathlib.Path
        Where modules are looked for before all others.
    """

    place: str
    folders: Sequence[Path]

    @property
    def name(self) -> str:
        """The function's place, as its kind and itself."""
        return f"function {self.place}"

    def exists(self) -> None:
        """Import the function."""
        self._function()

    def check(self, changes: Mapping[str, Any]) -> None:
        """See whether the function takes these arguments."""
        function = self._function()
        try:
            signature = inspect.signature(function)
        except (TypeError, ValueError):
            return
        kinds = {parameter.kind for parameter in signature.parameters.values()}
        known = [name for name in signature.parameters if name not in {"seed", "control"}]
        if inspect.Parameter.VAR_KEYWORD not in kinds:
            for name in changes:
                if name not in known:
                    raise unknown(f"argument of {self.place}", name, known)
        extra = {"control": None} if "control" in signature.parameters else {}
        try:
            signature.bind(seed=0, **changes, **extra)
        except TypeError as error:
            message = f"{self.place} can't be called with a seed and these settings: {error}"
            raise from_kind("unsuitable", message) from error

    def _function(self) -> Callable[..., Any]:
        module, colon, name = self.place.partition(":")
        if not (module and colon and name):
            message = f"the function must be given as 'module:function', got {self.place!r}"
            raise from_kind("bad_name", message)
        for folder in map(str, reversed(self.folders)):
            if folder not in sys.path:
                sys.path.insert(0, folder)
        try:
            found = getattr(importlib.import_module(module), name, None)
        except ImportError as error:
            message = f"cannot import {module!r} from here: {error}"
            raise from_kind("unknown_name", message) from error
        if not callable(found):
            raise from_kind("unknown_name", f"there is no function {name!r} in module {module!r}")
        return found  # type: ignore[no-any-return]

    def work(self, fixed: Mapping[str, Any], record: bool) -> Work:
        """Return what calls the function."""
        function = self._function()
        return FunctionWork(partial(function, **fixed) if fixed else function, record)
