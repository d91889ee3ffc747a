"""What differs from lap to lap: where the car starts, its camera's noise, the light."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from racecar_description.track.closed_line import Track

START_OFFSET = 0.2  # m, to each side and forwards or backwards, at most
START_TURN = math.radians(10)  # rad, at most
CAMERA_NOISE = (0.01, 0.03)  # standard deviation; 1 is full brightness
LIGHT = (0.7, 1.3)  # times the world's own


@dataclass(frozen=True)
class Disturbance:
    """Of one lap."""

    sideways: float  # m beside the line, positive to the left
    along: float  # m along the line, from where laps begin
    turn: float  # rad from the line's direction, positive to the left
    camera_noise: float  # standard deviation; 1 is full brightness
    light: float  # times the world's own

    def start(self, track: Track) -> tuple[float, float, float]:
        """x, y (m) and yaw (rad) in the world at which the car starts."""
        x, y, heading = track.pose(self.along)
        x -= self.sideways * math.sin(heading)
        y += self.sideways * math.cos(heading)
        return x, y, heading + self.turn


def draw(seed: int) -> Disturbance:
    """The seed's disturbance, evenly distributed between the bounds above."""
    random = np.random.default_rng(seed)
    return Disturbance(
        sideways=random.uniform(-START_OFFSET, START_OFFSET),
        along=random.uniform(-START_OFFSET, START_OFFSET),
        turn=random.uniform(-START_TURN, START_TURN),
        camera_noise=random.uniform(*CAMERA_NOISE),
        light=random.uniform(*LIGHT),
    )
