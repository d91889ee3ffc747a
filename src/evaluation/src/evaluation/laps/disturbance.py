"""Disturbances that vary from lap to lap: start pose, camera noise, light."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from racecar_description.track.closed_line import Track


@dataclass(frozen=True)
class Disturbance:
    """The disturbance of one lap."""

    sideways: float  # m beside the line, positive to the left
    along: float  # m along the line, from the start of laps
    turn: float  # rad from the line's direction, positive to the left
    camera_noise: float  # standard deviation; 1 is full brightness
    light: float  # factor on the world's own light

    def start(self, track: Track) -> tuple[float, float, float]:
        """The car's start pose: x, y (m) and yaw (rad) in the world."""
        x, y, heading = track.pose(self.along)
        x -= self.sideways * math.sin(heading)
        y += self.sideways * math.cos(heading)
        return x, y, heading + self.turn


@dataclass(frozen=True)
class Bounds:
    """Bounds of random disturbances: m and rad to either side; other units as in Disturbance."""

    sideways: float
    along: float
    turn: float
    camera_noise: tuple[float, float]
    light: tuple[float, float]


# For race-trials, and for learning environments that use the trials' disturbances.
RACE = Bounds(sideways=0.2, along=0.2, turn=math.radians(10), camera_noise=(0.01, 0.03),
              light=(0.7, 1.3))


def draw(seed: int, bounds: Bounds) -> Disturbance:
    """The seed's disturbance, uniformly distributed between the bounds."""
    random = np.random.default_rng(seed)
    return Disturbance(
        sideways=random.uniform(-bounds.sideways, bounds.sideways),
        along=random.uniform(-bounds.along, bounds.along) if bounds.along else 0.0,
        turn=random.uniform(-bounds.turn, bounds.turn),
        camera_noise=random.uniform(*bounds.camera_noise),
        light=random.uniform(*bounds.light),
    )
