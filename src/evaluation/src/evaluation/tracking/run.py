"""`make track`: one drive that follows the red cylinder; world and start depend on the seed."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from functools import partial

import yaml
from ai_robot_tracking.scenes.scene import KINDS, MOVING, draw_scene
from ai_robot_tracking.scenes.start import draw_start
from ai_robot_tracking.scenes.world_file import world_text

from evaluation.session.film import FAST_FILM_PERIOD, FILM_PERIOD
from evaluation.tracking.pictures import TrackFilm, write_picture
from evaluation.tracking.report import lines, summarize
from evaluation.tracking.score import Task, TrackScorer
from evaluation.trial.car_drive import CarDrive
from evaluation.trial.command_line import LARGEST_SEED, Parser, number, one_of
from evaluation.trial.live import Outcome
from evaluation.trial.report import write_json
from run_session.course import Course
from run_session.resources import find_package

PACKAGE, LAUNCH = "ai_robot_tracking", "start_tracking.launch"
PAGE, PID = TRACKERS = ("visual_tracker.py", "visual_tracker_pid.py")

COURSE = Course(
    launch=(PACKAGE, LAUNCH), follower_package=PACKAGE,
    followers="scripts/visual_tracker*.py", follower=PID, drives_by="cmd_vel",
    robot="my_robot", robot_argument="", track="", off_course=0.0, out="out/track",
    camera="/camera/rgb/image_raw", camera_info="/camera/rgb/camera_info", commands="/cmd_vel",
    odometry="/ground_truth", controllers="/", lockstep=("/cmd_vel",), sensors=(), film_band=0.0)
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
    writes = ("path.png", "run.mp4", "report.json")

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
        return (PACKAGE, LAUNCH, "gui:=false", f"world_name:={world}",
                f"tracker:={options.tracker}", f"x_pos:={start.x:.6f}", f"y_pos:={start.y:.6f}",
                f"yaw:={start.yaw:.6f}", f"seed:={options.seed}", *self.fast_arguments(), *patient)

    def outcome(self) -> Outcome:
        return self.drive.outcome, ""

    def line(self) -> str:
        drive, now = self.drive, self.drive.samples[-1].time
        if drive.task.wanted is None:
            what = f"{drive.errors[-1]:.2f} m from the cylinder"
        else:
            what = f"{drive.errors[-1] * 100:+.0f} cm beside {drive.task.wanted:g} m"
        return (f"simulated {now:.1f} s | {drive.distance:.2f} m | {what}"
                f" | real time x{self.progress.factor:.2f}")

    def faults(self, outcome: Outcome) -> list[str]:
        return [] if self.drive.good else [""]

    def figures(self, outcome: Outcome, log: list[str]) -> dict:
        options = self.options
        return {"scene": options.scene, "seed": options.seed, "tracker": options.tracker,
                "fast": options.fast, **summarize(self.drive, self.start),
                **self.counted(log, digits=2)}

    def write(self, report: dict) -> list[str]:
        found = lines(report)
        write_json(report, self.out / "report.json")
        write_picture(self.out / "path.png", self.scene, self.drive, found)
        return found
