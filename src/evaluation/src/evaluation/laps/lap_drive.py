"""A disturbed drive: what course_run reported of it, held against limits, and shown with others."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar

from evaluation.laps.disturbance import Disturbance
from evaluation.trial.table import cell, mean

CLOSED = "closed"


@dataclass(frozen=True, kw_only=True)
class LapDrive:
    """One drive, or how far it came; m, m/s. Speed counts standing, too."""

    most_rms: ClassVar[float] = 0.05  # m beside the line
    least_speed: ClassVar[float]

    seed: int
    outcome: str
    why: str | None
    mean_speed: float
    rms_lateral: float  # of the whole drive, the way from where it was put to the line included
    max_lateral: float
    frames_dropped: int  # images without a command: such a drive will not be repeated
    disturbance: Disturbance

    @property
    def closed(self) -> bool:
        """Did it go all the way?"""
        return self.outcome == CLOSED

    @property
    def within_limits(self) -> bool:
        """Closed, close enough to the line, fast enough."""
        return (self.closed and self.rms_lateral <= self.most_rms
                and self.mean_speed >= self.least_speed)


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
    """Of several; figures are of closed ones, None where there are none."""
    closed = [drive for drive in drives if drive.closed]
    speeds, errors = [each.mean_speed for each in closed], [each.rms_lateral for each in closed]
    return {
        "laps": len(drives), "closed": len(closed),
        "within_limits": sum(drive.within_limits for drive in drives),
        "mean_speed": mean(speeds), "least_speed": min(speeds, default=None),
        "mean_rms_lateral": mean(errors), "max_rms_lateral": max(errors, default=None),
        "max_lateral": max((each.max_lateral for each in closed), default=None),
    }  # fmt: skip


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
