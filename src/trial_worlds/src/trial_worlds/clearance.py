"""The distance between the waffle and circular obstacles."""

from __future__ import annotations

import numpy as np

# The waffle's collision shapes in base_footprint, m: least x, greatest x, half width.
PARTS = ((-0.197, 0.069, 0.133),   # body
         (-0.033, 0.033, 0.153),   # both wheels
         (0.061, 0.073, 0.066))    # camera
CONTACT = 0.001  # m; the engine lets touching bodies penetrate each other by less


def clearance(pose: tuple[float, float, float], centres: np.ndarray, radius: float) -> float:
    """Distance (m) from the waffle at `pose` (x, y, yaw) to the nearest circle at `centres` (N, 2).

    Negative if they overlap; inf without circles.
    """
    x, y, yaw = pose
    away = np.asarray(centres, float).reshape(-1, 2) - (x, y)
    ahead = away @ (np.cos(yaw), np.sin(yaw))
    aside = np.abs(away @ (-np.sin(yaw), np.cos(yaw)))
    gaps = [np.hypot(np.maximum(np.maximum(low - ahead, ahead - high), 0.0),
                     np.maximum(aside - half, 0.0)) for low, high, half in PARTS]
    return float(np.min(gaps, initial=np.inf)) - radius
