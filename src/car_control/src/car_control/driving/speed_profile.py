"""Speed profile: the highest speed at each point of a path, by grip, throttle and brakes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class SpeedLimits:
    """m/s and m/s^2, all more than 0."""

    speed: float  # anywhere
    lateral_acceleration: float  # v^2 * |curvature| stays below this
    acceleration: float
    braking: float

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not value > 0:
                raise ValueError(f"{name} must be more than 0, is {value!r}")


def bend_speed(curvature: np.ndarray, limits: SpeedLimits) -> np.ndarray:
    """Highest speed, m/s, in bends of this curvature (1/m, any sign), at most `speed`."""
    sharpest = limits.lateral_acceleration / limits.speed**2  # below it `speed` is the limit
    return np.sqrt(limits.lateral_acceleration / np.maximum(np.abs(curvature), sharpest))


def speed_profile(
    curvature: np.ndarray,
    spacing: np.ndarray,
    limits: SpeedLimits,
    start_speed: float | None = None,
    closed: bool = False,
) -> np.ndarray:
    """Speeds (n,), m/s, at the points of a path with curvature (n,) in 1/m.

    spacing: m from each point to the next, (n - 1,), or (n,) if closed. The speed a bend allows is
    lowered by one pass forward, v2^2 <= v1^2 + 2 a ds, and one backward for the brakes. With
    `start_speed` the path is entered at no more than that.
    """
    curvature, spacing = np.asarray(curvature, float), np.asarray(spacing, float)
    if len(spacing) != len(curvature) - (not closed):
        raise ValueError(f"{len(curvature)} points cannot have {len(spacing)} spaces between them")
    squared = bend_speed(curvature, limits) ** 2
    if closed:
        return np.sqrt(_closed_passes(squared, spacing, limits))
    if start_speed is not None:
        squared[0] = min(squared[0], start_speed**2)
    _pass(squared, 2 * limits.acceleration * spacing)
    _pass(squared[::-1], 2 * limits.braking * spacing[::-1])
    return np.sqrt(squared)


def _closed_passes(squared: np.ndarray, spacing: np.ndarray, limits: SpeedLimits) -> np.ndarray:
    """Both passes, starting at the slowest point, which no pass can lower."""
    cut = int(np.argmin(squared))
    ring = np.roll(squared, -cut)
    ring = np.append(ring, ring[0])
    around = np.roll(spacing, -cut)
    _pass(ring, 2 * limits.acceleration * around)
    _pass(ring[::-1], 2 * limits.braking * around[::-1])
    return np.roll(ring[:-1], cut)


def _pass(squared: np.ndarray, gains: np.ndarray) -> None:
    """Lower each squared speed, in place, to what is reachable from the one before it."""
    for i, gain in enumerate(gains):
        squared[i + 1] = min(squared[i + 1], squared[i] + gain)
