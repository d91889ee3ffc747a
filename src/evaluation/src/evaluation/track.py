"""`make track`: one drive that follows the red cylinder; world and start depend on the seed."""

from __future__ import annotations

import argparse
import itertools
import math
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np
import yaml
from ai_robot_tracking.scenes.scene import (
    HALF_ROOM,
    HIDDEN_TIME,
    KINDS,
    MOVING,
    SHADE_RADIUS,
    Scene,
    Start,
    draw_scene,
    draw_start,
)
from ai_robot_tracking.scenes.world_file import RADIUS, world_text

from evaluation.command_line import LARGEST_SEED, Parser, number, one_of
from evaluation.film import FAST_FILM_PERIOD, FILM_PERIOD, CameraFilm, side_by_side
from evaluation.live import CarDrive, Outcome
from evaluation.picture import (
    BAD,
    CAR,
    FAINT,
    GOOD,
    HIDDEN,
    MAP_PX,
    Plan,
    sheet,
    write_image,
    write_text,
)
from evaluation.report import write_json
from evaluation.run_log import RUN_LOG
from evaluation.run_page import RUN_PAGE
from evaluation.track_score import BAND, SETTLED, Task, TrackScorer
from run_session.course_file import CourseFile
from run_session.files import find_package, world_argument


def summarize(drive: TrackScorer, start: Start) -> dict:
    """The figures that only tracking drives have; m, simulated s."""
    errors, settled = drive.judged_errors(), drive.judged_errors(SETTLED)
    return {
        "outcome": drive.outcome, "good": drive.good,
        "wanted_distance_m": drive.task.wanted, "band_m": BAND,
        "start": {"x": round(start.x, 3), "y": round(start.y, 3),
                  "yaw_deg": round(math.degrees(start.yaw), 1)},
        "approach_s": _rounded(drive.approach, 2),
        "kept_s": round(len(errors) and drive.elapsed - drive.approach, 2),
        "left_at_s": _rounded(drive.left_at, 2),
        "rms_error_m": _rounded(np.sqrt(np.mean(errors**2)), 4) if len(errors) else None,
        "max_error_m": _rounded(np.max(np.abs(errors)), 4) if len(errors) else None,
        "max_error_settled_m": _rounded(np.max(np.abs(settled)), 4) if len(settled) else None,
        "share_within_band": (
            round(float(np.mean(np.abs(errors) <= BAND)), 4) if len(errors) else None),
        "hidden": [{"begin_s": round(each.begin, 2), "found_after_s": _rounded(each.found_after, 2)}
                   for each in drive.hidings],
        "least_gap_m": _rounded(drive.least_gap, 3),
        "distance_m": round(drive.distance, 3)}


def lines(report: dict) -> list[str]:
    """The summary for people to read."""
    found = [f"{report['tracker']}, scene {report['scene']}, seed {report['seed']}: "
             f"{report['outcome']}"]
    near = ("never near the cylinder" if report["approach_s"] is None else
            f"near the cylinder after {report['approach_s']:.1f} s")
    found.append(f"{near}; {report['distance_m']:.2f} m driven in "
                 f"{report['simulated_s']:.1f} s; smallest gap "
                 f"{report['least_gap_m'] * 100:.0f} cm")
    if report["rms_error_m"] is not None:
        found.append(f"beside {report['wanted_distance_m']:g} m: RMS "
                     f"{report['rms_error_m'] * 100:.1f} cm, at most "
                     f"{report['max_error_m'] * 100:.1f} cm ({_cm(report['max_error_settled_m'])} "
                     f"after {SETTLED:g} s), within {BAND:g} m "
                     f"{report['share_within_band']:.1%} of the time")
    for each in report["hidden"]:
        after = each["found_after_s"]
        found.append(f"hidden at {each['begin_s']:.1f} s for 3 s: " + (
            "not found again" if after is None else f"found again after {after:.1f} s"))
    return found


def _cm(value: float | None) -> str:
    return "-" if value is None else f"{value * 100:.1f} cm"


def _rounded(value: float | None, digits: int) -> float | None:
    return None if value is None or not math.isfinite(value) else round(float(value), digits)


TARGET_WAY, SHADE, FOLLOWER, WALL = "#823c46", "#24262a", "#78c8f0", "#8c9196"
MARGIN = 0.15  # m round the walls
WALLS = HALF_ROOM * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)])
MOST_SHOWN = 1.0  # m off the wanted distance, at the curve's edges
PLAN_PX, CURVE_PX = 480, 240  # the film's plan's width; the curve's height


