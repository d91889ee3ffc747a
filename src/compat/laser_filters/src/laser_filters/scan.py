"""A laser scan as arrays, and what a filter is."""

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
        """The scan that goes on to the next one."""
