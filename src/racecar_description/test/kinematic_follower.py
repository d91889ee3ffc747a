"""Lesson 05 without a simulator: a level pinhole camera, the row band, its law, a unicycle."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from racecar_description.track.closed_line import Track

CAMERA_AHEAD, CAMERA_LEFT, CAMERA_UP = 0.069, -0.047, 0.117  # m, from base_footprint
WIDTH_PX, HEIGHT_PX, FIELD_OF_VIEW = 1920, 1080, 1.3439
FOCAL_PX = WIDTH_PX / 2 / math.tan(FIELD_OF_VIEW / 2)
ROWS = range(900, 920)  # 5h/6 and 20 rows on, as the tutorial has it


@dataclass(frozen=True)
class SimulatedDrive:
    """What a simulated drive did, sample by sample."""

    times: np.ndarray  # s
    poses: np.ndarray  # (n, 3): x, y, yaw
    lost: int  # frames without a line


class LineCamera:
    """Finds the yellow line's centroid in the row band, as the moments of the mask do."""

    def __init__(self, track: Track, spacing: float = 0.002):
        self._points = np.array(track.points(spacing))
        bottom, top = ROWS[0] - HEIGHT_PX / 2, ROWS[-1] + 1 - HEIGHT_PX / 2
        self._far, self._near = CAMERA_UP * FOCAL_PX / bottom, CAMERA_UP * FOCAL_PX / top

    def centroid_px(self, x: float, y: float, yaw: float) -> float | None:
        """Column of the line's centroid, or None when no part of it is in the band."""
        dx, dy = self._points[:, 0] - x, self._points[:, 1] - y
        ahead = math.cos(yaw) * dx + math.sin(yaw) * dy - CAMERA_AHEAD
        left = -math.sin(yaw) * dx + math.cos(yaw) * dy - CAMERA_LEFT
        seen = (ahead > self._near) & (ahead < self._far)
        columns = WIDTH_PX / 2 - FOCAL_PX * left[seen] / ahead[seen]
        columns = columns[(columns >= 0) & (columns < WIDTH_PX)]
        return float(columns.mean()) if columns.size else None


def drive(
    track: Track,
    duration: float,
    speed: float = 0.15,
    gain: float = 1e-3,
    rate_hz: int = 30,
    delay_frames: int = 1,
) -> SimulatedDrive:
    """Drive from the world's origin, heading +x; where the line is lost the car stops."""
    camera, step = LineCamera(track), 1.0 / rate_hz
    x = y = yaw = 0.0
    commands = [(0.0, 0.0)] * delay_frames
    poses, lost = [], 0
    for _ in range(int(duration * rate_hz)):
        column = camera.centroid_px(x, y, yaw)
        lost += column is None
        seen = (0.0, 0.0) if column is None else (speed, -gain * (column - WIDTH_PX / 2))
        commands.append(seen)
        forward, turn = commands.pop(0)
        x += forward * step * math.cos(yaw + turn * step / 2)
        y += forward * step * math.sin(yaw + turn * step / 2)
        yaw += turn * step
        poses.append((x, y, yaw))
    return SimulatedDrive(np.arange(1, len(poses) + 1) * step, np.array(poses), lost)
