"""`make course`, `make race`, `make lane`: a follower's drive round a course, scored."""

from __future__ import annotations

import argparse
import itertools
import json
import re
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import cv2
import numpy as np
from racecar_description.track.closed_line import build_track
from racecar_description.track.track_file import TrackFile, load_track_file
from sim_viewer.replay_page import Curve

from bullet_sim.formats.run_log import Mark
from evaluation.command_line import LARGEST_SEED, Parser, number, one_of
from evaluation.film import FAST_FILM_PERIOD, FILM_PERIOD, VIEW_PX, CameraFilm, side_by_side
from evaluation.lap import LapScorer, Verdict
from evaluation.live import CarDrive, Outcome
from evaluation.picture import (
    CAR,
    START,
    WHITE,
    bgr,
    course_plan,
    lap_colour,
    legend_bar,
    path_picture,
    write_image,
)
from evaluation.report import cell, table, write_json
from evaluation.run_log import RUN_LOG
from evaluation.run_page import RUN_PAGE
from run_session.course_file import CourseFile, drivers, load_course
from run_session.failure import RunError
from run_session.observer import Fingerprints

COLUMNS = (  # heading, key, factor, digits
    ("laps", "laps_closed", 1, 0),
    ("lap s", "mean_lap_s", 1, 1),
    ("m", "distance_m", 1, 2),
    ("RMS cm", "rms_lateral_m", 100, 1),
    ("max cm", "max_lateral_m", 100, 1),
    ("sent", "frames_sent", 1, 0),
    ("dropped", "frames_dropped", 1, 0),
    ("real time", "real_time_factor", 1, 2),
)


def summarize(drive: LapScorer, outcome: Outcome) -> dict:
    """The figures of one drive; lengths in m, times in simulated s."""
    times = [lap.time for lap in drive.laps]
    return {
        "outcome": outcome.word,
        "why": outcome.why or None,
        "laps_wanted": drive.wanted_laps,
        "laps_closed": len(times),
        "lap_times_s": [round(time, 3) for time in times],
        "mean_lap_s": round(sum(times) / len(times), 3) if times else None,
        **_lengths(drive.total),
        "laps": [{"time_s": round(lap.time, 3), **_lengths(lap)} for lap in drive.laps],
    }


def _lengths(part: object) -> dict:
    """Distance and lateral errors (m) of a lap, or of the whole drive."""
    return {"distance_m": round(part.distance, 3), "rms_lateral_m": round(part.rms_lateral, 4),
            "max_lateral_m": round(part.max_lateral, 4)}


def write_report(folder: Path, follower: str, run: dict) -> dict[str, dict]:
    """Write report.json and <follower>.json; returns the latest run of each follower, by name."""
    write_json({"follower": follower, **run}, folder / f"{Path(follower).stem}.json")
    runs = {follower: run}
    for path in sorted(folder.glob("*.json")):
        if path.name != "report.json":
            other = _read(path)
            runs.setdefault(other.get("follower", path.stem), other)
    runs.pop(None, None)
    kept = ("outcome", *(key for _, key, *_ in COLUMNS))
    side_by_side = {name: {key: runs[name].get(key) for key in kept}
                    for name in sorted(runs) if "outcome" in runs[name]}
    write_json({"follower": follower, **run, "followers": side_by_side}, folder / "report.json")
    return side_by_side


def followers_table(runs: dict[str, dict], current: str) -> str:
    """All followers' figures, a row each; the current run's row is marked."""
    rows = [["  follower", *(word for word, *_ in COLUMNS), "outcome"]]
    for name, run in runs.items():
        cells = [cell(run.get(key), factor, digits) for _, key, factor, digits in COLUMNS]
        rows.append([f"{'>' if name == current else ' '} {name}", *cells, run["outcome"]])
    return table(rows, left=(0, len(COLUMNS) + 1), names=(0,))


def _read(path: Path) -> dict:
    try:
        values = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return values if isinstance(values, dict) else {}


PLAN_PX, CAR_PX = 520, 27  # width of the map, length of the car's arrow
MASK_LOW, MASK_HIGH = (20, 43, 46), (90, 255, 255)  # HSV, the lessons' bounds for yellow
SEEN, FOUND = "#ff3cff", "#ff0000"  # round the mask's pixels, and where lesson 05 finds the line


def legend_entries(course: CourseFile) -> tuple[list[tuple[str, str]], list[tuple[str, str]]]:
    """Word and colour of what is drawn on the camera's image, and of what is on the map."""
    marked = [("seen as yellow", SEEN), ("line found", FOUND)] if course.film_band else []
    return marked, [("line", course.line_colour), ("right edge", WHITE), ("driven", lap_colour(0)),
                    ("start", START), ("car", CAR)]


