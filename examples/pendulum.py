"""Learn from reward to swing a pendulum up and hold it there: Gymnasium's Pendulum-v1.

Fuzzy actor-critic with five terms for each of three observations. Rewards from -16 to 0 are brought
to the order of 1, which the learning rates are made for.
"""

import sys

import gymnasium

import fuzzyrs as fz

SCALE = 1 / 16


def torque():
    """A controller that does nothing yet."""
    inputs = [
        fz.Variable.evenly("cosine", (-1, 1), "ABCDE"),
        fz.Variable.evenly("sine", (-1, 1), "ABCDE"),
        fz.Variable.evenly("speed", (-8, 8), "ABCDE"),
    ]
    return fz.TSK(inputs, [0] * 125, output="torque", no_rule_fires=0.0)


def falling(rate, episodes):
    """A rate that falls to a tenth."""
    return fz.Schedule.linear(rate, rate / 10, episodes)


def learn(seed, episodes=400, **options):
    """Learn; the rewards of the result are scaled."""
    env = gymnasium.make("Pendulum-v1")
    env = gymnasium.wrappers.TransformReward(env, lambda reward: SCALE * float(reward))
    agent = fz.FuzzyActorCritic(
        torque(),
        critic_rate=falling(0.1, episodes),
        actor_rate=falling(0.3, episodes),
        noise=falling(1.0, episodes),
        seed=seed,
    )
    return fz.fit(env, agent, episodes=episodes, seed=seed, **options)


if __name__ == "__main__":
    episodes = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    learned = learn(seed=1, episodes=episodes, evaluate_every=episodes // 5)
    for number, reward in zip(*learned.evaluations, strict=True):
        print(f"episode {number}: mean return {reward / SCALE:.0f} without exploration")
    print(f"the best controller: {learned.best_evaluation / SCALE:.0f}; it is {learned.controller}")
