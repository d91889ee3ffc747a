"""What became of the trials: one by one, as a table, and as report.json."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

FINDING, KIDNAPS = "finding", "kidnaps"  # the two sets of trials
RIGHT_OFF, RIGHT_OFF_DEG = 0.3, 15.0  # m and degrees, at most, of a pose that counts as right
HOLD = 20.0  # s, simulated, that it must stay right for
LIMITS = {FINDING: 60.0, KIDNAPS: 120.0}  # s, simulated, by when it must be right
LEAST_SHARES = {FINDING: 0.95, KIDNAPS: 0.8}
MOST_OFF, MOST_OFF_DEG = 0.05, 2.0  # in the mean, while it is tracked
MOST_CPU = 30.0  # percent of a core
LIMITS_IN_REPORT = {"right": [RIGHT_OFF, RIGHT_OFF_DEG], "hold": HOLD, "within": LIMITS,
                    "least_shares": LEAST_SHARES, "tracking": [MOST_OFF, MOST_OFF_DEG],
                    "cpu": MOST_CPU}


@dataclass(frozen=True)
class Trial:
    """One robot that had to be found; m, s simulated, degrees."""

    set: str
    number: int
    start: tuple[float, float, float]  # in the world; rad
    took: float | None  # until it was right and stayed so; None: it was not, or not for long
    off: float | None  # at the end; None: it had no pose
    off_deg: float | None
    touched: int

    @property
    def name(self) -> str:
        """Of its case."""
        return f"{self.set}-{self.number}"

    @property
    def right(self) -> bool:
        """In time?"""
        return self.took is not None and self.took <= LIMITS[self.set]

    @property
    def line(self) -> str:
        """On one line."""
        found = "not found" if self.took is None else f"found after {self.took:.1f} s"
        late = "" if self.right or self.took is None else ", too late"
        end = (", no pose at the end" if self.off is None else
               f", at the end {self.off * 100:.1f} cm and {self.off_deg:.1f}° off")
        return f"{self.set} {self.number}: {found}{late}{end}"


@dataclass(frozen=True)
class Tracking:
    """A long drive from a known pose; m, s simulated, degrees."""

    time: float
    driven: float
    off: float  # in the mean
    off_deg: float
    largest_off: float
    largest_off_deg: float

    name: ClassVar[str] = "tracking"  # of its case

    @property
    def passed(self) -> bool:
        """Within the limits?"""
        return self.off <= MOST_OFF and self.off_deg <= MOST_OFF_DEG

    @property
    def line(self) -> str:
        """On one line."""
        return f"tracking: {self.off * 100:.1f} cm, {self.off_deg:.1f}° off in the mean"

    @property
    def row(self) -> tuple[str, str, str, str]:
        """Of the table."""
        return (f"tracking, {self.time:.0f} s", f"{self.off * 100:.1f} cm, {self.off_deg:.1f}°",
                f"{MOST_OFF * 100:.0f} cm, {MOST_OFF_DEG:.0f}°",
                f"largest {self.largest_off * 100:.1f} cm, {self.largest_off_deg:.1f}°")


@dataclass(frozen=True)
class Load:
    """What amcl's process used; s."""

    particles: int
    simulated: float
    wall: float
    percent: float  # of one core: s used in 100 simulated s

    name: ClassVar[str] = "load"  # of its case

    @property
    def passed(self) -> bool:
        """Within the limit?"""
        return self.percent <= MOST_CPU

    @property
    def line(self) -> str:
        """On one line."""
        return f"load: {self.percent:.0f} % of a core"

    @property
    def row(self) -> tuple[str, str, str, str]:
        """Of the table."""
        return (f"amcl with {self.particles} particles", f"{self.percent:.0f} % of a core",
                f"{MOST_CPU:.0f} %", f"real time x{self.simulated / self.wall:.2f}")


Result = Trial | Tracking | Load


def tracking(seconds: float, driven: float, errors: np.ndarray) -> Tracking:
    """Of a drive of so many s, simulated, and m; errors are (N, 2), m and rad."""
    mean, largest = errors.mean(axis=0), errors.max(axis=0)
    return Tracking(seconds, driven, float(mean[0]), float(np.degrees(mean[1])),
                    float(largest[0]), float(np.degrees(largest[1])))


def searched(kind: str, number: int, start: tuple[float, float, float], began: float,
             times: np.ndarray, errors: np.ndarray, touched: int) -> Trial:
    """Of a robot that had to be found; times (N,), s, simulated; errors (N, 2), m and rad."""
    since = right_since(times, errors)
    held = since is not None and times[-1] - since >= HOLD
    off, turned = (round(float(each), 4) for each in errors[-1]) if len(errors) else (None, None)
    return Trial(kind, number, start, round(since - began, 2) if held else None, off,
                 turned if turned is None else round(float(np.degrees(turned)), 3), touched)


def right_since(times: np.ndarray, errors: np.ndarray) -> float | None:
    """From which of the times (N,), s, on all errors (N, 2), m and rad, are small to the end."""
    if not len(times):
        return None
    wrong = np.flatnonzero((errors > (RIGHT_OFF, np.radians(RIGHT_OFF_DEG))).any(axis=1))
    first = wrong[-1] + 1 if len(wrong) else 0
    return float(times[first]) if first < len(times) else None