class CourseFilm(CameraFilm):
    """The video of one drive round a course."""

    def __init__(self, path: Path, course: CourseFile, track_file: TrackFile, drive: LapScorer,
                 period: float):
        super().__init__(path, course.camera, period)
        self._band, self._drive = course.film_band, drive
        self._floor, self._drawn = course_plan(track_file, PLAN_PX, course.line_colour), 0
        marked, lines = legend_entries(course)
        self._legend = np.hstack([legend_bar(VIEW_PX[0], marked), legend_bar(PLAN_PX, lines)])

    def page(self, view: np.ndarray, now: float) -> np.ndarray:
        drive = self._drive
        words = {
            16: f"simulated time {now:5.1f} s",
            270: f"lap {drive.present_lap}/{drive.wanted_laps}   {drive.total.distance:5.2f} m"
                 f"   beside the line {drive.lateral * 100:+5.1f} cm",
        }
        page = side_by_side(mark_line(view, self._band), self._plan(), words, self._period)
        return np.vstack([page, self._legend])

    def _plan(self) -> np.ndarray:
        """The course with the path so far and the car."""
        samples = self._drive.samples[:]
        if len(samples) - self._drawn > 1:
            fresh = [(sample.x, sample.y) for sample in samples[self._drawn:]]
            self._floor.line(fresh, lap_colour(self._drive.lap_numbers[len(samples) - 1]), 2)
            self._drawn = len(samples) - 1
        plan = self._floor.copy()
        if samples:
            plan.arrow((samples[-1].x, samples[-1].y, samples[-1].yaw), CAR_PX / plan.px_per_m, CAR)
        return plan.image


def mark_line(view: np.ndarray, band: float) -> np.ndarray:
    """Outline the pixels in the lessons' mask, and draw a dot where lesson 05 finds the line.

    It looks in a band at this share of the height; `band` 0: return the image as it is.
    """
    if not band:
        return view
    mask = cv2.inRange(cv2.cvtColor(view, cv2.COLOR_BGR2HSV), MASK_LOW, MASK_HIGH)
    marked = view.copy()  # inside the outline the line keeps its colour
    marked[cv2.dilate(mask, np.ones((5, 5), np.uint8)) > mask] = bgr(SEEN)
    height = view.shape[0]
    top, deep = round(band * height), max(1, round(20 * height / 1080))
    cv2.rectangle(marked, (0, top), (view.shape[1] - 1, top + deep), (120, 120, 120), 1)
    moments = cv2.moments(mask[top : top + deep], binaryImage=True)
    if moments["m00"] > 0:
        centre = round(moments["m10"] / moments["m00"]), top + deep // 2
        cv2.circle(marked, centre, 9, bgr(FOUND), -1, cv2.LINE_AA)
        cv2.circle(marked, centre, 9, (255, 255, 255), 1, cv2.LINE_AA)
    return marked


MOST_SECONDS = 999_999_999


def marks_of(drive: LapScorer) -> list[Mark]:
    """Each lap's end, where the car was farthest beside the line, and where it lost it: left it, or
    stands since then, as the lessons' programs do without a line."""
    times = [sample.time for sample in drive.samples]
    found = [Mark("lap", times[at], str(lap)) for at, (before, lap) in enumerate(
        itertools.pairwise(drive.lap_numbers), 1) if lap > before]
    if drive.laterals:
        farthest = max(range(len(times)), key=lambda each: abs(drive.laterals[each]))
        found.append(Mark("largest", times[farthest], f"{drive.laterals[farthest]:+.3f} m"))
    if drive.verdict in (Verdict.LEFT, Verdict.STALLED):
        left = drive.verdict is Verdict.LEFT
        found.append(Mark("lost", times[-1] if left else drive.last_progress, drive.why))
    return found


class CourseRun(CarDrive):
    """One run of a course: what is observed and what was found."""

    program = "course_run"
    does = "Drive a follower round the course without a screen, score it, write a report."
    ends = "0 laps closed, or --duration without --laps was driven, 1 left the course or stalled"
    usual_out = "out/ and the course's name"
    writes = ("path.png", "run.mp4", RUN_PAGE, RUN_LOG, "report.json")

    @classmethod
    def add_options(cls, parser: Parser) -> None:
        add = parser.add_argument
        add("--course", default="course", type=load_course, metavar="NAME",
            help="course, race or lane, or a file (course)")
        parser.add_whole("--laps", 1, "laps to close", least=1)
        parser.set_defaults(laps=None)  # whether it was given decides what --duration is
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
        options.timed = options.duration is not None and options.laps is None
        options.laps = options.laps or 1
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
        drive = self.drive
        asked = {Verdict.CLOSED, Verdict.LATE} if self.options.timed else {Verdict.CLOSED}
        return Outcome(drive.verdict.value, drive.why,
                       () if drive.verdict in asked else (drive.why,))

    def line(self) -> str:
        drive = self.drive
        return (f"simulated {drive.samples[-1].time:.1f} s | {drive.total.distance:.2f} m"
                f" | lap {drive.present_lap}/{drive.wanted_laps} {drive.driven_share:4.0%}"
                f" | off line {drive.lateral * 100:+.1f} cm"
                f" | real time x{self.progress.factor:.2f}")

    def figures(self, outcome: Outcome, log: list[str]) -> dict | None:
        if not self.drive.samples:
            return None
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

    def marks(self) -> list[Mark]:
        return marks_of(self.drive)

    def curves(self) -> list[Curve]:
        times = [sample.time for sample in self.drive.samples]
        return [Curve(("beside the line", "偏离线"), "m", times, self.drive.laterals)]

    def write(self, report: dict) -> list[str]:
        picture = path_picture(self.track_file, self.drive, self.course.line_colour,
                               *_titles(self.driver, report))
        write_image(self.out / "path.png", picture)
        found = [followers_table(write_report(self.out, self.driver, report), self.driver)]
        if self.options.timed and report["outcome"] == Verdict.LATE.value:
            found.append(report["why"])
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
