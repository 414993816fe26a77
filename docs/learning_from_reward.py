"""Prints the tables of learning-from-reward.md: python docs/learning_from_reward.py [seeds]."""

from __future__ import annotations

import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

import fuzzyrs as fz

sys.path.insert(0, str(Path(__file__).parents[1] / "examples"))
import mountain_car
import pendulum

# Other seeds, 100 and above, chose the settings.
FIRST_SEED = 0
SWINGS, CLIMBS = 400, 100
# How often a learner is looked at.
PARTS = 4


def falling(rate: float, episodes: int = SWINGS) -> fz.Schedule:
    """A rate that falls to a tenth."""
    return pendulum.falling(rate, episodes)


def fuzzy_actor_critic(seed: int) -> Any:
    """The example."""
    return pendulum.learn(seed, SWINGS, evaluate_every=SWINGS // PARTS, evaluations=10)


def on_the_pendulum(agent: Any, scale: float, seed: int) -> Any:
    """The example with another learner."""
    env = gymnasium.make("Pendulum-v1")
    env = gymnasium.wrappers.TransformReward(env, lambda reward: scale * float(reward))
    options = {"evaluate_every": SWINGS // PARTS, "evaluations": 10}
    return fz.fit(env, agent(seed), episodes=SWINGS, seed=seed, **options)


def consequents(seed: int) -> Any:
    """QLFIS that leaves membership functions as they are."""
    rates = {"actor_rate": falling(0.7), "critic_rate": falling(0.1), "noise": falling(1.0)}
    return fz.QLFIS(pendulum.torque(), tune="consequents", seed=seed, **rates)


def qlfis(seed: int) -> Any:
    """QLFIS; smaller rewards and more of the actor's rate do it good."""
    rates = {"actor_rate": falling(1.0), "critic_rate": falling(0.1), "noise": falling(1.0)}
    return fz.QLFIS(pendulum.torque(), seed=seed, **rates)


def neural(seed: int) -> Any:
    """A neural critic, consequents only."""
    rates = {"actor_rate": falling(0.7), "critic_rate": falling(0.01), "noise": falling(1.0)}
    return fz.NeuralActorCritic(pendulum.torque(), tune="consequents", seed=seed, **rates)


def table(seed: int) -> Any:
    """Q(λ) on a grid."""
    grid = fz.Discretiser([(-1, 1, 9), (-1, 1, 9), (-8, 8, 9)])
    rates = {"learning_rate": falling(0.3), "exploration": falling(0.2)}
    return fz.QLambdaAgent(grid, [-2, -1, 0, 1, 2], trace_decay=0.9, seed=seed, **rates)


PENDULUM = {
    "fuzzy actor-critic": None,
    "QLFIS, consequents only": (consequents, pendulum.SCALE),
    "QLFIS": (qlfis, 1 / 100),
    "neural critic, consequents only": (neural, pendulum.SCALE),
    "Q(λ), 9 × 9 × 9 states, 5 actions": (table, pendulum.SCALE),
}
MOUNTAIN_CAR = {
    "fuzzy actor-critic, noise 0.5": {"weight": 0.0},
    "the same, noise 1": {"weight": 0.0, "noise": 1.0},
    "the same, noise 0.5, with the potential": {"weight": 1.0},
    "QLFIS, consequents only, noise 1": {
        "weight": 0.0,
        "noise": 1.0,
        "agent": partial(fz.QLFIS, tune="consequents"),
    },
    "QLFIS, noise 0.5, with the potential": {"weight": 1.0, "agent": fz.QLFIS},
}


def swing(name: str, seed: int) -> list[float]:
    """Mean returns of the controller alone while it learns, and the best's."""
    scale = pendulum.SCALE
    if name == "fuzzy actor-critic":
        learned = fuzzy_actor_critic(seed)
    else:
        agent, scale = PENDULUM[name]
        learned = on_the_pendulum(agent, scale, seed)
    return [*(learned.evaluations[1] / scale), learned.best_evaluation / scale]


def climb(name: str, seed: int) -> list[float]:
    """Mean returns without shaping of the controller alone while it learns, and the best's."""
    every = CLIMBS // PARTS
    now = []

    def look(episode: fz.Episode, so_far: fz.Fit) -> None:
        if episode.number % every == 0:
            now.append(float(np.mean(mountain_car.returns(so_far.agent.actor))))

    options = {"evaluate_every": every, "evaluations": 5, "callback": look}
    learned = mountain_car.learn(seed, CLIMBS, **options, **MOUNTAIN_CAR[name])
    return [*now, float(np.mean(mountain_car.returns(learned.controller)))]


def row(name: str, results: list[list[float]]) -> str:
    """Quartiles over the seeds, as a row of a table."""
    low, middle, high = np.percentile(results, [25, 50, 75], axis=0).round().astype(int)
    cells = (f"{m} ({a} to {b})" for a, m, b in zip(low, middle, high, strict=True))
    return f"| {name} | " + " | ".join(cells) + " |"


def main() -> None:
    """Run all seeds and print the tables."""
    seeds = range(FIRST_SEED, FIRST_SEED + int(sys.argv[1] if len(sys.argv) > 1 else 12))
    with ProcessPoolExecutor() as pool:
        for title, episodes, names, run in (
            ("Pendulum-v1", SWINGS, PENDULUM, swing),
            ("MountainCarContinuous-v0", CLIMBS, MOUNTAIN_CAR, climb),
        ):
            parts = [episodes * part // PARTS for part in range(1, PARTS + 1)]
            print(f"\n{title}, {len(seeds)} seeds: median (quartiles)\n")
            print("| learner | " + " | ".join(f"after {part}" for part in parts) + " | best kept |")
            print("|---" * (PARTS + 2) + "|")
            for name in names:
                print(row(name, list(pool.map(partial(run, name), seeds))), flush=True)


if __name__ == "__main__":
    main()
