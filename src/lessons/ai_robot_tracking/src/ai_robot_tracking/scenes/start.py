"""Where a tracking car starts."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ai_robot_tracking.scenes.scene import STANDING, STATIC

START_AWAY = 1.5     # m from the standing cylinder, at least
START_REACH = 4.0    # m from the room's middle, along x and along y


@dataclass(frozen=True)
class Start:
    """Where the car starts; m, rad."""

    x: float
    y: float
    yaw: float


def draw_start(kind: str, seed: int) -> Start:
    """Anywhere in the room if the cylinder stands; in the middle, facing it, if it moves."""
    if kind != STATIC:
        return Start(0.0, 0.0, 0.0)
    random = np.random.default_rng(seed)
    while True:
        x, y = random.uniform(-START_REACH, START_REACH, 2)
        if math.dist((x, y), STANDING) >= START_AWAY:
            return Start(float(x), float(y), float(random.uniform(-math.pi, math.pi)))
