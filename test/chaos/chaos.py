#!/usr/bin/env python3
"""Injects one fault at a random moment into drive after drive, and reports the effects.

    chaos.py [--rounds N] [--seed N] [--course NAME] [--only FAULT]

Each round has a seed, the next round the next one. Exit code 0: no faults found; 1: some, whose
files are kept in out/chaos/; 2: could not run.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import shutil
import subprocess
import sys
from collections import Counter
from functools import partial
from pathlib import Path

from course import COURSES
from faults import faults_of, set_loopback
from restarts import PlayByHand
from rounds import RESULTS, Play, drawn

from evaluation.command_line import LARGEST_SEED, Parser, one_of, run_program
from run_session.failure import RunError

ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "out" / "chaos"
INSIDE = "CHAOS_INSIDE"  # environment variable: this is the second start
NAMESPACES = ["unshare", "--map-root-user", "--net", "--mount"]


def main(words: list[str] | None = None) -> int:
    """The exit code."""
    options = _options(words)
    options.course = COURSES[options.course]
    known = [fault.name for fault in faults_of(options.course.drivers)]
    if not any(name.startswith(options.only) for name in known):
        raise RunError(f"no fault begins with {options.only!r} (ONLY=); there are: "
                       f"{', '.join(known)}")
    if INSIDE not in os.environ:
        return _start_inside()
    set_loopback(True)
    played, found = Counter(), Counter()
    with contextlib.suppress(KeyboardInterrupt):
        for seed in range(options.seed, options.seed + options.rounds):
            _play(seed, options, played, found)
    print(f"{'fault':34} rounds findings")
    for title, count in sorted(played.items()):
        print(f"{title:34} {count:6} {found[title]:8}")
    return int(any(found.values()))


def _play(seed: int, options: argparse.Namespace, played: Counter, found: Counter) -> None:
    course = options.course
    this = drawn(course, seed, options.only)
    folder, results = OUT / f"{course.name}-{seed}", OUT / f"{course.name}-results"
    shutil.rmtree(folder, ignore_errors=True)
    play = PlayByHand(this, folder) if this.fault.by_hand else Play(this, folder, results)
    faults = play.faults()
    played[this.title] += 1
    for fault in faults:
        print(f"{course.name} {seed}: {this.title}: {fault}", flush=True)
    if not faults:
        shutil.rmtree(folder)
        return
    found[this.title] += 1
    only = f" ONLY='{options.only}'" if options.only else ""
    print(f"  again: make chaos COURSE={course.name} SEED={seed} ROUNDS=1{only}", flush=True)
    if not this.fault.by_hand and not (folder / RESULTS).exists() and results.exists():
        shutil.move(results, folder / RESULTS)


def _start_inside() -> int:
    """Start it again in its own network and mount namespaces, so that no other program suffers."""
    if not shutil.which("unshare") or subprocess.run(
            [*NAMESPACES, "true"], capture_output=True, check=False).returncode:
        raise RunError("this machine allows no namespaces: in Docker give --privileged")
    os.environ[INSIDE] = "1"
    sys.stdout.flush()
    os.execvp(NAMESPACES[0], [*NAMESPACES, sys.executable, *sys.argv])


def _options(words: list[str] | None) -> argparse.Namespace:
    parser = Parser("", prog="chaos.sh", description=__doc__,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_whole("--rounds", 20, "drives", least=1)
    parser.add_whole("--seed", 1, "of the first round", least=1,
                     most=LARGEST_SEED)
    parser.add_argument("--course", default="course", help=f"{', '.join(COURSES)} (course)",
                        type=partial(one_of, "course", "COURSE", COURSES))
    parser.add_argument("--only", default="", help="the beginning of a fault's name, as: kill")
    return parser.parse_args(words)


if __name__ == "__main__":
    sys.exit(run_program("chaos", main))
