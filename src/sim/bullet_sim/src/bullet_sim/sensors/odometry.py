"""Odometry: a robot's pose, from the world's truth or from its wheels."""

import math
from dataclasses import dataclass

from bullet_sim.model import Model
from bullet_sim.pose import Pose, quaternion_from_rpy, rotate
from bullet_sim.world import World


@dataclass(frozen=True)
class OdometryReading:
    """Pose of the base in the odometry frame; speeds in the base's heading."""

    time: float  # s, simulated
    pose: Pose
    forward: float  # m/s
    leftward: float  # m/s
    yaw_rate: float  # rad/s


def true_odometry(world: World, model: Model) -> OdometryReading:
    """The model frame in the world; speeds rotated by yaw alone.

    As gazebo_ros_diff_drive.cpp, publishOdometry.
    """
    pose, twist = model.pose, model.twist
    heading = quaternion_from_rpy(0.0, 0.0, -pose.rpy()[2])
    forward, leftward, _ = rotate(heading, twist.linear)
    return OdometryReading(world.time, pose, forward, leftward, twist.angular[2])


class WheelOdometry:
    """Dead reckoning of a differential drive from its wheel rates, planar, starting at zero."""

    def __init__(self, wheel_separation: float, wheel_diameter: float, signed: bool = False):
        self._separation = wheel_separation
        self._signed = signed
        self._radius = wheel_diameter / 2
        self.restart(0.0)

    def restart(self, time: float) -> None:
        """Forget the distance driven."""
        self._x = self._y = self._yaw = 0.0
        self._time = time
        self._speed = self._yaw_rate = 0.0

    def update(self, time: float, left_rate: float, right_rate: float) -> None:
        """Wheel velocities (rad/s) since the last update."""
        elapsed = time - self._time
        self._time = time
        if elapsed <= 0:
            return
        left, right = left_rate * self._radius * elapsed, right_rate * self._radius * elapsed
        way, turn = (left + right) / 2, (right - left) / self._separation
        self._x += way * math.cos(self._yaw + turn / 2)
        self._y += way * math.sin(self._yaw + turn / 2)
        self._yaw += turn
        # gazebo_ros_diff_drive reports the length of the way, so backwards is positive, too.
        self._speed = (way if self._signed else abs(way)) / elapsed
        self._yaw_rate = turn / elapsed

    def sample(self) -> OdometryReading:
        """The current estimate."""
        pose = Pose((self._x, self._y, 0.0), quaternion_from_rpy(0.0, 0.0, self._yaw))
        return OdometryReading(self._time, pose, self._speed, 0.0, self._yaw_rate)