class TrackFilm(CameraFilm):
    """The video of one tracking drive."""

    def __init__(self, path: Path, topic: str, scene: Scene, drive: TrackScorer, period: float):
        super().__init__(path, topic, period)
        self._drive = drive
        self._floor = room(scene, PLAN_PX)

    def page(self, view: np.ndarray, now: float) -> np.ndarray:
        drive = self._drive
        if not drive.samples:
            return side_by_side(view, self._floor.image, {}, self._period)
        error = drive.errors[-1]
        text = (f"{error:5.2f} m to go" if drive.task.wanted is None
                else f"beside {drive.task.wanted:g} m: {error * 100:+5.1f} cm")
        words = {16: f"simulated time {now:5.1f} s",
                 270: f"{drive.distance:5.2f} m driven   {text}"}
        plan = self._floor.copy()
        draw_drive(plan, drive)
        return side_by_side(view, plan.image, words, self._period)


def room(scene: Scene, width_px: int) -> Plan:
    """Top view of the scene, without what moves."""
    edge = HALF_ROOM + MARGIN
    plan = Plan((-edge, -edge), (edge, edge), width_px)
    plan.grid(1.0)
    plan.line(WALLS, WALL, 4)
    for shade in scene.shades:
        plan.disc(shade, SHADE_RADIUS, SHADE)
    for thing in scene.lookalikes:
        red, green, blue = (round(255 * part) for part in thing.colour)
        plan.disc(thing.place[:2], 0.25, f"#{red:02x}{green:02x}{blue:02x}")
    return plan


def draw_drive(plan: Plan, drive: TrackScorer) -> None:
    """The drive so far, and the cylinder's way during it."""
    samples, errors, task = drive.samples[:], drive.errors[:], drive.task
    now, last = samples[-1].time, samples[-1]
    times = np.arange(samples[0].time, now, 0.2)
    plan.line([task.target(time) for time in times], TARGET_WAY, 2)
    _draw_runs(plan, [(each.x, each.y) for each in samples], errors)
    hidden = any(begin <= now < begin + HIDDEN_TIME for begin in task.hidden)
    plan.disc(task.target(now), RADIUS, HIDDEN if hidden else CAR)
    plan.arrow((last.x, last.y, last.yaw), 0.4, FOLLOWER)


def _draw_runs(plan: Plan, points: Sequence[Sequence[float]], errors: Sequence[float]) -> None:
    """A line, green where the distance was kept, else orange."""
    near = np.abs(errors) <= BAND
    borders = [0, *(np.flatnonzero(np.diff(near)) + 1), len(near)]
    for begin, end in itertools.pairwise(borders):
        plan.line(points[max(begin - 1, 0):end], GOOD if near[begin] else BAD, 2)


def write_picture(path: Path, scene: Scene, drive: TrackScorer, lines: Sequence[str]) -> None:
    """Write path.png; its title and figures are the summary's lines."""
    plan = room(scene, MAP_PX)
    draw_drive(plan, drive)
    what, curve = ("cylinder", "m to the cylinder") if drive.task.wanted is None else (
        "wanted distance", "m beside the wanted distance")
    hidden = [("hidden", SHADE)] if drive.task.hidden else []
    write_image(path, sheet(lines[:3], [plan, _curve(drive)], [
        ("the cylinder", CAR), (f"within {BAND:g} m of the {what}", GOOD), ("not", BAD),
        (curve, FAINT), *hidden]))


def _curve(drive: TrackScorer) -> Plan:
    """The deviation from the wanted distance (or the distance to the cylinder), m, over s."""
    began, wanted = drive.samples[0].time, drive.task.wanted is not None
    times = [each.time - began for each in drive.samples]
    low, high = (-MOST_SHOWN, MOST_SHOWN) if wanted else (0.0, max(*drive.errors, 0.1))
    plan = Plan((0.0, low), (max(times[-1], 0.1), high), MAP_PX, CURVE_PX)
    for begin in drive.task.hidden:
        plan.box((begin - began, low), (begin - began + HIDDEN_TIME, high), SHADE)
    plan.grid(10.0, 0.5 if wanted else 1.0)
    for mark in (-BAND, 0.0, BAND) if wanted else (0.0,):
        plan.line([(0.0, mark), (times[-1], mark)], FAINT)
    _draw_runs(plan, np.column_stack((times, np.clip(drive.errors, low, high))), drive.errors)
    write_text(plan.image, "s", (MAP_PX - 20, CURVE_PX - 8), 9)
    return plan


PACKAGE, LAUNCH = "ai_robot_tracking", "start_tracking.launch"
PAGE, PID = TRACKERS = ("visual_tracker.py", "visual_tracker_pid.py")

