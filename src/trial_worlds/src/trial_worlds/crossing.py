"""A person walks across the robot's path, close in front of it.

The robot drives straight through an empty room. The person waits beside its path, sets off when
the robot has reached `trigger`, and walks in a straight line whatever the robot does. If the robot
drives on at full speed, the person's centre crosses its line `ahead` m in front of it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

PERSON_RADIUS, PERSON_HEIGHT = 0.25, 1.7  # m
ROBOT_SPEED, ROBOT_FRONT = 0.26, 0.073    # m/s, m before base_footprint
ROOM = ((-1.0, 6.0), (-3.5, 3.5))         # m, its walls in x and y
START, GOAL = (0.0, 0.0, 0.0), (5.0, 0.0, 0.0)
APPROACH = 2.6                  # m from the person's start to the robot's line
SPEED = (1.0, 1.4)              # m/s
WHERE = (2.0, 3.5)              # m along the robot's line at which the person crosses it
SLANT = math.radians(30)        # largest angle, to either side, from straight across
AHEAD = (0.3, 0.6)              # m from the robot's front to the person's centre


@dataclass(frozen=True)
class Crossing:
    """One walk."""

    seed: int
    side: int       # 1: from the left, -1: from the right
    speed: float    # m/s
    where: float    # m, x at which the person crosses the robot's line
    slant: float    # rad, positive: in the robot's direction
    ahead: float    # m

    @property
    def heading(self) -> float:
        """Direction of the walk, rad."""
        return -self.side * (math.pi / 2 - self.slant)

    @property
    def begin(self) -> tuple[float, float, float]:
        """x, y, yaw at which the person waits; m, rad."""
        return (self.where - APPROACH * math.cos(self.heading),
                -APPROACH * math.sin(self.heading), self.heading)

    @property
    def trigger(self) -> float:
        """x of the robot's base at which the person sets off, m."""
        return self.where - self.ahead - ROBOT_FRONT - ROBOT_SPEED * APPROACH / self.speed


def draw_crossing(seed: int) -> Crossing:
    """The seed's walk, uniformly distributed between the bounds above."""
    random = np.random.default_rng(seed)
    return Crossing(seed, int(random.choice((-1, 1))), random.uniform(*SPEED),
                    random.uniform(*WHERE), random.uniform(-SLANT, SLANT), random.uniform(*AHEAD))
