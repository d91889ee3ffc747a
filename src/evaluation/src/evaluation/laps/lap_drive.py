"""A disturbed drive: what course_run reported of it, held against limits, and shown with others."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any, ClassVar

from evaluation.laps.disturbance import Disturbance
from evaluation.trial.table import cell

CLOSED = "closed"
HEAD = ("m/s", "least", "RMS cm", "worst", "max cm")  # of `cells`


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


@dataclass(frozen=True)
class Summary:
    """Of several drives; figures are of closed ones, None where there are none."""

    laps: int
    closed: int
    within_limits: int
    mean_speed: float | None
    least_speed: float | None
    mean_rms_lateral: float | None
    max_rms_lateral: float | None
    max_lateral: float | None


def summary(drives: Sequence[LapDrive]) -> Summary:
    """Of these."""
    closed = [drive for drive in drives if drive.closed]
    speeds, errors = [each.mean_speed for each in closed], [each.rms_lateral for each in closed]
    return Summary(
        len(drives), len(closed), sum(drive.within_limits for drive in drives),
        statistics.fmean(speeds) if closed else None, min(speeds, default=None),
        statistics.fmean(errors) if closed else None, max(errors, default=None),
        max((each.max_lateral for each in closed), default=None))


def cells(found: Summary) -> tuple[str, ...]:
    """A summary's figures in a table's row."""
    return (cell(found.mean_speed, 1, 2), cell(found.least_speed, 1, 2),
            cell(found.mean_rms_lateral, 100, 1), cell(found.max_rms_lateral, 100, 1),
            cell(found.max_lateral, 100, 1))


def to_json(kind: type[LapDrive], name: str, drives: Sequence[LapDrive], **more: object) -> dict:
    """All there is, below a name, with the limits it is held against."""
    return {"most_rms_lateral_m": kind.most_rms, "least_mean_speed_mps": kind.least_speed, **more,
            name: [{**asdict(drive), "within_limits": drive.within_limits} for drive in drives]}


def from_json(kind: type[LapDrive], each: dict, **more: Any) -> LapDrive:
    """One drive as `to_json` wrote it; `more` takes the place of values."""
    values = {field.name: each[field.name] for field in fields(kind)}
    return kind(**{**values, "disturbance": Disturbance(**each["disturbance"]), **more})
