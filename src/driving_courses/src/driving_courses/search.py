"""The cross-entropy method on a linear law from features to an action, in two processes."""

from __future__ import annotations

import multiprocessing
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

import driving_courses
from driving_courses.policy import LinearPolicy

PEOPLE, ELITE = 14, 4  # candidates a generation, and how many of them are kept
STARTS = {"sideways": (-0.05, 0.05), "turn": (-0.1, 0.1)}  # m, rad: the best fit all of them


@dataclass(frozen=True)
class Generation:
    """What came of one generation."""

    scores: list[float]  # of each candidate: the sum of its rewards
    policy: LinearPolicy  # the mean of the best


def search(course: str, generations: int, seconds: float) -> Iterator[Generation]:
    """Generation after generation, each one line of candidates that drive `seconds` (simulated).

    course: the environment's name without v0, such as LineFollow. Equal arguments give equal bits.
    Candidates are tried in processes that are spawned: a script needs `if __name__ == "__main__":`.
    """
    env, random = make(course, seconds), np.random.default_rng(0)
    bands, space = env.observation_space.shape[0] // 3, env.action_space
    env.close()
    mean, spread = np.r_[0.4, np.zeros(1 + bands)], np.r_[0.2, np.full(1 + bands, 0.8)]
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        for generation in range(generations):
            people = np.vstack([mean, random.normal(mean, spread, (PEOPLE - 1, len(mean)))])
            tries = [(course, seconds, each, generation) for each in people]
            scores = pool.map(_try_out, tries, 1)
            best = people[np.argsort(scores)[-ELITE:]]
            mean, spread = best.mean(axis=0), best.std(axis=0) + 0.05 / (1 + generation)
            yield Generation(scores, policy_of(mean, course, space))


def make(course: str, seconds: float, **more: Any) -> gymnasium.Env:
    """The environment of that name with features, for `seconds` (simulated) at most."""
    name = f"driving_courses/{course}-v0"
    return gymnasium.make(name, observation="features", duration=seconds, **more)


def policy_of(numbers: np.ndarray, course: str, space: spaces.Box) -> LinearPolicy:
    """A policy by few numbers (2 + bands,), 1 being the most that the space of actions allows: a
    speed, a turn, and how much each band's column turns."""
    columns = np.stack([np.zeros(3 * (len(numbers) - 2)), np.kron(numbers[2:], [0, 1, 0])])
    low, high = (bound.astype(float).round(6) for bound in (space.low, space.high))
    made = {"action": "twist"} | driving_courses.ENVIRONMENTS[f"driving_courses/{course}-v0"]
    return LinearPolicy(made["course"], made["action"], (columns * high[:, None]).tolist(),
                        (numbers[:2] * high).tolist(), low.tolist(), high.tolist(), {})


def drive(env: gymnasium.Env, policy: LinearPolicy, seed: int) -> tuple[float, dict[str, Any]]:
    """One episode: the sum of its rewards, and what the environment says at the end."""
    (features, info), total, over = env.reset(seed=seed), 0.0, False
    while not over:
        features, reward, ended, late, info = env.step(np.array(policy.act(features), np.float32))
        total, over = total + reward, ended or late
    return total, info


def _try_out(task: tuple[str, float, np.ndarray, int]) -> float:
    """In a process of the pool: one candidate, in that process's own environment."""
    course, seconds, numbers, seed = task
    if not hasattr(_try_out, "env"):
        _try_out.env = make(course, seconds, randomise=STARTS, timestep=0.004)
    return drive(_try_out.env, policy_of(numbers, course, _try_out.env.action_space), seed)[0]
