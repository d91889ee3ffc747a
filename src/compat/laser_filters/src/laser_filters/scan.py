"""A laser scan as arrays, what a filter is, and package `filters`' filters over several scans."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

# A frame's name to the scan's points (N, 3), m, in it; nan where there is no return.
PointsIn = Callable[[str], np.ndarray]


@dataclass(frozen=True)
class Scan:
    """The fields of sensor_msgs/LaserScan; never changed in place.

    `ranges` (N,), m; `intensities` (N,), or none (0,); angles in rad; `time_increment`, s, between
    beams; `delay`, s, by which the first beam is later than the message's stamp.
    """

    ranges: np.ndarray
    intensities: np.ndarray
    angle_min: float
    angle_increment: float
    range_min: float
    range_max: float
    time_increment: float = 0.0
    delay: float = 0.0
    frame: str = ""

    @property
    def angles(self) -> np.ndarray:
        """Of the beams (N,), rad."""
        return self.angle_min + self.angle_increment * np.arange(len(self.ranges))

    def without(self, beams: np.ndarray, value: float = np.nan) -> "Scan":
        """With `value` in place of the ranges of `beams`, a mask (N,) or indices."""
        ranges = self.ranges.copy()
        ranges[beams] = value
        return replace(self, ranges=ranges)


class ScanFilter(Protocol):
    """One filter of a chain: a dataclass whose fields are upstream's parameters."""

    def filtered(self, scan: Scan, points_in: PointsIn) -> Scan:
        """The scan that the next filter gets."""


class Observations:
    """Median or mean of the last values of each beam, one stage after the other."""

    def __init__(self, stages: tuple[tuple[str, int], ...] = ()):
        """`stages`: each "median" or "mean", and of how many scans."""
        self._stages = [(kind, deque(maxlen=count)) for kind, count in stages]

    def combined(self, values: np.ndarray) -> np.ndarray:
        """Values (N,) after all stages; a scan of another length begins anew."""
        for kind, last in self._stages:
            if last and len(last[-1]) != len(values):
                last.clear()
            last.append(values)
            stack = np.array(last)
            # of an even number the lower one in the middle, as upstream
            values = (np.sort(stack, axis=0)[(len(stack) - 1) // 2] if kind == "median"
                      else stack.mean(axis=0))
        return values
