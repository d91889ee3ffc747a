"""A cloud's points to ranges and back, in a laser's plane: x ahead, y left, z up (REP 103)."""

import math
import sys
from dataclasses import dataclass, fields

import numpy as np


@dataclass(frozen=True)
class Settings:
    """Upstream's parameters and defaults, m and rad; min_height: the smallest above 0."""

    min_height: float = sys.float_info.min
    max_height: float = sys.float_info.max
    angle_min: float = -math.pi
    angle_max: float = math.pi
    angle_increment: float = math.pi / 180.0
    range_min: float = 0.0
    range_max: float = sys.float_info.max
    use_inf: bool = True
    inf_epsilon: float = 1.0

    def __post_init__(self):
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, bool) != (field.name == "use_inf") or isinstance(value, str):
                raise ValueError(f"parameter {field.name} is {value!r}, not a "
                                 f"{'flag' if field.name == 'use_inf' else 'number'}")
        if not self.angle_increment > 0.0 or not self.angle_max > self.angle_min:
            raise ValueError(f"angle_min {self.angle_min:g}, angle_max {self.angle_max:g} and "
                             f"angle_increment {self.angle_increment:g} leave no angles; "
                             "angle_min < angle_max and angle_increment > 0 are needed")

    @property
    def count(self) -> int:
        """How many ranges a scan has."""
        return math.ceil((self.angle_max - self.angle_min) / self.angle_increment)


def ranges_of(points: np.ndarray, settings: Settings) -> np.ndarray:
    """The nearest of points (n, 3) in each angle, float32 (count,).

    Where there is none: inf, or range_max + inf_epsilon without `use_inf`.
    """
    x, y, z = points[np.isfinite(points).all(axis=1)].T
    distances, angles = np.hypot(x, y), np.arctan2(y, x)
    used = ((z >= settings.min_height) & (z <= settings.max_height)
            & (distances >= settings.range_min) & (distances <= settings.range_max)
            & (angles >= settings.angle_min) & (angles <= settings.angle_max))
    index = ((angles[used] - settings.angle_min) / settings.angle_increment).astype(int)
    nothing = np.inf if settings.use_inf else settings.range_max + settings.inf_epsilon
    ranges = np.full(settings.count, nothing)
    np.minimum.at(ranges, index.clip(0, settings.count - 1), distances[used])
    return ranges.astype(np.float32)


def points_of(ranges: np.ndarray, angle_min: float, angle_increment: float, range_min: float,
              range_max: float) -> tuple[np.ndarray, np.ndarray]:
    """(points (m, 3), which ranges they come from (m,)) of the ranges (n,) within the limits."""
    ranges = np.asarray(ranges, dtype=float)
    with np.errstate(invalid="ignore"):
        index = np.flatnonzero((ranges >= range_min) & (ranges < range_max))
    angles = angle_min + index * angle_increment
    kept = ranges[index]
    return np.stack([kept * np.cos(angles), kept * np.sin(angles), np.zeros(len(kept))], 1), index


def rotation(x: float, y: float, z: float, w: float) -> np.ndarray:
    """The matrix (3, 3) of a unit quaternion."""
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
