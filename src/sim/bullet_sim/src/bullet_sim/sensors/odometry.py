"""Odometry from the world's truth or from wheels; a link's true pose and twist."""

import math
from dataclasses import dataclass

from bullet_sim.link import Link
from bullet_sim.model import Model
from bullet_sim.pose import Pose, quaternion_from_rpy, rotate
from bullet_sim.twist import Twist, shifted_twist, twist_difference, twist_in
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


@dataclass(frozen=True)
class GroundTruthReading:
    """Pose and twist of a frame's origin, both in the axes of the reference frame."""

    time: float  # s, simulated
    pose: Pose
    twist: Twist


class GroundTruth:
    """A frame fixed to a link at `offset` (m, rad), relative to another link or to the world."""

    def __init__(self, world: World, link: Link, offset: Pose, reference: Link | None = None):
        self._world, self._link, self._offset, self._reference = world, link, offset, reference

    def sample(self) -> GroundTruthReading:
        """The current pose and twist."""
        pose = self._link.pose * self._offset
        twist = shifted_twist(self._link.twist, self._link.pose.position, pose.position)
        if self._reference is None:
            return GroundTruthReading(self._world.time, pose, twist)
        seen_from = self._reference.pose
        carried = shifted_twist(self._reference.twist, seen_from.position, pose.position)
        return GroundTruthReading(self._world.time, seen_from.inverse() * pose,
                                  twist_in(seen_from, twist_difference(twist, carried)))
