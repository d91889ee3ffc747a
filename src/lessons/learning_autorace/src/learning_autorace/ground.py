"""From images and scans to the ground: its view from above, the lane's lines, the laser's hits."""

from __future__ import annotations

import math
import reprlib
import sys
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import rospkg
import rospy
import yaml
from sensor_msgs.msg import LaserScan

# Bounds by key. The lane is searched for 0.2 m ahead, which the view has to include.
LIMITS = {
    "lens": {"hfov": (0.1, 6.2), "divisor": (1.0, 10.0)},
    "camera": {"forward": (-1.0, 1.0), "height": (0.01, 2.0), "pitch": (-1.5, 1.5)},
    "view": {"near": (0.0, 0.18), "far": (0.25, 5.0), "half_width": (0.1, 5.0),
             "px_per_m": (20, 1000)},
}
TOP_LIMITS = {"clip_percent": (0.0, 20.0), "lane_width": (0.05, 1.0)}
MOST_GAIN = 2.0  # so that an image of nothing bright stays dark
YELLOW = (18, 90, 90), (38, 255, 255)  # hue 0..180, saturation, value: from, to
WHITE = (0, 0, 140), (180, 60, 255)
AHEAD, BAND = 0.20, 0.02  # m: where the lane is searched for, and over what depth
WIDEST = 0.10  # m: anything wider is not a line along the lane
NEAR_EXPECTED = 0.13  # m
LASER_FORWARD = -0.032  # m, from base_footprint


class CalibrationError(ValueError):
    """One line with the file, the key, and what is expected there."""


@dataclass(frozen=True)
class Calibration:
    """Numbers of config/camera.yaml; m and rad."""

    hfov: float
    divisor: float
    forward: float
    height: float
    pitch: float
    near: float
    far: float
    half_width: float
    px_per_m: float
    clip_percent: float
    lane_width: float


def load_calibration(path: Path) -> Calibration:
    """The file's numbers; CalibrationError if unreadable, or one is missing or out of range."""
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
    except Exception as error:  # PyYAML also raises KeyError, IndexError and more
        raise CalibrationError(f"{path}: cannot be read: {' '.join(str(error).split())[:200]}") \
            from error
    found = _numbers(path, values, TOP_LIMITS)
    for part, limits in LIMITS.items():
        found |= _numbers(path, values.get(part), limits, f"{part}.")
    return Calibration(**found)


def calibration_of_parameter() -> Calibration:
    """From the file in ~calibration, or config/camera.yaml; an error in it ends the program."""
    usual = Path(rospkg.RosPack().get_path("learning_autorace")) / "config" / "camera.yaml"
    try:
        return load_calibration(Path(rospy.get_param("~calibration", str(usual))))
    except CalibrationError as error:
        sys.exit(f"{rospy.get_name()}: {error}")


def _numbers(path: Path, values: object, limits: dict, part: str = "") -> dict[str, float]:
    found = {}
    for key, (least, most) in limits.items():
        value = values.get(key) if isinstance(values, dict) else None
        if not isinstance(value, (int, float)) or not least <= value <= most:
            raise CalibrationError(
                f"{path}: {part}{key} must be a number, {least:g} to {most:g}; got "
                f"{reprlib.repr(value)[:80]}")
        found[key] = float(value)
    return found


def to_pixel(forward: np.ndarray, left: np.ndarray, up: np.ndarray, width: int, height: int,
             calibration: Calibration) -> tuple[np.ndarray, np.ndarray]:
    """Columns and rows, in an image of that size, of points this far (m) from the camera."""
    cos, sin = math.cos(calibration.pitch), math.sin(calibration.pitch)
    ahead, above = cos * forward - sin * up, cos * up + sin * forward
    aside = np.hypot(left, above)
    angle = np.arctan2(aside, ahead)
    edge = math.tan(calibration.hfov / 2 / calibration.divisor)
    radius = width / 2 * np.tan(angle / calibration.divisor) / edge / np.maximum(aside, 1e-9)
    return width / 2 - radius * left, height / 2 - radius * above


def floor_maps(width: int, height: int, calibration: Calibration) -> tuple[np.ndarray, np.ndarray]:
    """For each pixel of the view, its column and row in the image, for cv2.remap."""
    step = 1 / calibration.px_per_m
    x = np.arange(calibration.far - step / 2, calibration.near, -step)
    y = np.arange(calibration.half_width - step / 2, -calibration.half_width, -step)
    left, forward = np.meshgrid(y, x - calibration.forward)
    columns, rows = to_pixel(forward, left, np.full_like(left, -calibration.height), width, height,
                             calibration)
    return columns.astype(np.float32) - 0.5, rows.astype(np.float32) - 0.5


def compensate(view: np.ndarray, clip_percent: float) -> np.ndarray:
    """The view, brightened so that its brightest pixels become white, whatever the light."""
    bright = np.percentile(view.max(axis=2), 100 - clip_percent)
    return cv2.convertScaleAbs(view, alpha=min(255 / max(bright, 1.0), MOST_GAIN))


@dataclass(frozen=True)
class Lane:
    """The lines' positions AHEAD of the base, m to the left; None: not seen."""

    yellow: float | None
    white: float | None

    def centre(self, width: float) -> float | None:
        """The middle between them, or half a lane beside the only one seen."""
        middles = [line + side * width / 2 for line, side in ((self.yellow, -1), (self.white, 1))
                   if line is not None]
        return sum(middles) / len(middles) if middles else None


def rows_at(calibration: Calibration, ahead: float, deep: float) -> slice:
    """The view's rows between two distances ahead."""
    top = round((calibration.far - ahead - deep / 2) * calibration.px_per_m)
    return slice(max(top, 0), top + round(deep * calibration.px_per_m))


def find_line(view: np.ndarray, colour: tuple, expected: float, calibration: Calibration
              ) -> float | None:
    """The position, m to the left, of the line of this colour that is nearest to `expected`."""
    band = view[rows_at(calibration, AHEAD, BAND)]
    hsv = cv2.cvtColor(band, cv2.COLOR_BGR2HSV)
    there = cv2.inRange(hsv, *map(np.array, colour)).mean(axis=0) > 60
    edges = np.flatnonzero(np.diff(np.concatenate(([False], there, [False])).astype(int)))
    found = []
    for begin, end in edges.reshape(-1, 2):
        middle = calibration.half_width - (begin + end) / 2 / calibration.px_per_m
        if (1 < end - begin <= WIDEST * calibration.px_per_m
                and abs(middle - expected) < NEAR_EXPECTED):
            found.append(middle)
    return min(found, key=lambda middle: abs(middle - expected), default=None)


def find_lane(view: np.ndarray, expected: float, calibration: Calibration) -> Lane:
    """Both lines of the lane whose middle is expected there, m to the left."""
    half = calibration.lane_width / 2
    return Lane(find_line(view, YELLOW, expected + half, calibration),
                find_line(view, WHITE, expected - half, calibration))


def laser_points(scan: LaserScan) -> np.ndarray:
    """(N, 2) m, x ahead and y left of base_footprint: the laser's hits."""
    ranges = np.array(scan.ranges)
    angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
    met = (ranges >= scan.range_min) & (ranges < scan.range_max)
    ranges, angles = ranges[met], angles[met]
    return np.stack((LASER_FORWARD + ranges * np.cos(angles), ranges * np.sin(angles)), 1)
