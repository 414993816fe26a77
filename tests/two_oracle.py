"""The game of section 8.4 in plain NumPy, from the equations as they are printed."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from oracle import RADIUS, STEP, Car, wrap

PURSUER = Car(0.5, 0.2, 0.5)
EVADER = Car(0.3, 0.2, 0.8)


def length(vector):
    return np.hypot(*vector)


def flight(kind: str, first, second) -> float:
    """The direction of EP_dir from the vectors P1E and P2E (8.8-8.11)."""
    weight = length(second) / length(first)
    units = first / length(first), second / length(second)
    vector = {
        "weighted": weight * first + second / weight,
        "weighted-units": weight * units[0] + units[1] / weight,
        "nearest": first if length(first) <= length(second) else second,
        "sum": first + second,
        "sum-of-units": units[0] + units[1],
    }[kind]
    return np.arctan2(vector[1], vector[0])


def modified_sight(offset, direction: float) -> np.ndarray:
    """P_iE' by the sine rule (8.19-8.23)."""
    ahead = np.array([np.cos(direction), np.sin(direction)])
    beta = np.arccos(np.clip(-offset @ ahead / length(offset), -1, 1))
    alpha = np.arcsin(EVADER.speed / PURSUER.speed * np.sin(beta))
    return offset + length(offset) * np.sin(alpha) / np.sin(alpha + beta) * ahead


@dataclass
class Path:
    """The poses of the pursuers and of the evader, and how they steered."""

    robots: list[np.ndarray]
    steering: list[np.ndarray] = field(default_factory=list)
    captured: bool = False


def angles(pursuers, evader, aim: str, kind: str) -> np.ndarray:
    """The angles of the pursuers (8.7, 8.24) and of the evader (8.12)."""
    offsets = [evader[:2] - pursuer[:2] for pursuer in pursuers]
    direction = flight(kind, *offsets)
    targets = {
        "line-of-sight": lambda offset: offset,
        "intercept": lambda offset: modified_sight(offset, evader[2]),
        "intercept-flight": lambda offset: modified_sight(offset, direction),
    }[aim]
    sights = [targets(offset) for offset in offsets]
    directions = [*(np.arctan2(y, x) for x, y in sights), direction]
    headings = [pursuers[0][2], pursuers[1][2], evader[2]]
    return np.array([wrap(d - h) for d, h in zip(directions, headings, strict=True)])


def play(starts, evader_start, aim, kind, strategies, steps: int = 600) -> Path:
    """Play a game; strategies steer by the angle and its rate, pursuers first."""
    first = [np.array([*start, 0.0][:3], dtype=float) for start in [*starts, evader_start]]
    path = Path([np.array(first)])
    robots = [PURSUER, PURSUER, EVADER]
    last = None
    for _ in range(steps):
        *pursuers, evader = path.robots[-1]
        if min(length(evader[:2] - p[:2]) for p in pursuers) < RADIUS:
            path.captured = True
            break
        now = angles(pursuers, evader, aim, kind)
        last = now if last is None else last
        rates = [wrap(change) / STEP for change in now - last]
        last = now
        limits = np.array([robot.max_steering for robot in robots])
        wanted = [s(a, r) for s, a, r in zip(strategies, now, rates, strict=True)]
        steering = np.clip(wanted, -limits, limits)
        moves = zip(robots, path.robots[-1], steering, strict=True)
        path.robots.append(np.array([robot.move(pose, u, STEP) for robot, pose, u in moves]))
        path.steering.append(steering)
    return path
