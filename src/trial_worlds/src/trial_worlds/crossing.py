"""A person walks across the robot's way, close before it.

The robot drives straight through an empty room. The person waits beside, sets off when the robot
has come so far, and walks on in a straight line whatever the robot does. The walk is drawn so that
a robot that drives on at full speed would have the person's middle `ahead` of its front when that
comes to its line.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

PERSON_RADIUS, PERSON_HEIGHT = 0.25, 1.7  # m
ROBOT_SPEED, ROBOT_FRONT = 0.26, 0.073    # m/s, m before base_footprint
ROOM = ((-1.0, 6.0), (-3.5, 3.5))         # m, its walls in x and y
START, GOAL = (0.0, 0.0, 0.0), (5.0, 0.0, 0.0)
APPROACH = 2.6                  # m that the person walks to the robot's line
SPEED = (1.0, 1.4)              # m/s
WHERE = (2.0, 3.5)              # m along the robot's line
SLANT = math.radians(30)        # most, to either side of straight across
AHEAD = (0.3, 0.6)              # m from the robot's front to the person's middle


@dataclass(frozen=True)
class Crossing:
    """One walk."""

    seed: int
    side: int       # 1: from the left, -1: from the right
    speed: float    # m/s
    where: float    # m, x at which the person comes to the robot's line
    slant: float    # rad, positive: along with the robot
    ahead: float    # m

    @property
    def heading(self) -> float:
        """rad, of the walk."""
        return -self.side * (math.pi / 2 - self.slant)

    @property
    def begin(self) -> tuple[float, float, float]:
        """x, y, yaw at which the person waits; m, rad."""
        return (self.where - APPROACH * math.cos(self.heading),
                -APPROACH * math.sin(self.heading), self.heading)

    @property
    def trigger(self) -> float:
        """m, x of the robot's base at which the person sets off."""
        return self.where - self.ahead - ROBOT_FRONT - ROBOT_SPEED * APPROACH / self.speed


def draw_crossing(seed: int) -> Crossing:
    """The seed's walk, evenly distributed between the bounds above."""
    random = np.random.default_rng(seed)
    return Crossing(seed, int(random.choice((-1, 1))), random.uniform(*SPEED),
                    random.uniform(*WHERE), random.uniform(-SLANT, SLANT), random.uniform(*AHEAD))
