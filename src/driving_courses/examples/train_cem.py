"""Learns to follow a line: the cross-entropy method on a linear law, minutes on two cores.

    python3 examples/train_cem.py [POLICY.json] [--course LineFollow] [--generations 10]
"""

import argparse
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from driving_courses.search import drive, make, search

import driving_courses

COURSES = [name.partition("/")[2].removesuffix("-v0") for name in driving_courses.ENVIRONMENTS]
SCORE = ("outcome", "lap_times_s", "rms_lateral_m", "max_lateral_m", "rms_error_m")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("policy", type=Path, nargs="?", default=Path("out/policy.json"))
    parser.add_argument("--course", default="LineFollow", choices=COURSES)
    parser.add_argument("--generations", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=15.0, help="simulated, each try (15)")
    given, began = parser.parse_args(), time.monotonic()
    if given.generations < 1 or given.seconds < 0.1:
        parser.error("--generations must be 1 or more, --seconds 0.1 or more")
    try:
        given.policy.parent.mkdir(parents=True, exist_ok=True)
        given.policy.open("a", encoding="utf-8").close()
    except OSError as error:
        parser.error(f"{given.policy}: {error.strerror}")
    for number, generation in enumerate(search(given.course, given.generations, given.seconds)):
        scores, policy = generation.scores, generation.policy
        policy.save(given.policy)
        print(f"generation {number}: best {max(scores):.2f}, mean {np.mean(scores):.2f},"
              f" {time.monotonic() - began:.0f} s", flush=True)
    _, lap = drive(make(given.course, 300.0), policy, 0)
    score = {key: value for key, value in lap.items() if key in SCORE}
    replace(policy, score=score).save(given.policy)
    print(f"{given.policy}: {score}")


if __name__ == "__main__":
    main()
