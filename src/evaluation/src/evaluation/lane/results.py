"""What became of the drives: laps and encounters, one by one, as tables, as report.json."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field

from evaluation.lane.encounters import KEPT_OFF, MOVES_ON, TOUCHED, Encounter
from evaluation.laps.disturbance import Disturbance
from evaluation.trial.table import cell, table

MOST_RMS, LEAST_SPEED = 0.05, 0.6  # m from the lane's middle, m/s
CLOSED = "closed"


@dataclass(frozen=True)
class LaneDrive:
    """One drive; m, s, m/s. Speed counts standing, too."""

    method: str
    seed: int
    people: bool
    laps_wanted: int
    laps_closed: int
    outcome: str
    why: str | None
    mean_speed: float
    rms_lateral: float  # of the whole drive, the way from where it was put to the middle included
    max_lateral: float
    frames_dropped: int  # images without a command: such a drive will not be repeated
    disturbance: Disturbance
    nearest_person: float | None = None  # over the whole drive; None: nobody was there
    encounters: tuple[Encounter, ...] = field(default=())

    @property
    def name(self) -> str:
        """Of its case."""
        return f"{self.method} {'people' if self.people else 'laps'}-{self.seed}"

    @property
    def closed(self) -> bool:
        """Did it go all the way?"""
        return self.outcome == CLOSED

    @property
    def kept_clear(self) -> bool:
        """Was nobody touched, over the whole drive? Without a distance nobody knows."""
        return self.nearest_person is not None and self.nearest_person >= TOUCHED

    @property
    def within_limits(self) -> bool:
        """Closed, close enough to the middle, fast enough."""
        return self.closed and self.rms_lateral <= MOST_RMS and self.mean_speed >= LEAST_SPEED


def from_report(report: dict, method: str, seed: int, disturbance: Disturbance,
                people: bool) -> LaneDrive:
    """A drive from course_run's report.json."""
    time, distance = report["simulated_s"], report["distance_m"]
    if report["laps"]:
        time = sum(lap["time_s"] for lap in report["laps"])
        distance = sum(lap["distance_m"] for lap in report["laps"])
    return LaneDrive(
        method, seed, people, report["laps_wanted"], report["laps_closed"], report["outcome"],
        report["why"], round(distance / time, 3) if time else 0.0, report["rms_lateral_m"],
        report["max_lateral_m"], report["frames_dropped"], disturbance)


def line_of(drive: LaneDrive) -> str:
    """One drive on one line."""
    light = f"light x{drive.disturbance.light:.2f}"
    met = ""
    if drive.people:
        good = sum(each.passed for each in drive.encounters)
        met = f", {good} of {len(drive.encounters)} encounters passed"
    return (f"{drive.method} seed {drive.seed}: {drive.outcome}, "
            f"{drive.laps_closed} of {drive.laps_wanted} laps, {drive.mean_speed:.2f} m/s, "
            f"RMS {drive.rms_lateral * 100:.1f} cm{met} ({light})")


def lap_table(drives: Sequence[LaneDrive], ms_a_frame: dict[str, float] | None = None) -> str:
    """A row for each method; figures are of closed laps."""
    head = ["method", "laps closed", "within limits", "m/s", "least", "RMS cm", "worst", "max cm"]
    rows = [head + ["ms a frame"] * bool(ms_a_frame)]
    for method in dict.fromkeys(drive.method for drive in drives):
        own = [drive for drive in drives if drive.method == method]
        closed = [drive for drive in own if drive.closed]
        errors, speeds = [d.rms_lateral for d in closed], [d.mean_speed for d in closed]
        row = [
            method, f"{len(closed)} of {len(own)}",
            f"{sum(drive.within_limits for drive in own)} of {len(own)}",
            cell(statistics.fmean(speeds) if closed else None, 1, 2),
            cell(min(speeds, default=None), 1, 2),
            cell(statistics.fmean(errors) if closed else None, 100, 1),
            cell(max(errors, default=None), 100, 1),
            cell(max((drive.max_lateral for drive in closed), default=None), 100, 1),
        ]  # fmt: skip
        rows.append(row + [cell(ms_a_frame.get(method), 1, 1)] * bool(ms_a_frame)
                    if ms_a_frame else row)
    return table(rows)


def encounter_table(drives: Sequence[LaneDrive]) -> str:
    """Counts of what is demanded of a car that meets people."""
    met = [each for drive in drives for each in drive.encounters]
    if not met:
        return "nobody was met"
    nearest = min(drive.nearest_person for drive in drives if drive.nearest_person is not None)
    stops = [each.stopped_before for each in met if each.stopped_before is not None]
    starts = [each.moved_after for each in met if each.moved_after is not None]
    stood = f"{min(stops):.2f} m before" if stops else "nowhere"
    rows = [
        ["demanded", "kept", "worst"],
        ["no contact", f"{sum(not each.touched for each in met)} of {len(met)}",
         f"{nearest:.2f} m, over all drives"],
        [f"{KEPT_OFF:g} m from person and zebra",
         f"{sum(each.stood_off for each in met)} of {len(met)}",
         f"{min(each.nearest for each in met):.2f} m; stood {stood}"],
        [f"moves on within {MOVES_ON:g} s", f"{sum(each.moved_on for each in met)} of {len(met)}",
         f"{max(starts):.2f} s" if starts else "-"],
        ["all of it", f"{sum(each.passed for each in met)} of {len(met)}", ""],
    ]
    return table(rows)


def to_json(drives: Sequence[LaneDrive], **more: object) -> dict:
    """All there is, with the limits it is held against."""
    return {
        "most_rms_lateral_m": MOST_RMS, "least_mean_speed_mps": LEAST_SPEED, **more,
        "drives": [{**asdict(drive), "within_limits": drive.within_limits} for drive in drives],
    }  # fmt: skip


def from_json(values: dict) -> list[LaneDrive]:
    """The drives that `to_json` was given; KeyError or TypeError."""
    return [_drive({key: each[key] for key in LaneDrive.__dataclass_fields__})
            for each in values["drives"]]


def _drive(values: dict) -> LaneDrive:
    met = tuple(Encounter(**each) for each in values["encounters"])
    return LaneDrive(**{**values, "encounters": met,
                        "disturbance": Disturbance(**values["disturbance"])})
