"""Learns to follow a line: the cross-entropy method on a linear law, minutes on two cores.

    python3 examples/train_cem.py [POLICY.json] [--course LineFollow] [--generations 10]
"""

import argparse
import multiprocessing
import time
from pathlib import Path

import gymnasium
import numpy as np
from driving_courses.policy import LinearPolicy

import driving_courses

PEOPLE, ELITE = 14, 4  # candidates a generation, and how many of them are kept
COURSES = [name.partition("/")[2].removesuffix("-v0") for name in driving_courses.ENVIRONMENTS]
SCORE = ("outcome", "lap_times_s", "rms_lateral_m", "max_lateral_m", "rms_error_m")
STARTS = {"sideways": (-0.05, 0.05), "turn": (-0.1, 0.1)}


def make(course, s, **more):
    name = f"driving_courses/{course}-v0"
    return gymnasium.make(name, observation="features", duration=s, **more)


def policy_of(numbers, course, space, score):
    """Numbers: a speed, a turn, and how much each band's column turns it; 1 is the most."""
    columns = np.stack([np.zeros(3 * (len(numbers) - 2)), np.kron(numbers[2:], [0, 1, 0])])
    low, high = (bound.astype(float).round(6) for bound in (space.low, space.high))
    made = {"action": "twist"} | driving_courses.ENVIRONMENTS[f"driving_courses/{course}-v0"]
    return LinearPolicy(made["course"], made["action"], (columns * high[:, None]).tolist(),
                        (numbers[:2] * high).tolist(), low.tolist(), high.tolist(), score)


def drive(env, policy, seed):
    """The sum of rewards, and what the environment says at the end."""
    (features, info), total, over = env.reset(seed=seed), 0.0, False
    while not over:
        features, reward, ended, late, info = env.step(np.array(policy.act(features), np.float32))
        total, over = total + reward, ended or late
    return total, info


def try_out(task):
    """In a process of the pool: one candidate, in that process's own environment."""
    course, seconds, numbers, seed = task
    if not hasattr(try_out, "env"):
        try_out.env = make(course, seconds, randomise=STARTS, timestep=0.004)
    return drive(try_out.env, policy_of(numbers, course, try_out.env.action_space, {}), seed)[0]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("policy", type=Path, nargs="?", default=Path("out/policy.json"))
    parser.add_argument("--course", default="LineFollow", choices=COURSES)
    parser.add_argument("--generations", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=15.0, help="simulated, each try (15)")
    given, random, began = parser.parse_args(), np.random.default_rng(0), time.monotonic()
    if given.generations < 1 or given.seconds < 0.1:
        parser.error("--generations must be 1 or more, --seconds 0.1 or more")
    try:
        given.policy.parent.mkdir(parents=True, exist_ok=True)
        given.policy.open("a", encoding="utf-8").close()
    except OSError as error:
        parser.error(f"{given.policy}: {error.strerror}")
    env = make(given.course, 300.0)
    bands = env.observation_space.shape[0] // 3
    mean, spread = np.r_[0.4, np.zeros(1 + bands)], np.r_[0.2, np.full(1 + bands, 0.8)]
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        for generation in range(given.generations):
            people = np.vstack([mean, random.normal(mean, spread, (PEOPLE - 1, len(mean)))])
            tries = [(given.course, given.seconds, each, generation) for each in people]
            scores = pool.map(try_out, tries, 1)
            best = people[np.argsort(scores)[-ELITE:]]
            mean, spread = best.mean(axis=0), best.std(axis=0) + 0.05 / (1 + generation)
            policy_of(mean, given.course, env.action_space, {}).save(given.policy)
            print(f"generation {generation}: best {max(scores):.2f}, mean {np.mean(scores):.2f},"
                  f" {time.monotonic() - began:.0f} s", flush=True)
    _, lap = drive(env, policy_of(mean, given.course, env.action_space, {}), 0)
    score = {key: value for key, value in lap.items() if key in SCORE}
    policy_of(mean, given.course, env.action_space, score).save(given.policy)
    print(f"{given.policy}: {score}")


if __name__ == "__main__":
    main()
