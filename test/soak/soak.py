#!/usr/bin/env python3
"""Runs a course for hours, with user activity, and checks that nothing grows.

    soak.py [--hours H] [--course NAME]

Meanwhile: the page with five visitors, a model that is spawned and deleted, a rolling bag.
Writes out/soak/NAME: samples.csv, growth.png and log/. Exit code 0: all is flat after the warm-up;
1: something grows, time changes pace, or the robot stands; 2: could not run.
"""

from __future__ import annotations

import argparse
import csv
import sys
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import rospy
from beside import Beside
from growth import draw, judge
from samples import FEWEST, PERIOD, Sample, Sampler

from evaluation.command_line import Parser, number, one_of, run_program
from run_session.launch import Launched
from run_session.session import Session
from run_session.simulator import models

ROOT = Path(__file__).resolve().parents[2]
START_LIMIT = 300.0  # s, wall
SIZE = ["camera_width:=320", "camera_height:=240"]
COURSES = {  # the robot, and the arguments of each roslaunch
    "course": ("turtlebot3_waffle", [["learning_topic", "course_follow.launch", *SIZE,
                                      "follower:=07follower_ground.py"]]),
    "race": ("racecar", [["racecar_description", "race.launch", *SIZE]]),
    "navigation": ("mycar", [["urdf02_gazebo", "demo02_obstacles.launch"],
                             ["nav_demo", "nav06_auto_slam.launch"]]),
}


def main(words: Sequence[str] | None = None) -> int:
    """The exit code."""
    parser = Parser("", prog="soak.sh", description=__doc__,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hours", default=4.0, metavar="H", help="(4)", type=partial(
        number, "--hours (HOURS=)", least=0.001, most=1000.0, what="a number of hours"))
    parser.add_argument("--course", default="course", help=f"{', '.join(COURSES)} (course)",
                        type=partial(one_of, "course", "COURSE", COURSES))
    options = parser.parse_args(words)
    out = ROOT / "out" / "soak" / options.course
    out.mkdir(parents=True, exist_ok=True)
    with Session(out) as session:
        samples = _run(session, options)
    return _report(samples, out)


def _run(session: Session, options: argparse.Namespace) -> list[Sample]:
    """Samples every PERIOD s, at least FEWEST; after an interruption, those so far."""
    robot, launches = COURSES[options.course]
    launched = session.launched(robot)
    launched.start_roscore()
    for package, file, *arguments in launches:
        launched.start(package, ["roslaunch", package, file, *arguments])
        launched.wait_for(f"model {robot}", lambda: robot in models(), START_LIMIT)
    beside = Beside(launched, session.out / "log")
    session.at_end(beside.end)
    seconds = options.hours * 3600
    period, until = min(PERIOD, seconds / FEWEST), time.monotonic() + seconds
    sampler, samples = Sampler(robot), []
    try:
        while (left := until - time.monotonic()) > 0:
            _wait(launched, beside, min(period, left))
            samples += sampler.look()
            session.progress.status(f"{left / 60:.0f} min left, {len(samples)} samples")
    except KeyboardInterrupt:
        session.progress.say("interrupted: what was sampled is judged")
    return samples


def _wait(launched: Launched, beside: Beside, seconds: float) -> None:
    """Wait, discarding the visitors' data; RunError if a program dies."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        launched.check(rospy.get_time())
        beside.act()


def _report(samples: Sequence[Sample], out: Path) -> int:
    with (out / "samples.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(Sample._fields)
        writer.writerows(samples)
    table, grows = judge(samples)
    draw(samples, out / "growth.png")
    print(f"{table}\nwritten to {out}: samples.csv, growth.png")
    return int(grows)


if __name__ == "__main__":
    sys.exit(run_program("soak", main))
