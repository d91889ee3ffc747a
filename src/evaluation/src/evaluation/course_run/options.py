"""The options of course_run: a mistake is one line that says what to type instead."""

from __future__ import annotations

import argparse
import re
from functools import partial
from pathlib import Path

from evaluation.session.course_file import load_course
from evaluation.trial.command_line import LARGEST_SEED, Parser, number, one_of
from run_session.course import Course
from run_session.failure import RunError

MOST_SECONDS = 999_999_999


def add_options(parser: Parser) -> None:
    """All but those that every drive has."""
    add = parser.add_argument
    add("--course", default="course", type=load_course, metavar="NAME",
        help="course, race or lane, or a file (course)")
    parser.add_whole("--laps", 1, "laps to close", variable="LAPS", least=1)
    add("--duration", metavar="S", help="simulated seconds at most (300 a lap)", type=partial(
        number, "--duration (DURATION=)", least=0.001, most=MOST_SECONDS,
        what="seconds of simulated time"))
    add("--follower", metavar="FILE",
        help="script of the course's package that drives (the course's own)")
    add("--fast", action="store_true",
        help="as fast as the machine goes: after each image the world waits for the follower")
    add("--camera", metavar="WIDTHxHEIGHT", type=_camera_px,
        help="size of the camera's images, px (the robot's own)")
    parser.add_whole("--seed", None, "of all noise; with --fast, repeats a run", variable="SEED",
                     most=LARGEST_SEED)
    add("--fingerprint", action="store_true",
        help="also report a SHA-256 of all that each sensor sent; writes no run.mp4")
    add("--launch-arg", action="append", default=[], metavar="NAME:=VALUE", type=_launch_arg,
        help="passed on to roslaunch; may be given again")
    add("--launch", nargs=2, metavar=("PACKAGE", "FILE"),
        help="another launch file that brings up simulator, car and follower")
    add("--track", type=Path, metavar="YAML", help="track file (the course's own)")


def complete(options: argparse.Namespace) -> None:
    """What was not asked for is as the course has it; RunError for a script that does not drive."""
    course: Course = options.course
    options.duration = options.duration or 300.0 * options.laps
    options.follower = options.follower or course.follower
    if not options.launch or tuple(options.launch) == course.launch:
        drivers = {path.name for path in course.follower_files() if course.drives_by
                   in path.read_text(encoding="utf-8", errors="replace")}
        one_of("follower", "FOLLOWER", sorted(drivers), options.follower)
    options.launch = tuple(options.launch or course.launch)
    options.track = options.track or course.track_path()
    options.video &= not options.fingerprint  # a node takes a topic raw or not
    size = options.camera and dict(zip(("camera_width", "camera_height"), options.camera))
    asked = {**(size or {}), **({} if options.seed is None else {"seed": options.seed})}
    options.launch_args = (*(f"{name}:={value}" for name, value in asked.items()),
                           *options.launch_arg)


def _camera_px(text: str) -> tuple[int, int]:
    size = re.fullmatch(r"([1-9][0-9]{0,4})x([1-9][0-9]{0,4})", text)
    if not size:
        raise RunError(f"--camera (CAMERA=) must be WIDTHxHEIGHT in px, as 640x480; got {text!r}")
    return int(size[1]), int(size[2])


def _launch_arg(text: str) -> str:
    if ":=" not in text:
        raise RunError(f"--launch-arg must look like name:=value, got {text!r}")
    return text
