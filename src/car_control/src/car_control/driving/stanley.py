"""Stanley controller: steer along the path, and towards it, more sharply at low speed.

Law: angle = heading error + atan(gain * distance / speed), both at the front axle (G. Hoffmann,
C. Tomlin, M. Montemerlo, S. Thrun, Autonomous Automobile Trajectory Tracking, ACC 2007).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from .path import Path


@dataclass(frozen=True)
class StanleyGains:
    """How sharply the car turns towards the path."""

    gain: float  # 1/s, m/s of approach per m of distance from the path
    softening: float = 0.1  # m/s, added to the speed so that a standing car does not jump


def stanley_angle(heading_error: float, lateral: float, speed: float, gains: StanleyGains) -> float:
    """Steering angle in rad, left positive.

    heading_error: rad, the path's heading minus the car's. lateral: m from the path to the front
    axle, left positive. speed: m/s; its sign is ignored.
    """
    turned = math.remainder(heading_error, 2 * math.pi)
    return turned - math.atan2(gains.gain * lateral, abs(speed) + gains.softening)


def stanley(
    path: Path,
    pose: tuple[float, float, float],
    speed: float,
    wheelbase: float,
    gains: StanleyGains,
) -> float:
    """Steering angle in rad for a car with its rear axle at `pose` (x, y in m, yaw in rad)."""
    x, y, yaw = pose
    front = path.nearest(x + wheelbase * math.cos(yaw), y + wheelbase * math.sin(yaw))
    return stanley_angle(front.heading - yaw, front.lateral, speed, gains)
