"""Learn from reward to drive out of a valley: Gymnasium's MountainCarContinuous-v0.

The engine is too weak to climb at once, every action costs, and only the flag is rewarded: a
learner that explores timidly finds out that it is best to do nothing. The help here is a potential,
the car's mechanical energy: gamma*P(s') - P(s) is added to the reward, which leaves the best policy
the best (Ng, Harada and Russell 1999).
"""

import math
import sys

import gymnasium

import fuzzyrs as fz

DISCOUNT = 0.99
SCALE = 0.1


class Shaped(gymnasium.Wrapper):
    """Adds the potential's rise to the reward."""

    def __init__(self, env, weight):
        super().__init__(env)
        self.weight = weight

    def potential(self, state):
        """Mechanical energy, in units of the hill's slope."""
        position, speed = state
        return self.weight * (math.sin(3 * position) / 3 + speed**2 / 2 / 0.0025)

    def reset(self, **options):
        """Begin an episode."""
        self.state, info = self.env.reset(**options)
        return self.state, info

    def step(self, action):
        """Act for one step."""
        state, reward, terminated, truncated, info = self.env.step(action)
        ahead = 0.0 if terminated else DISCOUNT * self.potential(state)
        shaped = SCALE * float(reward) + ahead - self.potential(self.state)
        self.state = state
        return state, shaped, terminated, truncated, info


def learn(seed, episodes=100, weight=1.0, noise=0.5, agent=fz.FuzzyActorCritic, **options):
    """Learn with the potential in this weight, 0 for none; the result's rewards are shaped."""

    def falling(rate):  # to a tenth
        return fz.Schedule.linear(rate, rate / 10, episodes)

    inputs = [
        fz.Variable.evenly("position", (-1.2, 0.6), "ABCDE"),
        fz.Variable.evenly("speed", (-0.07, 0.07), "ABCDE"),
    ]
    force = fz.TSK(inputs, [0] * 25, output="force", no_rule_fires=0.0)
    learner = agent(
        force,
        discount=DISCOUNT,
        critic_rate=falling(0.1),
        actor_rate=falling(0.2),
        noise=falling(noise),
        seed=seed,
    )
    env = Shaped(gymnasium.make("MountainCarContinuous-v0"), weight)
    return fz.fit(env, learner, episodes=episodes, seed=seed, **options)


def returns(controller, episodes=10):
    """What a controller gets without shaping, in episodes that no learner has seen."""
    env = gymnasium.make("MountainCarContinuous-v0")
    totals = []
    for episode in range(episodes):
        state, _ = env.reset(seed=10_000 + episode)
        total, over = 0.0, False
        while not over:
            force = min(max(controller(*map(float, state)), -1.0), 1.0)
            state, reward, terminated, truncated, _ = env.step([force])
            total, over = total + float(reward), terminated or truncated
        totals.append(total)
    return totals


if __name__ == "__main__":
    episodes = int(sys.argv[1]) if len(sys.argv) > 1 else 40
    learned = learn(seed=1, episodes=episodes, evaluate_every=episodes // 4, evaluations=2)
    print(
        f"steps to the flag, first and last episodes: {learned.lengths[:3]} {learned.lengths[-3:]}"
    )
    totals = returns(learned.controller)
    print(f"return without shaping: {sum(totals) / len(totals):.1f} (90 counts as solved)")
