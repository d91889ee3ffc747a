"""`make course`, `make race`, `make lane`: a follower's drive round a course, scored."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from racecar_description.track.closed_line import build_track
from racecar_description.track.track_file import load_track_file

from evaluation.course_run.film import CourseFilm
from evaluation.course_run.report import followers_table, summarize, write_report
from evaluation.lap import LapScorer, Verdict
from evaluation.picture import path_picture, write_png
from evaluation.session.course_file import drivers, load_course
from evaluation.session.film import FAST_FILM_PERIOD, FILM_PERIOD
from evaluation.trial.car_drive import CarDrive
from evaluation.trial.command_line import LARGEST_SEED, Parser, number, one_of
from evaluation.trial.live import Outcome
from run_session.failure import RunError
from run_session.fingerprints import Fingerprints

MOST_SECONDS = 999_999_999


class CourseRun(CarDrive):
    """One run of a course: what is observed and what was found."""

    program = "course_run"
    does = "Drive a follower round the course without a screen, score it, write a report."
    ends = "0 laps closed, 1 left the course or stalled"
    usual_out = "out/ and the course's name"
    writes = ("path.png", "run.mp4", "report.json")

    @classmethod
    def add_options(cls, parser: Parser) -> None:
        add = parser.add_argument
        add("--course", default="course", type=load_course, metavar="NAME",
            help="course, race or lane, or a file (course)")
        parser.add_whole("--laps", 1, "laps to close", least=1)
        add("--duration", metavar="S", help="simulated seconds at most (300 a lap)", type=partial(
            number, "--duration (DURATION=)", least=0.001, most=MOST_SECONDS,
            what="seconds of simulated time"))
        add("--follower", metavar="FILE",
            help="script of the course's package that drives (the course's own)")
        add("--fast", action="store_true",
            help="as fast as the machine goes: after each image the world waits for the follower")
        add("--camera", metavar="WIDTHxHEIGHT", type=_camera_px,
            help="size of the camera's images, px (the robot's own)")
        parser.add_whole("--seed", None, "of all noise; repeats a --fast run", most=LARGEST_SEED)
        add("--fingerprint", action="store_true",
            help="also report a SHA-256 of all that each sensor sent; writes no run.mp4")
        add("--launch-arg", action="append", default=[], metavar="NAME:=VALUE", type=_launch_arg,
            help="passed on to roslaunch; may be given again")
        add("--launch", nargs=2, metavar=("PACKAGE", "FILE"),
            help="another launch file that brings up simulator, car and follower")
        add("--track", type=Path, metavar="YAML", help="track file (the course's own)")

    @classmethod
    def check(cls, options: argparse.Namespace) -> argparse.Namespace:
        """Fill options that were not given from the course file."""
        course = options.course
        options.duration = options.duration or 300.0 * options.laps
        options.follower = options.follower or course.follower
        if not options.launch or tuple(options.launch) == course.launch:
            one_of("follower", "FOLLOWER", drivers(course), options.follower)
        options.launch = tuple(options.launch or course.launch)
        options.track = options.track or course.track_path()
        options.video &= not options.fingerprint  # a node subscribes to a topic either raw or typed
        size = options.camera and dict(zip(("camera_width", "camera_height"), options.camera))
        asked = {**(size or {}), **({} if options.seed is None else {"seed": options.seed})}
        options.launch_args = (*(f"{name}:={value}" for name, value in asked.items()),
                               *options.launch_arg)
        options.out = options.out or Path(course.out)
        return options

    def __init__(self, options: argparse.Namespace):
        self.track_file = load_track_file(options.track)
        course = options.course
        super().__init__(options, course, LapScorer(
            build_track(self.track_file), options.laps, course.off_course, options.duration))
        self.driver = options.follower
        if options.video:
            period = FAST_FILM_PERIOD if options.fast else FILM_PERIOD
            self.film = CourseFilm(options.out / "run.mp4", course, self.track_file, self.drive,
                                   period)
        if options.fingerprint:
            self.fingerprints = Fingerprints(course.sensors)

    def launch_words(self) -> Sequence[str]:
        return (*self.options.launch, "gui:=false", f"follower:={self.driver}",
                *self.fast_arguments(), *self.options.launch_args)

    def outcome(self) -> Outcome:
        return self.drive.verdict.value, self.drive.why

    def line(self) -> str:
        drive = self.drive
        return (f"simulated {drive.samples[-1].time:.1f} s | {drive.total.distance:.2f} m"
                f" | lap {drive.present_lap}/{drive.wanted_laps} {drive.driven_share:4.0%}"
                f" | off line {drive.lateral * 100:+.1f} cm"
                f" | real time x{self.progress.factor:.2f}")

    def faults(self, outcome: Outcome) -> list[str]:
        return [] if self.drive.verdict is Verdict.CLOSED else [outcome[1]]

    def figures(self, outcome: Outcome, log: list[str]) -> dict:
        counted, simulated = self.counted(log, digits=3), self.simulated
        width, height = self.options.camera or (None, None)
        return {
            **summarize(self.drive, outcome), **counted,
            "frames_per_simulated_s": (
                round(counted["frames_sent"] / simulated, 2) if simulated > 0 else None),
            # The options that affect the drive; None: as in the launch file.
            "fast": self.options.fast, "seed": self.options.seed,
            "camera_width_px": width, "camera_height_px": height,
            **({"sensor_sha256": self.sensor_sums} if self.sensor_sums else {})}

    def write(self, report: dict) -> list[str]:
        picture = path_picture(self.track_file, self.drive, *_titles(self.driver, report))
        write_png(self.out / "path.png", picture)
        found = [followers_table(write_report(self.out, self.driver, report), self.driver)]
        if self.options.fast and report["frames_dropped"]:
            found.append(f"{report['frames_dropped']} images without a command:"
                         " no run will repeat this one")
        return found


def _titles(follower: str, summary: dict) -> tuple[str, str]:
    """Title and subtitle (with figures) of the path picture."""
    times = summary["lap_times_s"]
    laps = ", ".join(f"{time:.1f} s" for time in times[:3]) + (", ..." if len(times) > 3 else "")
    closed = f"{summary['laps_closed']} of {summary['laps_wanted']} laps closed"
    figures = (
        f"lap {laps or '-'}",
        f"{summary['distance_m']:.2f} m",
        f"beside the line RMS {summary['rms_lateral_m'] * 100:.1f} cm,"
        f" max {summary['max_lateral_m'] * 100:.1f} cm",
        f"real time x{summary['real_time_factor'] or 0:.2f}",
    )
    return f"{follower}: {closed}", "   |   ".join(figures)


def _camera_px(text: str) -> tuple[int, int]:
    size = re.fullmatch(r"([1-9][0-9]{0,4})x([1-9][0-9]{0,4})", text)
    if not size:
        raise RunError(f"--camera (CAMERA=) must be WIDTHxHEIGHT in px, as 640x480; got {text!r}")
    return int(size[1]), int(size[2])


def _launch_arg(text: str) -> str:
    if ":=" not in text:
        raise RunError(f"--launch-arg must look like name:=value, got {text!r}")
    return text
