"""Systems that many tests use."""

from __future__ import annotations

import os
import signal
import sys

import pytest
from hypothesis import settings

import fuzzyrs as fz
from fuzzyrs.experiments import drawing, saved

# The same examples in every run, so that a change is judged by what it changes;
# FUZZYRS_EXPLORE=1 draws new ones. How long one takes says nothing about whether it is right.
EXPLORE = "FUZZYRS_EXPLORE" in os.environ
settings.register_profile("fuzzyrs", deadline=None, derandomize=not EXPLORE)
settings.load_profile("fuzzyrs")


def pytest_configure():
    """Answer Ctrl-C even where a shell began this in the background, which ignores it."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def steer() -> fz.TSK:
    """Nine Gaussian rules that steer a pursuer."""
    angle = fz.Variable.evenly("angle", (-1, 1), "NZP")
    rate = fz.Variable.evenly("rate", (-1, 1), "NZP")
    consequents = [[-0.5, -0.25, 0], [-0.25, 0, 0.25], [0, 0.25, 0.5]]
    return fz.TSK([angle, rate], consequents, name="steer", output="steering")


@pytest.fixture(scope="session")
def gap() -> fz.TSK:
    """One triangle from 0 to 2 on a universe to 10: elsewhere no rule fires."""
    return fz.TSK([fz.Variable("x", (0, 10), {"low": fz.triangular(0, 1, 2)})], [3], name="gap")


@pytest.fixture
def game() -> fz.OneOnOne:
    """The game of section 6.5.2."""
    return fz.OneOnOne()


def _refuse(*_args, **_options):
    raise AssertionError("figures are drawn from what is saved; nothing may learn or play")


@pytest.fixture
def drawn(monkeypatch):
    """Draw the saved result of an experiment while nobody can learn or play; return the paths."""

    def draw(experiment, folder):
        result = saved.load(folder, experiment)
        with monkeypatch.context() as patch:
            patch.setattr(drawing, "FORMS", {"svg": drawing.FORMS["svg"]})
            for kind in (fz.OneOnOne, fz.TwoPursuers, fz.ManyOnMany, fz.WallFollowing):
                for play in ("play", "play_many", "capture_times"):
                    if hasattr(kind, play):
                        patch.setattr(kind, play, _refuse)
            for name, module in list(sys.modules.items()):
                if name.startswith("fuzzyrs."):
                    for learn in ("train", "learn_mdp", "learn_coupling", "cross_play"):
                        if hasattr(module, learn):
                            patch.setattr(module, learn, _refuse)
            return list(drawing.draw(experiment, result, folder))

    return draw
