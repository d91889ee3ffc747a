"""The laps' results: one by one, and by follower and set."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from evaluation.laps.lap_trial import COUNTS, FIGURES, LapDrive, summary
from evaluation.trial.report import grouped


@dataclass(frozen=True, kw_only=True)
class Lap(LapDrive):
    """One lap, complete or not."""

    least_speed = 1.5

    follower: str
    set: str
    track: str
    time: float | None  # s, of a completed lap
    folder: str  # below the folder for results

    @property
    def name(self) -> str:
        """Its case's name."""
        return f"{self.follower} {self.set} {self.seed}"

    @property
    def line(self) -> str:
        """A one-line summary."""
        said = self.disturbance
        start = f"start {said.sideways * 100:+.0f} cm {said.turn * 57.2958:+.0f}°"
        drawn = f"{start}, noise {said.camera_noise:.3f}, light x{said.light:.2f}"
        time = f" in {self.time:.1f} s" if self.closed else ""
        figures = f"{self.mean_speed:.2f} m/s, RMS {self.rms_lateral * 100:.1f} cm"
        return (f"{self.follower} {self.track} seed {self.seed}: {self.outcome}{time}, {figures}"
                f" ({drawn})")


COLUMNS = {"follower": lambda each: each["follower"], "laps on": lambda each: each["set"],
           **COUNTS, **FIGURES, "worst seed": lambda each: str(each["worst_seed"])}


def summarize(laps: Sequence[Lap]) -> list[dict]:
    """A summary for each follower and set, in the order in which they were driven.

    `worst_seed`: of a lap that was not completed, else of that with the largest RMS error.
    """
    groups = grouped(laps, lambda lap: (lap.follower, lap.set))
    return [{**summary(group), "follower": follower, "set": name, "worst_seed": max(
        group, key=lambda lap: (not lap.closed, lap.rms_lateral)).seed}
        for (follower, name), group in groups.items()]
