"""What became of the laps: one by one, and by follower and set as a table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

from evaluation.laps import lap_drive
from evaluation.laps.lap_drive import HEAD, LapDrive, cells, summary
from evaluation.trial.table import table


@dataclass(frozen=True, kw_only=True)
class Lap(LapDrive):
    """One lap, or how far it came."""

    least_speed = 1.5

    follower: str
    set: str
    track: str
    time: float | None  # s, of a closed lap
    folder: str  # below that of all results

    @property
    def name(self) -> str:
        """Of its case."""
        return f"{self.follower} {self.set} {self.seed}"


@dataclass(frozen=True)
class Summary(lap_drive.Summary):
    """All laps of one follower on one set."""

    follower: str
    set: str
    worst_seed: int  # not closed, else the farthest beside the line in the mean


def summarize(laps: Sequence[Lap]) -> list[Summary]:
    """One for each follower and set, in the order in which they were driven."""
    groups: dict[tuple[str, str], list[Lap]] = {}
    for lap in laps:
        groups.setdefault((lap.follower, lap.set), []).append(lap)
    worst = {names: max(group, key=lambda lap: (not lap.closed, lap.rms_lateral)).seed
             for names, group in groups.items()}
    return [Summary(**asdict(summary(group)), follower=names[0], set=names[1],
                    worst_seed=worst[names]) for names, group in groups.items()]


def summary_table(summaries: Sequence[Summary]) -> str:
    """A row each; figures are of closed laps."""
    rows = [("follower", "laps on", "closed", "within limits", *HEAD, "worst seed")]
    rows += [(each.follower, each.set, f"{each.closed} of {each.laps}",
              f"{each.within_limits} of {each.laps}", *cells(each), str(each.worst_seed))
             for each in summaries]
    return table(rows, left=(0, 1))


def lap_line(lap: Lap) -> str:
    """One lap on one line."""
    said = lap.disturbance
    start = f"start {said.sideways * 100:+.0f} cm {said.turn * 57.2958:+.0f}°"
    drawn = f"{start}, noise {said.camera_noise:.3f}, light x{said.light:.2f}"
    time = f" in {lap.time:.1f} s" if lap.closed else ""
    figures = f"{lap.mean_speed:.2f} m/s, RMS {lap.rms_lateral * 100:.1f} cm"
    return f"{lap.follower} {lap.track} seed {lap.seed}: {lap.outcome}{time}, {figures} ({drawn})"
