#!/usr/bin/env python3
"""Drives each course in lockstep, goes back into each run, and says whether it was the same.

    replay_seeds.py [SEEDS]     20 seeds of course, race, lane and avoid; a line each
"""

import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from bullet_sim.formats.run_log import read_run_log

SCRIPTS = Path(__file__).parent.parent / "scripts"
LIMIT = 300.0  # s, wall, of a drive, and of a way back
SMALL = ("--camera", "320x240")
COURSES = {"course": (*SMALL, "--follower", "07follower_ground.py"), "race": SMALL, "lane": ()}
FAST = re.compile(r"([\d.]+) x real time")


def run(program: str, *words: object) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, SCRIPTS / program, *map(str, words)], text=True,
                          capture_output=True, timeout=LIMIT)


def drive(course: str, seed: int, out: Path, seconds: int) -> Path:
    """Drive, all of a hall for avoid; returns the log."""
    if course == "avoid":
        done = run("avoid.py", "--seeds", 1, "--first-seed", seed, "--out", out)
        assert done.returncode in (0, 1), done.stdout + done.stderr
        return out / "halls" / f"hall-{seed}.run.log.gz"
    done = run("course_run.py", "--course", course, *COURSES[course], "--fast", "--no-video",
               "--any-port", "--seed", seed, "--duration", seconds, "--out", out)
    assert done.returncode == 0, done.stdout + done.stderr
    return out / "run.log.gz"


def go_back(log: Path, at: str, out: Path) -> str:
    """What is said of the image there, which is as in the run."""
    done = run("replay.py", "--run", log, "--at", at, "--once", "--out", out)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def main() -> None:
    seeds = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    print("course  seed  images  log bytes a simulated s  replay x real time  wall s")
    for course in (*COURSES, "avoid"):
        for seed in range(seeds):
            with tempfile.TemporaryDirectory() as folder:
                began, out = time.monotonic(), Path(folder)
                path = drive(course, seed, out / "run", 12)
                said = go_back(path, "end", out / "replay")
                log = read_run_log(path)
                images, end = len(log.images), log.time_of(log.images[-1])
                print(f"{course:7} {seed:4} {images:7} {path.stat().st_size / end:24.0f} "
                      f"{FAST.search(said)[1]:>19} {time.monotonic() - began:7.0f}", flush=True)


if __name__ == "__main__":
    main()
