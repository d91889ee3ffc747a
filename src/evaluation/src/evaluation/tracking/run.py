"""One drive: world and start of the seed, everything brought up, watched, and ended again."""

from __future__ import annotations

import time
from pathlib import Path

import cv2
import yaml

from evaluation.session.failure import RunError
from evaluation.session.launch import Launched
from evaluation.session.observer import Observer
from evaluation.session.processes import read_log
from evaluation.session.resources import find_package
from evaluation.session.status_line import StatusLine
from evaluation.tracking.course import COURSE, LAUNCH, PACKAGE, PAGE, PID, annotated_topic
from evaluation.tracking.film import Film
from evaluation.tracking.options import Options
from evaluation.tracking.report import lines, path_picture, summarize
from evaluation.tracking.scene import draw_scene
from evaluation.tracking.score import Task, TrackScorer
from evaluation.tracking.sdf import world_text
from evaluation.tracking.start import draw_start
from evaluation.trial.live import LiveDrive, Outcome
from evaluation.trial.report import write_json

LOOK_PERIOD = 0.05   # s, wall
ANSWER_LIMIT = 10.0  # s, wall, for the tracker's answer: a busy machine must not change a drive
LONGEST = 120.0      # s, simulated, to reach a cylinder that stands


def wanted_distance(tracker: str) -> float | None:
    """m, as the lesson's parameter file says; None for the tracker that drives up to it."""
    if tracker == PAGE:
        return None
    path = find_package(PACKAGE) / "config" / "tracking_params.yaml"
    return float(yaml.safe_load(path.read_text(encoding="utf-8"))[PID.removesuffix(".py")][
        "wanted_distance"])


class TrackRun(LiveDrive):
    """One drive and what was seen of it."""

    program = "track"
    writes = ("path.png", "run.mp4", "report.json")

    def __init__(self, options: Options):
        super().__init__(options.out, StatusLine())
        self.options, self.driver = options, options.tracker
        self.scene = draw_scene(options.scene, options.seed)
        self.start = draw_start(options.scene, options.seed)
        wanted = wanted_distance(options.tracker)
        self.drive = TrackScorer(Task(self.scene.way, self.scene.hidden, wanted, options.keep,
                                      LONGEST))
        self.film = Film(options.out / "run.mp4", annotated_topic(options.tracker), self.scene,
                         self.drive, options.fast)
        self.world = options.out / f"{options.scene}-{options.seed}.world"
        self.wall = 0.0  # s, from the first sample to the last
        self.frames = 0, 0  # images and commands
        self._observer: Observer | None = None

    def bring_up(self, launched: Launched) -> None:
        """Start everything and wait until the car's first pose is there."""
        options = self.options
        self.world.write_text(world_text(self.scene), encoding="utf-8")
        self.progress.status("starting roscore")
        launched.start_roscore()
        self._observer = Observer(launched.master_uri, COURSE.robot, COURSE,
                                  lockstep=options.fast)
        launched.start("roslaunch", ["roslaunch", PACKAGE, LAUNCH, *self._arguments()])
        self.progress.say(f"watch it: export ROS_MASTER_URI={launched.master_uri}")
        self._observer.start()
        if options.video:
            self.film.start()
        launched.wait_for(lambda: self._observer.missing, self._take, self.progress.status,
                          options.startup_timeout)

    def watch(self, launched: Launched) -> Outcome:
        """Returns when nothing more is to be seen."""
        began = heard = time.monotonic()
        while not self.drive.over:
            if self._take():
                heard = time.monotonic()
            now = self.drive.samples[-1].time
            self.progress.update(now, self._line)
            launched.check(now)
            if time.monotonic() - heard > self.options.stuck_timeout:
                raise RunError(f"simulated time has stood still at {now:.1f} s: the simulator is"
                               " paused or hangs")
        self.wall = time.monotonic() - began
        return self.drive.outcome, ""

    def end(self) -> None:
        """Count, and ask no more."""
        if self._observer is not None:
            if self.drive.samples:
                self.frames = self._observer.count(self.drive.samples[-1].time)
            self._observer.stop()

    @property
    def was_seen(self) -> bool:
        return bool(self.drive.samples)

    def faults(self, outcome: Outcome) -> list[str]:
        return [] if self.drive.good else [""]

    def report(self, outcome: Outcome, log_folder: Path) -> None:
        """Write report.json and path.png, and print the figures."""
        found = summarize(self, read_log(log_folder / "roslaunch.log"))
        write_json(found, self.out / "report.json")
        cv2.imwrite(str(self.out / "path.png"), path_picture(self, found))
        self.progress.say("\n" + "\n".join(lines(found)))
        self.name_files()

    def _arguments(self) -> list[str]:
        options, start = self.options, self.start
        found = ["gui:=false", f"world_name:={self.world}", f"tracker:={options.tracker}",
                 f"x_pos:={start.x:.6f}", f"y_pos:={start.y:.6f}", f"yaw:={start.yaw:.6f}",
                 f"seed:={options.seed}"]
        if options.fast:
            found += ["paused:=true", "real_time_factor:=0", "pub_clock_frequency:=30",
                      f"lockstep:={','.join(COURSE.lockstep)}",
                      f"lockstep_timeout:={ANSWER_LIMIT:g}"]
        return found

    def _take(self) -> int:
        arrivals = self._observer.samples(LOOK_PERIOD)
        for _, sample in arrivals:
            if not self.drive.over or not self.drive.samples:
                self.drive.add(sample)
        return len(arrivals)

    def _line(self) -> str:
        drive, now = self.drive, self.drive.samples[-1].time
        if drive.task.wanted is None:
            what = f"{drive.errors[-1]:.2f} m from the cylinder"
        else:
            what = f"{drive.errors[-1] * 100:+.0f} cm beside {drive.task.wanted:g} m"
        return (f"simulated {now:.1f} s | {drive.distance:.2f} m | {what}"
                f" | real time x{self.progress.factor:.2f}")
