"""Results of amcl's trials, with the limits for them: one robot found, tracking, CPU load."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

FINDING, KIDNAPS = "finding", "kidnaps"  # the two sets of trials
RIGHT_OFF, RIGHT_OFF_DEG = 0.3, 15.0  # m and degrees: largest error of a pose that counts as right
HOLD = 20.0  # s, simulated, for which it must stay right
LIMITS = {FINDING: 60.0, KIDNAPS: 120.0}  # s, simulated, within which it must be right
LEAST_SHARES = {FINDING: 0.95, KIDNAPS: 0.8}
MOST_OFF, MOST_OFF_DEG = 0.05, 2.0  # m and degrees: mean error while tracking
MOST_CPU = 30.0  # percent of a core
LIMITS_IN_REPORT = {"right": [RIGHT_OFF, RIGHT_OFF_DEG], "hold": HOLD, "within": LIMITS,
                    "least_shares": LEAST_SHARES, "tracking": [MOST_OFF, MOST_OFF_DEG],
                    "cpu": MOST_CPU}


@dataclass(frozen=True)
class Search:
    """One robot that had to be localised; m, s simulated, degrees."""

    set: str
    number: int
    start: tuple[float, float, float]  # x, y, yaw in the world; m, rad
    took: float | None  # until it was right for HOLD; None: it never was
    off: float | None  # error at the end; None: there was no pose
    off_deg: float | None
    touched: int

    @property
    def name(self) -> str:
        """Its case's name."""
        return f"{self.set}-{self.number}"

    @property
    def right(self) -> bool:
        """Whether it was localised in time."""
        return self.took is not None and self.took <= LIMITS[self.set]

    @property
    def line(self) -> str:
        """A one-line summary."""
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
    off: float  # mean error
    off_deg: float
    largest_off: float
    largest_off_deg: float

    name: ClassVar[str] = "tracking"  # its case's name

    @property
    def passed(self) -> bool:
        """Whether the mean errors are within the limits."""
        return self.off <= MOST_OFF and self.off_deg <= MOST_OFF_DEG

    @property
    def line(self) -> str:
        """A one-line summary."""
        return f"tracking: {self.off * 100:.1f} cm, {self.off_deg:.1f}° off in the mean"

    @property
    def row(self) -> tuple[str, str, str, str]:
        """Of the table."""
        return (f"tracking, {self.time:.0f} s", f"{self.off * 100:.1f} cm, {self.off_deg:.1f}°",
                f"{MOST_OFF * 100:.0f} cm, {MOST_OFF_DEG:.0f}°",
                f"largest {self.largest_off * 100:.1f} cm, {self.largest_off_deg:.1f}°")


@dataclass(frozen=True)
class Load:
    """CPU time that amcl's process used; s."""

    particles: int
    simulated: float
    wall: float
    percent: float  # of one core: s of CPU time in 100 simulated s

    name: ClassVar[str] = "load"  # its case's name

    @property
    def passed(self) -> bool:
        """Whether it is within the limit."""
        return self.percent <= MOST_CPU

    @property
    def line(self) -> str:
        """A one-line summary."""
        return f"load: {self.percent:.0f} % of a core"

    @property
    def row(self) -> tuple[str, str, str, str]:
        """Of the table."""
        return (f"amcl with {self.particles} particles", f"{self.percent:.0f} % of a core",
                f"{MOST_CPU:.0f} %", f"real time x{self.simulated / self.wall:.2f}")


Result = Search | Tracking | Load


def tracking(seconds: float, driven: float, errors: np.ndarray) -> Tracking:
    """The result of a drive: simulated s, m driven, and errors (N, 2), m and rad."""
    mean, largest = errors.mean(axis=0), errors.max(axis=0)
    return Tracking(seconds, driven, float(mean[0]), float(np.degrees(mean[1])),
                    float(largest[0]), float(np.degrees(largest[1])))


def searched(kind: str, number: int, start: tuple[float, float, float], began: float,
             times: np.ndarray, errors: np.ndarray, touched: int) -> Search:
    """The result of a localisation; times (N,), s, simulated; errors (N, 2), m and rad."""
    since = right_since(times, errors)
    held = since is not None and times[-1] - since >= HOLD
    off, turned = (round(float(each), 4) for each in errors[-1]) if len(errors) else (None, None)
    return Search(kind, number, start, round(since - began, 2) if held else None, off,
                 turned if turned is None else round(float(np.degrees(turned)), 3), touched)


def right_since(times: np.ndarray, errors: np.ndarray) -> float | None:
    """The time from which on all errors (N, 2), m and rad, at times (N,), s, are small; or None."""
    if not len(times):
        return None
    wrong = np.flatnonzero((errors > (RIGHT_OFF, np.radians(RIGHT_OFF_DEG))).any(axis=1))
    first = wrong[-1] + 1 if len(wrong) else 0
    return float(times[first]) if first < len(times) else None
