"""Lengths of a robot's base: from parameters, else from its URDF."""

import math

from bullet_sim.formats.urdf.facts import RobotFacts
from bullet_sim_ros.control.controller_parameters import ControllerParameters


def read_distance(p: ControllerParameters, robot: RobotFacts, name: str, first: str, second: str,
                  axis: int | None = None) -> float:
    """A parameter, else the distance of two joints, m; with `axis` (0: x, 1: y) along that axis."""
    if p.has(name):
        return p.number(name)
    one, other = robot.pose(first).position, robot.pose(second).position
    return math.dist(one, other) if axis is None else abs(one[axis] - other[axis])


def read_wheel_radius(p: ControllerParameters, robot: RobotFacts, joint: str) -> float:
    """The parameter `wheel_radius`, else the radius of the wheel on a joint, m."""
    return p.number("wheel_radius") if p.has("wheel_radius") else robot.wheel_radius(joint)
