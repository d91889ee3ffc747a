"""A person walks across the robot's path, close in front of it.

The robot drives straight through an empty room. The person waits beside its path, sets off when
the robot has reached `trigger`, and walks in a straight line whatever the robot does. If the robot
drives on at full speed, the person's centre crosses its line `ahead` m in front of it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

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


HEIGHT, THICKNESS = 0.5, 0.1  # m, of cylinders and walls
PERSON_TOPIC = "person/cmd_vel"


def yard_model(yard: Yard) -> str:
    """A static model of all the yard's cylinders."""
    shape = f"<cylinder><radius>{RADIUS:.5f}</radius><length>{HEIGHT}</length></cylinder>"
    return _static("yard", [(f"{x:.5f} {y:.5f} {HEIGHT / 2} 0 0 0", shape)
                            for x, y in yard.cylinders])


def room_model() -> str:
    """The four walls of the room in which a person crosses."""
    (left, right), (low, high) = ROOM
    middle_x, middle_y, height = (left + right) / 2, (low + high) / 2, HEIGHT / 2
    along = f"<box><size>{right - left:g} {THICKNESS} {HEIGHT}</size></box>"
    across = f"<box><size>{THICKNESS} {high - low:g} {HEIGHT}</size></box>"
    return _static("yard", [(f"{middle_x:g} {low:g} {height} 0 0 0", along),
                            (f"{middle_x:g} {high:g} {height} 0 0 0", along),
                            (f"{left:g} {middle_y:g} {height} 0 0 0", across),
                            (f"{right:g} {middle_y:g} {height} 0 0 0", across)])


def person_model() -> str:
    """A cylinder that is moved by commands on PERSON_TOPIC; it floats, so nothing slows it."""
    shape = (f"<geometry><cylinder><radius>{PERSON_RADIUS}</radius>"
             f"<length>{PERSON_HEIGHT}</length></cylinder></geometry>")
    return (
        '<sdf version="1.6"><model name="person"><link name="body">'
        f"<pose>0 0 {PERSON_HEIGHT / 2 + 0.01} 0 0 0</pose><gravity>false</gravity>"
        "<inertial><mass>70</mass><inertia><ixx>20</ixx><ixy>0</ixy><ixz>0</ixz><iyy>20</iyy>"
        "<iyz>0</iyz><izz>2</izz></inertia></inertial>"
        f'<collision name="body">{shape}</collision><visual name="body">{shape}</visual></link>'
        '<plugin name="walk" filename="libgazebo_ros_planar_move.so">'
        f"<commandTopic>{PERSON_TOPIC}</commandTopic><odometryRate>0</odometryRate>"
        "</plugin></model></sdf>"
    )


def world(model: str) -> str:
    """A world file with one model, given as SDF, on the ground."""
    inner = model.removeprefix('<sdf version="1.6">').removesuffix("</sdf>")
    return ('<?xml version="1.0"?>\n<sdf version="1.6"><world name="default">\n'
            "<scene><shadows>0</shadows></scene>\n"
            "<include><uri>model://sun</uri></include>\n"
            "<include><uri>model://ground_plane</uri></include>\n"
            f"{inner}\n</world></sdf>\n")


def _static(name: str, shapes: list[tuple[str, str]]) -> str:
    """A static model of shapes (pose, geometry)."""
    parts = "".join(
        f'<{kind} name="{number}"><pose>{pose}</pose><geometry>{shape}</geometry></{kind}>\n'
        for number, (pose, shape) in enumerate(shapes) for kind in ("collision", "visual"))
    return (f'<sdf version="1.6"><model name="{name}"><static>true</static><link name="parts">\n'
            f"{parts}</link></model></sdf>")
