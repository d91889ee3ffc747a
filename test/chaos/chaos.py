#!/usr/bin/env python3
"""Does one bad thing at a random moment to drive after drive, and says what came of it.

    chaos.py [--rounds N] [--seed N] [--course NAME] [--only FAULT]

A seed is one round, the next round has the next. Exit code 0: nothing found; 1: something, whose
files stay in out/chaos/; 2: could not run.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
from collections import Counter
from pathlib import Path

from course import COURSES, Course
from faults import faults_of, set_loopback
from rounds import RESULTS, Play, drawn

from run_session.interruption import interruptible

ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "out" / "chaos"
USUAL_ROUNDS = 20
INSIDE = "CHAOS_INSIDE"  # environment variable: this is the second start
NAMESPACES = ["unshare", "--map-root-user", "--net", "--mount"]


def main(words: list[str] | None = None) -> int:
    """The exit code."""
    options = _parser().parse_args(words)
    known = [fault.name for fault in faults_of(options.course.drivers)]
    if not any(name.startswith(options.only) for name in known):
        return _wrong(f"no fault begins with {options.only!r} (ONLY=); there are: "
                      f"{', '.join(known)}")
    if INSIDE not in os.environ:
        return _start_inside()
    set_loopback(True)
    played, found = Counter(), Counter()
    try:
        with interruptible():
            for seed in range(options.seed, options.seed + options.rounds):
                _play(seed, options, played, found)
    except KeyboardInterrupt:
        pass
    print(f"{'fault':34} rounds findings")
    for title, count in sorted(played.items()):
        print(f"{title:34} {count:6} {found[title]:8}")
    return int(any(found.values()))


def _play(seed: int, options: argparse.Namespace, played: Counter, found: Counter) -> None:
    course = options.course
    this = drawn(course, seed, options.only)
    folder, results = OUT / f"{course.name}-{seed}", OUT / f"{course.name}-results"
    shutil.rmtree(folder, ignore_errors=True)
    faults = Play(this, folder, results).faults()
    played[this.title] += 1
    for fault in faults:
        print(f"{course.name} {seed}: {this.title}: {fault}", flush=True)
    if not faults:
        shutil.rmtree(folder)
        return
    found[this.title] += 1
    only = f" ONLY='{options.only}'" if options.only else ""
    print(f"  again: make chaos COURSE={course.name} SEED={seed} ROUNDS=1{only}", flush=True)
    if not (folder / RESULTS).exists() and results.exists():
        shutil.move(results, folder / RESULTS)


def _start_inside() -> int:
    """Once more, in a network and a mount namespace of its own: nobody else's suffers."""
    if not shutil.which("unshare") or subprocess.run(
            [*NAMESPACES, "true"], capture_output=True, check=False).returncode:
        return _wrong("this machine allows no namespaces: in Docker give --privileged")
    os.environ[INSIDE] = "1"
    sys.stdout.flush()
    os.execvp(NAMESPACES[0], [*NAMESPACES, sys.executable, *sys.argv])


def _wrong(text: str) -> int:
    print(f"chaos: {text}", file=sys.stderr)
    return 2


class _Parser(argparse.ArgumentParser):
    """One line for a mistake."""

    def error(self, message: str) -> None:
        sys.exit(_wrong(message))


def _whole(text: str) -> int:
    if not re.fullmatch(r"[0-9]{1,9}", text) or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number, 1 or more")
    return int(text)


def _course(name: str) -> Course:
    if name not in COURSES:
        raise argparse.ArgumentTypeError(f"no course {name!r}; there are: {', '.join(COURSES)}")
    return COURSES[name]


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="chaos", description=__doc__,
                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=_whole, default=USUAL_ROUNDS)
    parser.add_argument("--seed", type=_whole, default=1)
    parser.add_argument("--course", type=_course, default="course")
    parser.add_argument("--only", default="", help="the beginning of a fault's name, as: kill")
    return parser


if __name__ == "__main__":
    sys.exit(main())
