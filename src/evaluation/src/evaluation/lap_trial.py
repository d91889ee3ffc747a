"""A trial whose cases are drives of course_run, each with its own light, noise and start."""

from __future__ import annotations

import os
import sys
from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from racecar_description.track.closed_line import load_track

from evaluation.lap import Disturbance
from evaluation.report import cell, mean
from evaluation.trial import Case, Trial
from run_session.files import find_package, world_argument
from run_session.session import Session
from trial_worlds.light import write_lit_world

CLOSED = "closed"
MODEL_PATH = "GAZEBO_MODEL_PATH"
# s, wall: long, because a busy machine must not change a drive
STARTUP_LIMIT, LAP_LIMIT, ANSWER_LIMIT = 240.0, 1800.0, 20.0


@dataclass(frozen=True)
class Venue:
    """One track and its models."""

    world: Path
    track: Path  # YAML of its centre line
    models: Path  # folder of the world's own models


@dataclass(frozen=True)
class Outing:
    """One drive of course_run, as fast as possible, in a world with its own light."""

    what: str  # for messages
    course: str
    follower: str
    venue: Venue
    lit: Path  # folder for the world with its own light
    out: Path  # folder for results
    disturbance: Disturbance
    longest: float  # limit for a lap, s, simulated
    laps: int = 1
    options: tuple[str, ...] = ()  # further ones for course_run
    launch: tuple[str, ...] = ()   # further arguments for the launch file

    def arguments(self, seed: int, world: Path) -> list[str]:
        """The command line of course_run, without the folder for results."""
        x, y, yaw = self.disturbance.start(load_track(self.venue.track))
        named = (world_argument(world), f"x_pos:={x:.6f}", f"y_pos:={y:.6f}", f"yaw:={yaw:.6f}",
                 f"camera_noise:={self.disturbance.camera_noise:.6f}",
                 f"lockstep_timeout:={ANSWER_LIMIT:g}", *self.launch)
        return ["--course", self.course, "--track", str(self.venue.track),
                "--follower", self.follower, "--laps", str(self.laps), "--fast", "--no-video",
                "--any-port", "--seed", str(seed), "--duration", f"{self.longest * self.laps:g}",
                "--startup-timeout", f"{STARTUP_LIMIT:g}", *self.options,
                *(word for argument in named for word in ("--launch-arg", argument))]


@dataclass(frozen=True, kw_only=True)
class LapDrive:
    """One drive, complete or not; m, m/s. Mean speed includes time spent standing."""

    most_rms: ClassVar[float] = 0.05  # m, lateral error
    least_speed: ClassVar[float]

    seed: int
    outcome: str
    why: str | None
    mean_speed: float
    rms_lateral: float  # of the whole drive, including the way from its start pose to the line
    max_lateral: float
    frames_dropped: int  # images without a command: such a drive is not reproducible
    disturbance: Disturbance

    @property
    def closed(self) -> bool:
        """Whether all laps were completed."""
        return self.outcome == CLOSED

    @property
    def within_limits(self) -> bool:
        """Whether it was completed, close enough to the line, and fast enough."""
        return (self.closed and self.rms_lateral <= self.most_rms
                and self.mean_speed >= self.least_speed)


@dataclass(frozen=True)
class LapRecord:
    """One drive as it was asked for, and course_run's report of it."""

    case: Case
    outing: Outing
    report: dict


class LapTrial(Trial):
    """Sets up and runs the drives; subclasses judge them."""

    result: type[LapDrive]
    derived = ("within_limits",)

    @abstractmethod
    def outing(self, out: Path, case: Case) -> Outing:
        """The case's drive; folders lie below `out`."""

    def drive(self, session: Session, case: Case) -> LapRecord:
        outing = self.outing(session.out, case)
        models = outing.venue.models
        world = write_lit_world(outing.venue.world, models, outing.disturbance.light, outing.lit)
        script = find_package("evaluation") / "scripts" / "course_run.py"
        folders = filter(None, (outing.lit / "models", models, os.environ.get(MODEL_PATH)))
        return LapRecord(case, outing, session.drive(
            [sys.executable, "-P", str(script), *outing.arguments(case.seed, world),
             "--out", str(outing.out)], outing.out, outing.what, LAP_LIMIT * outing.laps,
            {**os.environ, MODEL_PATH: ":".join(map(str, folders))}))

    def values(self, results: Sequence[LapDrive], **more: object) -> dict:
        """All results, with the limits by which they are judged."""
        return {"most_rms_lateral_m": self.result.most_rms,
                "least_mean_speed_mps": self.result.least_speed, **more,
                **super().values(results)}


def seen(report: dict, seed: int, disturbance: Disturbance) -> dict:
    """The fields of a LapDrive from course_run's report.json."""
    time, distance = report["simulated_s"], report["distance_m"]
    if report["laps"]:
        time = sum(lap["time_s"] for lap in report["laps"])
        distance = sum(lap["distance_m"] for lap in report["laps"])
    return dict(seed=seed, outcome=report["outcome"], why=report["why"],
                mean_speed=round(distance / time, 3) if time else 0.0,
                rms_lateral=report["rms_lateral_m"], max_lateral=report["max_lateral_m"],
                frames_dropped=report["frames_dropped"], disturbance=disturbance)


def summary(drives: Sequence[LapDrive]) -> dict:
    """Figures of several drives, taken from the completed ones; None if there are none."""
    closed = [drive for drive in drives if drive.closed]
    speeds, errors = [each.mean_speed for each in closed], [each.rms_lateral for each in closed]
    return {"laps": len(drives), "closed": len(closed),
            "within_limits": sum(drive.within_limits for drive in drives),
            "mean_speed": mean(speeds), "least_speed": min(speeds, default=None),
            "mean_rms_lateral": mean(errors), "max_rms_lateral": max(errors, default=None),
            "max_lateral": max((each.max_lateral for each in closed), default=None)}


def _count(key: str) -> Callable[[dict], str]:
    return lambda found: f"{found[key]} of {found['laps']}"


COUNTS = {"closed": _count("closed"), "within limits": _count("within_limits")}
FIGURES = {
    "m/s": lambda found: cell(found["mean_speed"], 1, 2),
    "least": lambda found: cell(found["least_speed"], 1, 2),
    "RMS cm": lambda found: cell(found["mean_rms_lateral"], 100),
    "worst": lambda found: cell(found["max_rms_lateral"], 100),
    "max cm": lambda found: cell(found["max_lateral"], 100),
}  # of tables of summaries
