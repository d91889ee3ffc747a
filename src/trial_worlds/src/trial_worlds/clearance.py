"""How much air there is between the waffle and round things."""

from __future__ import annotations

import numpy as np

# Of the waffle's collision shapes about base_footprint, m: least x, greatest x, half the width.
PARTS = ((-0.197, 0.069, 0.133),   # body
         (-0.033, 0.033, 0.153),   # both wheels
         (0.061, 0.073, 0.066))    # camera
CONTACT = 0.001  # m; the engine lets touching things sink into each other by less


def clearance(pose: tuple[float, float, float], centres: np.ndarray, radius: float) -> float:
    """m between the waffle at `pose` (x, y, yaw) and the nearest circle about `centres` (N, 2).

    Negative inside. inf without circles.
    """
    x, y, yaw = pose
    away = np.asarray(centres, float).reshape(-1, 2) - (x, y)
    ahead = away @ (np.cos(yaw), np.sin(yaw))
    aside = np.abs(away @ (-np.sin(yaw), np.cos(yaw)))
    gaps = [np.hypot(np.maximum(np.maximum(low - ahead, ahead - high), 0.0),
                     np.maximum(aside - half, 0.0)) for low, high, half in PARTS]
    return float(np.min(gaps, initial=np.inf)) - radius
