"""Learning from an expert on plants that aren't from the thesis."""

from __future__ import annotations

import numpy as np
import pytest

import fuzzyrs as fz

TERMS = "ABCDE"


class Pendulum:
    """Held upright by a torque within ±8: angle'' = 9.81 sin(angle) - 0.3 rate + torque."""

    def reset(self, episode):
        self.angle, self.rate = [0.3, -0.3, 0.15, -0.2][episode], 0.0
        return [self.angle, self.rate]

    def step(self, torque):
        torque = np.clip(torque, -8, 8)
        self.rate += 0.02 * (9.81 * np.sin(self.angle) - 0.3 * self.rate + torque)
        self.angle += 0.02 * self.rate
        return [self.angle, self.rate], abs(self.angle) > 1.5


def expert(x):
    return -(14 * x[0] + 2.5 * x[1])


def template():
    angle = fz.Variable.evenly("angle", (-0.6, 0.6), TERMS)
    rate = fz.Variable.evenly("rate", (-2, 2), TERMS)
    return fz.TSK([angle, rate], np.zeros(25))


def imitate(*, plant=None, teacher=expert, system=None, **options):
    options = {"steps": 100, **options}
    return fz.imitate(teacher, plant or Pendulum(), system or template(), **options)


@pytest.mark.parametrize("tune", ["anfis", "genetic"])
def test_the_pupil_of_a_pendulums_expert_gets_better_than_it(tune):
    learned = imitate(tune=tune)
    first, *later = learned.rounds
    assert len(later) == 2
    assert first.samples == 400
    assert first.lost == 0
    assert learned.beats_expert
    assert learned.best.cost < 0.7 * learned.expert_cost
    assert learned.system is learned.best.system
    again = imitate(tune=tune)
    assert [r.cost for r in again.rounds] == [r.cost for r in learned.rounds]


def test_with_the_expert_alone_as_target_it_stays_as_good():
    learned = imitate(target="expert")
    for round_ in learned.rounds:
        assert round_.cost == pytest.approx(learned.expert_cost, rel=0.05)


def test_samples_are_what_was_shown_and_what_both_did():
    seen = []

    def tune(system, x, y):
        seen.append((x, y))
        return system

    imitate(tune=tune, rounds=1, episodes=[2], steps=3, system=constant(0.5))
    (x, alone), (_, both) = seen
    np.testing.assert_allclose(alone[:, 0], [expert(row) for row in x])
    np.testing.assert_allclose(both[0, 0], expert(x[0]) + 0.5)
    assert x.shape == (3, 2)
    assert x[0].tolist() == [0.15, 0.0]


def constant(value):
    system = template()
    parameters = system.parameters.copy()
    parameters[-25:] = value
    return system.with_parameters(parameters)


def test_lost_episodes_are_counted_and_never_the_best():
    learned = imitate(tune=lambda *_: constant(8.0), rounds=0)
    assert learned.best.lost == 4
    assert np.isinf(learned.best.cost)
    assert not learned.beats_expert
    assert learned.expert_lost == 0


class Exploding(Pendulum):
    """A plant that leaves the numbers."""

    def step(self, _):
        self.angle *= 1e200
        return [self.angle, 0.0], False


def test_a_plant_that_diverges_is_lost_and_ends():
    with pytest.raises(ValueError, match="the expert lost every episode"):
        imitate(plant=Exploding(), teacher=lambda _: 0.0)


class Unsteady(Pendulum):
    """A plant that bears the expert, but not twice its torque."""

    def step(self, torque):
        return super().step(np.nan if abs(torque) > 6 else torque)


def test_rounds_end_when_both_together_lose_every_episode():
    learned = imitate(plant=Unsteady(), rounds=4, steps=20, episodes=[0, 1])
    assert len(learned.rounds) == 1
    assert learned.best.lost == 0


def test_it_may_stop_when_the_expert_is_beaten():
    assert len(imitate(stop_when_better=True, rounds=5).rounds) < 6


def test_ctrl_c_gives_the_rounds_that_are_done():
    def progress(round_):
        if len(told) == 1:
            raise KeyboardInterrupt
        told.append(round_)

    told = []
    with pytest.raises(fz.ImitationInterrupted, match="interrupted after 2 rounds") as stopped:
        imitate(progress=progress, rounds=3)
    assert stopped.value.so_far.rounds[0] is told[0]


def test_an_expert_may_be_a_pd_and_its_pupil_a_rule_system():
    error, rate = (fz.Variable.evenly(n, (-1, 1), "NZP") for n in ("angle", "rate"))
    rules = "\n".join(
        f"if angle is {a} and rate is {r} then torque = 0" for a in "NZP" for r in "NZP"
    )
    system = fz.System([error, rate], fz.Output.sugeno("torque"), rules)
    learned = imitate(teacher=lambda x: fz.PD(-14, -2.5)(*x), system=system, rounds=0)
    assert isinstance(learned.system, fz.System)
    assert learned.best.lost == 0


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"rounds": -1}, ValueError, "rounds must be zero or more"),
        ({"steps": 0}, ValueError, "steps must be at least 1"),
        ({"episodes": 0}, ValueError, "episodes must be at least 1"),
        ({"target": "both"}, LookupError, "unknown target 'both'"),
        ({"tune": "anfiss"}, LookupError, "unknown way to tune 'anfiss'"),
        ({"teacher": lambda _: np.nan}, ValueError, "the expert must return a finite number"),
        ({"teacher": lambda _: [[1.0]]}, ValueError, "the expert must return a finite number"),
        ({"teacher": lambda _: [1.0, 2.0]}, ValueError, "the expert must return a finite number"),
    ],
)
def test_bad_requests_are_refused_in_words(options, error, words):
    with pytest.raises(error, match=words):
        imitate(**options)