COURSE = CourseFile(
    launch=(PACKAGE, LAUNCH), follower_package=PACKAGE,
    followers="scripts/visual_tracker*.py", follower=PID, drives_by="cmd_vel",
    robot="my_robot", robot_argument="", track="", off_course=0.0, out="out/track",
    camera="/camera/rgb/image_raw", camera_info="/camera/rgb/camera_info", commands="/cmd_vel",
    odometry="/ground_truth", controllers="/", lockstep=("/cmd_vel",), sensors=(),
    line_colour="", film_band=0.0)
ANSWER_LIMIT = 10.0  # s, wall, for the tracker's answer: a busy machine must not change a drive
LONGEST = 120.0      # s, simulated, to reach a static cylinder


def wanted_distance(tracker: str) -> float | None:
    """m, from the lesson's parameter file; None for the tracker that drives up to the cylinder."""
    if tracker == PAGE:
        return None
    path = find_package(PACKAGE) / "config" / "tracking_params.yaml"
    return float(yaml.safe_load(path.read_text(encoding="utf-8"))[PID.removesuffix(".py")][
        "wanted_distance"])


class TrackRun(CarDrive):
    """One drive and its score."""

    program = "track"
    does = "Follow the red cylinder without a screen, score it, write a report."
    ends = "0 all that was asked for was seen, 1 not so"
    usual_out = COURSE.out
    writes = ("path.png", "run.mp4", RUN_PAGE, RUN_LOG, "report.json")

    @classmethod
    def add_options(cls, parser: Parser) -> None:
        add = parser.add_argument
        add("--scene", default=MOVING, metavar="NAME", help=f"{', '.join(KINDS)} ({MOVING})",
            type=partial(one_of, "scene", "SCENE", KINDS))
        parser.add_whole("--seed", 0, "of the cylinder's way, start and noise", most=LARGEST_SEED)
        add("--tracker", default=PID, metavar="FILE", help=f"{' or '.join(TRACKERS)} ({PID})",
            type=partial(one_of, "tracker", "TRACKER", TRACKERS))
        add("--keep", default=60.0, metavar="S",
            help="simulated seconds to keep the distance (60)",
            type=partial(number, "--keep", least=1, most=150, what="seconds"))
        add("--fast", action="store_true",
            help="as fast as the machine goes: after each image the world waits for the tracker")

    def __init__(self, options: argparse.Namespace):
        self.scene = draw_scene(options.scene, options.seed)
        self.start = draw_start(options.scene, options.seed)
        task = Task(self.scene.way, self.scene.hidden, wanted_distance(options.tracker),
                    options.keep, LONGEST)
        super().__init__(options, COURSE, TrackScorer(task))
        self.driver = options.tracker
        if options.video:
            period = FAST_FILM_PERIOD / 2 if options.fast else FILM_PERIOD
            seen = f"/{options.tracker.removesuffix('.py')}/annotated"
            self.film = TrackFilm(options.out / "run.mp4", seen, self.scene, self.drive, period)

    def launch_words(self) -> Sequence[str]:
        options, start = self.options, self.start
        world = self.out / f"{options.scene}-{options.seed}.world"
        world.write_text(world_text(self.scene), encoding="utf-8")
        patient = [f"lockstep_timeout:={ANSWER_LIMIT:g}"] if options.fast else []
        return (PACKAGE, LAUNCH, "gui:=false", world_argument(world),
                f"tracker:={options.tracker}", f"x_pos:={start.x:.6f}", f"y_pos:={start.y:.6f}",
                f"yaw:={start.yaw:.6f}", f"seed:={options.seed}", *self.fast_arguments(), *patient)

    def outcome(self) -> Outcome:
        return Outcome(self.drive.outcome, faults=() if self.drive.good else ("",))

    def line(self) -> str:
        drive, now = self.drive, self.drive.samples[-1].time
        if drive.task.wanted is None:
            what = f"{drive.errors[-1]:.2f} m from the cylinder"
        else:
            what = f"{drive.errors[-1] * 100:+.0f} cm beside {drive.task.wanted:g} m"
        return (f"simulated {now:.1f} s | {drive.distance:.2f} m | {what}"
                f" | real time x{self.progress.factor:.2f}")

    def figures(self, outcome: Outcome, log: list[str]) -> dict | None:
        options = self.options
        if not self.drive.samples:
            return None
        return {"scene": options.scene, "seed": options.seed, "tracker": options.tracker,
                "fast": options.fast, **summarize(self.drive, self.start),
                **self.counted(log, digits=2)}

    def write(self, report: dict) -> list[str]:
        found = lines(report)
        write_json(report, self.out / "report.json")
        write_picture(self.out / "path.png", self.scene, self.drive, found)
        return found
