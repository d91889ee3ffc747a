"""What became of the laps: one by one, by follower and set, as a table and as report.json."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from evaluation.laps.disturbance import Disturbance
from evaluation.race_trials.venue import Venue
from evaluation.trial.table import cell, table

MOST_RMS = 0.05  # m beside the line
LEAST_SPEED = 1.5  # m/s
CLOSED = "closed"


@dataclass(frozen=True)
class Lap:
    """One lap, or how far it came; m, s, m/s."""

    follower: str
    set: str
    track: str
    seed: int
    outcome: str
    why: str | None
    time: float | None  # of a closed lap
    mean_speed: float
    rms_lateral: float  # of the whole drive, the way from where it was put to the line included
    max_lateral: float
    frames_dropped: int  # images without a command: such a drive will not be repeated
    disturbance: Disturbance
    folder: str  # below that of all results

    @property
    def name(self) -> str:
        """Of its case."""
        return f"{self.follower} {self.set} {self.seed}"

    @property
    def closed(self) -> bool:
        """Did it go all the way round?"""
        return self.outcome == CLOSED

    @property
    def within_limits(self) -> bool:
        """Closed, close enough to the line, fast enough."""
        return self.closed and self.rms_lateral <= MOST_RMS and self.mean_speed >= LEAST_SPEED


def lap_from_report(
    report: dict, venue: Venue, seed: int, disturbance: Disturbance, folder: Path
) -> Lap:
    """A lap from course_run's report.json."""
    closed = report["laps"][0] if report["laps"] else None
    distance = closed["distance_m"] if closed else report["distance_m"]
    time = closed["time_s"] if closed else report["simulated_s"]
    return Lap(
        follower=report["follower"],
        set=venue.set,
        track=venue.name,
        seed=seed,
        outcome=report["outcome"],
        why=report["why"],
        time=time if closed else None,
        mean_speed=round(distance / time, 3) if time else 0.0,
        rms_lateral=report["rms_lateral_m"],
        max_lateral=report["max_lateral_m"],
        frames_dropped=report["frames_dropped"],
        disturbance=disturbance,
        folder=str(folder),
    )


@dataclass(frozen=True)
class Summary:
    """All laps of one follower on one set; means and extremes are of closed laps, else None."""

    follower: str
    set: str
    laps: int
    closed: int
    within_limits: int
    mean_speed: float | None
    least_speed: float | None
    mean_rms_lateral: float | None
    max_rms_lateral: float | None
    max_lateral: float | None
    worst_seed: int  # not closed, else the farthest beside the line in the mean


def summarize(laps: Sequence[Lap]) -> list[Summary]:
    """One for each follower and set, in the order in which they were driven."""
    groups: dict[tuple[str, str], list[Lap]] = {}
    for lap in laps:
        groups.setdefault((lap.follower, lap.set), []).append(lap)
    return [_summary(*names, group) for names, group in groups.items()]


def _summary(follower: str, kind: str, laps: list[Lap]) -> Summary:
    closed = [lap for lap in laps if lap.closed]
    speeds, errors = [lap.mean_speed for lap in closed], [lap.rms_lateral for lap in closed]
    worst = max(laps, key=lambda lap: (not lap.closed, lap.rms_lateral))
    return Summary(
        follower, kind, len(laps), len(closed), sum(lap.within_limits for lap in laps),
        statistics.fmean(speeds) if closed else None,
        min(speeds, default=None),
        statistics.fmean(errors) if closed else None,
        max(errors, default=None),
        max((lap.max_lateral for lap in closed), default=None),
        worst.seed,
    )  # fmt: skip


def summary_table(summaries: Sequence[Summary]) -> str:
    """A row each; figures are of closed laps."""
    rows = [("follower", "laps on", "closed", "within limits", "m/s", "least", "RMS cm", "worst",
             "max cm", "worst seed")]  # fmt: skip
    rows += [
        (
            each.follower, each.set, f"{each.closed} of {each.laps}",
            f"{each.within_limits} of {each.laps}",
            cell(each.mean_speed, 1, 2), cell(each.least_speed, 1, 2),
            cell(each.mean_rms_lateral, 100, 1), cell(each.max_rms_lateral, 100, 1),
            cell(each.max_lateral, 100, 1), str(each.worst_seed),
        )
        for each in summaries
    ]  # fmt: skip
    return table(rows, left=(0, 1))


def lap_line(lap: Lap) -> str:
    """One lap on one line."""
    said = lap.disturbance
    start = f"start {said.sideways * 100:+.0f} cm {said.turn * 57.2958:+.0f}°"
    drawn = f"{start}, noise {said.camera_noise:.3f}, light x{said.light:.2f}"
    time = f" in {lap.time:.1f} s" if lap.closed else ""
    figures = f"{lap.mean_speed:.2f} m/s, RMS {lap.rms_lateral * 100:.1f} cm"
    return f"{lap.follower} {lap.track} seed {lap.seed}: {lap.outcome}{time}, {figures} ({drawn})"


def to_json(laps: Sequence[Lap]) -> dict:
    """All there is, with the limits it is held against."""
    return {
        "most_rms_lateral_m": MOST_RMS,
        "least_mean_speed_mps": LEAST_SPEED,
        "summaries": [asdict(each) for each in summarize(laps)],
        "laps": [{**asdict(lap), "within_limits": lap.within_limits} for lap in laps],
    }
