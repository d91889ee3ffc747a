"""A person walks across the robot's path, close in front of it.

The robot drives straight through an empty room. The person waits beside its path, sets off when
the robot has reached `trigger`, and walks in a straight line whatever the robot does. If the robot
drives on at full speed, the person's centre crosses its line `ahead` m in front of it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rospkg import RosPack

from trial_worlds.yard import RADIUS, Yard

# The waffle's collision shapes in base_footprint, m: least x, greatest x, half width.
WAFFLE_PARTS = ((-0.197, 0.069, 0.133),   # body
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
                     np.maximum(aside - half, 0.0)) for low, high, half in WAFFLE_PARTS]
    return float(np.min(gaps, initial=np.inf)) - radius


PERSON_RADIUS = 0.25  # m, as in person.sdf
ROBOT_SPEED, ROBOT_FRONT = 0.26, 0.073    # m/s, m before base_footprint
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


HEIGHT = 0.5  # m, of cylinders
PERSON_TOPIC = "person/cmd_vel"


def model(name: str) -> str:
    """The SDF of models/NAME.sdf: a room, or a person whom commands on PERSON_TOPIC move."""
    return (Path(RosPack().get_path("trial_worlds")) / "models" / f"{name}.sdf").read_text("utf-8")


def yard_model(yard: Yard) -> str:
    """A static model of all the yard's cylinders."""
    shape = f"<cylinder><radius>{RADIUS:.5f}</radius><length>{HEIGHT}</length></cylinder>"
    parts = "".join(
        f'<{kind} name="{number}"><pose>{x:.5f} {y:.5f} {HEIGHT / 2} 0 0 0</pose>'
        f"<geometry>{shape}</geometry></{kind}>\n"
        for number, (x, y) in enumerate(yard.cylinders) for kind in ("collision", "visual"))
    return ('<sdf version="1.6"><model name="yard"><static>true</static><link name="parts">\n'
            f"{parts}</link></model></sdf>")


def world(model: str) -> str:
    """A world file with one model, given as SDF, on the ground."""
    inner = model.removeprefix('<sdf version="1.6">').removesuffix("</sdf>")
    return ('<?xml version="1.0"?>\n<sdf version="1.6"><world name="default">\n'
            "<scene><shadows>0</shadows></scene>\n"
            "<include><uri>model://sun</uri></include>\n"
            "<include><uri>model://ground_plane</uri></include>\n"
            f"{inner}\n</world></sdf>\n")
