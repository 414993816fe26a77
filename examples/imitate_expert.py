"""Let a fuzzy system learn from an expert on a plant of your own, and get better than it.

Here: a pendulum is held upright by a torque that a timid PD controller chooses. The system learns
what the PD does; then both act together and it learns what both did, and so on.
"""

import numpy as np

import fuzzyrs as fz


class Pendulum:
    """angle'' = 9.81 sin(angle) - 0.3 rate + torque, in steps of 0.02 s."""

    def reset(self, episode):
        """Begin at one of four angles (rad)."""
        self.angle, self.rate = [0.3, -0.3, 0.15, -0.2][episode], 0.0
        return [self.angle, self.rate]

    def step(self, torque):
        """Act for one step; the pendulum is lost when it lies flat."""
        torque = np.clip(torque, -8, 8)
        self.rate += 0.02 * (9.81 * np.sin(self.angle) - 0.3 * self.rate + torque)
        self.angle += 0.02 * self.rate
        return [self.angle, self.rate], abs(self.angle) > 1.5


angle = fz.Variable.evenly("angle", (-0.6, 0.6), ["far left", "left", "up", "right", "far right"])
rate = fz.Variable.evenly("rate", (-2, 2), ["fast left", "left", "still", "right", "fast right"])
start = fz.TSK([angle, rate], np.zeros((5, 5)), output="torque", no_rule_fires=0.0)

pd = fz.PD(-14, -2.5)
learned = fz.imitate(lambda x: pd(*x), Pendulum(), start, steps=200, rounds=3)

print(f"the PD alone: mean squared angle {learned.expert_cost:.5f}")
for number, round_ in enumerate(learned.rounds, start=1):
    print(f"round {number}: {round_.cost:.5f}, {round_.lost} lost, {round_.samples} samples")
print(f"learned: {learned.system}")
