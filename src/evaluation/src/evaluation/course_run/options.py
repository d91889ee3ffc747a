"""The command line of course_run, checked: a mistake is one line that says what to type instead."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from evaluation.session.course_file import Course, load_course
from evaluation.session.failure import RunError
from evaluation.trial.command_line import Parser

USUAL_COURSE = "course"


@dataclass(frozen=True)
class Options:
    """What to run and where to write."""

    course: Course
    laps: int
    duration: float  # s, simulated
    follower: str
    out: Path
    track: Path
    launch: tuple[str, str]  # package and launch file
    launch_args: tuple[str, ...]  # for roslaunch, name:=value
    fast: bool  # as fast as it goes, in lockstep with the follower
    camera_px: tuple[int, int] | None  # width and height; None: the robot's own
    seed: int | None  # None: the launch file's own
    fingerprint: bool  # also sum up what all sensors send
    video: bool
    startup_timeout: float  # s, wall
    stuck_timeout: float  # s, wall

    @property
    def robot(self) -> str:
        """The car's model name in the simulator, as the launch file spawns it."""
        return self.course.robot_name(self.launch_args)


def parse_options(arguments: list[str]) -> Options:
    """Options from the command line, or RunError."""
    given = _parser().parse_args(arguments)
    laps = _number("--laps (LAPS=)", given.laps, int, "a whole number, 1 or more")
    default_duration = str(300 * laps)
    duration = _number(
        "--duration (DURATION=)",
        given.duration or default_duration,
        float,
        "seconds of simulated time, more than 0",
    )
    course = load_course(given.course)
    launch = tuple(given.launch or course.launch)
    follower = given.follower or course.follower
    if launch == course.launch:
        _check_follower(course, follower)
    for argument in given.launch_arg:
        if ":=" not in argument:
            raise RunError(f"--launch-arg must look like name:=value, got {argument!r}")
    camera_px, seed = _camera_px(given.camera), _seed(given.seed)
    return Options(
        course,
        laps,
        duration,
        follower,
        (given.out or Path(course.out)).resolve(),
        given.track or course.track_path(),
        launch,
        (*_launch_args(course, given.fast, camera_px, seed), *given.launch_arg),
        given.fast,
        camera_px,
        seed,
        given.fingerprint,
        given.video and not given.fingerprint,  # a node takes a topic raw or not
        given.startup_timeout,
        given.stuck_timeout,
    )


def _parser() -> Parser:
    parser = Parser(
        prog="course_run.py",
        description="Drive a follower round the course without a screen, score it, write a report.",
        epilog="Exit code: 0 laps closed, 1 left the course or stalled, 2 could not run.",
    )
    parser.add_argument(
        "--course", default=USUAL_COURSE, metavar="NAME",
        help="course, race or lane, or a file (course)",
    )  # fmt: skip
    parser.add_argument("--laps", default="1", metavar="N", help="laps to close (1)")
    parser.add_argument("--duration", metavar="S", help="simulated seconds at most (300 a lap)")
    parser.add_argument(
        "--follower",
        metavar="FILE",
        help="script of the course's package that drives (the course's own)",
    )
    parser.add_argument(
        "--out",
        type=Path,
        metavar="DIR",
        help="where path.png, run.mp4, report.json and log/ go (out/ and the course's name)",
    )
    parser.add_argument(
        "--fast",
        action="store_true",
        help="as fast as the machine goes: after each image the world waits for the follower",
    )
    parser.add_argument(
        "--camera", metavar="WIDTHxHEIGHT", help="size of the camera's images, px (the robot's own)"
    )
    parser.add_argument("--seed", metavar="N", help="of all noise; with --fast, repeats a run (0)")
    parser.add_argument(
        "--fingerprint",
        action="store_true",
        help="also report a SHA-256 of all that each sensor sent; writes no run.mp4",
    )
    parser.add_argument(
        "--launch-arg",
        action="append",
        default=[],
        metavar="NAME:=VALUE",
        help="passed on to roslaunch; may be given again",
    )
    parser.add_argument(
        "--launch",
        nargs=2,
        metavar=("PACKAGE", "FILE"),
        help="another launch file that brings up simulator, car and follower",
    )
    parser.add_argument(
        "--track", type=Path, metavar="YAML", help="track file (the course's own)"
    )
    parser.add_argument("--no-video", dest="video", action="store_false", help="write no run.mp4")
    parser.add_argument(
        "--startup-timeout",
        type=float,
        default=60.0,
        metavar="S",
        help="wall seconds until the car must stand on the course (60)",
    )
    parser.add_argument(
        "--stuck-timeout",
        type=float,
        default=20.0,
        metavar="S",
        help="wall seconds that simulated time may stand still (20)",
    )
    return parser


def _number(name: str, text: str, kind: type, wanted: str) -> int | float:
    try:
        value = kind(text)
    except ValueError:
        value = 0
    if not 0 < value < 1e9:
        raise RunError(f"{name} must be {wanted}; got {text!r}")
    return value


def _camera_px(text: str | None) -> tuple[int, int] | None:
    if text is None:
        return None
    size = re.fullmatch(r"([1-9][0-9]{0,4})x([1-9][0-9]{0,4})", text)
    if not size:
        raise RunError(f"--camera (CAMERA=) must be WIDTHxHEIGHT in px, as 640x480; got {text!r}")
    return int(size[1]), int(size[2])


def _seed(text: str | None) -> int | None:
    if text is None:
        return None
    if not re.fullmatch(r"[0-9]{1,9}", text):
        raise RunError(f"--seed (SEED=) must be a whole number, 0 or more; got {text!r}")
    return int(text)


def _launch_args(
    course: Course, fast: bool, camera_px: tuple[int, int] | None, seed: int | None
) -> list[str]:
    """What these options are for the launch file."""
    found = []
    if fast:
        found += ["paused:=true", "real_time_factor:=0", f"lockstep:={','.join(course.lockstep)}"]
        # At five times real time the usual 100 Hz would wake every node 500 times a second.
        found.append("pub_clock_frequency:=30")
    if camera_px is not None:
        found += [f"camera_width:={camera_px[0]}", f"camera_height:={camera_px[1]}"]
    if seed is not None:
        found.append(f"seed:={seed}")
    return found


def _check_follower(course: Course, name: str) -> None:
    known = sorted({path.name for path in course.follower_files() if _drives(course, path)})
    if name not in known:
        listed = ", ".join(known) or "none"
        raise RunError(f"no follower {name!r} that drives (FOLLOWER=); there are: {listed}")


def _drives(course: Course, script: Path) -> bool:
    return course.drives_by in script.read_text(encoding="utf-8", errors="replace")
