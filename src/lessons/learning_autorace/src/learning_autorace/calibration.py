"""Lesson 1: from the camera's image to the ground seen from above."""

from __future__ import annotations

import math
import reprlib
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import yaml

# Bounds by key. The lane is searched for 0.2 m ahead, which the view has to include.
LIMITS = {
    "lens": {"hfov": (0.1, 6.2), "divisor": (1.0, 10.0)},
    "camera": {"forward": (-1.0, 1.0), "height": (0.01, 2.0), "pitch": (-1.5, 1.5)},
    "view": {"near": (0.0, 0.18), "far": (0.25, 5.0), "half_width": (0.1, 5.0),
             "px_per_m": (20, 1000)},
}
TOP_LIMITS = {"clip_percent": (0.0, 20.0), "lane_width": (0.05, 1.0)}
MOST_GAIN = 2.0  # so that an image of nothing bright stays dark


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
