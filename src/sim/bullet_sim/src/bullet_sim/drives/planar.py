"""A model that is moved in the plane as a whole, without wheels."""

import math

from bullet_sim.model import Model
from bullet_sim.physics.auto_disable import REST_RATE, REST_SPEED
from bullet_sim.pose import quaternion_from_rpy, rotate
from bullet_sim.sensors.odometry import OdometryReading
from bullet_sim.twist import Twist
from bullet_sim.world import World


class PlanarDrive:
    """Call `update` at every step: between two calls the model falls and collides normally."""

    def __init__(self, model: Model):
        self._model = model
        self.stop()

    def command(self, forward: float, leftward: float, yaw_rate: float) -> None:
        """Set the wanted speeds (m/s) in the model's heading and the yaw rate (rad/s)."""
        self._wanted = (forward, leftward, yaw_rate)

    def stop(self) -> None:
        """Stand still, until the next command."""
        self._wanted = (0.0, 0.0, 0.0)

    def update(self) -> None:
        """Give the model the wanted velocity; none upwards (gazebo_ros_planar_move.cpp)."""
        if not any(self._wanted) and self._still():
            return  # so that a world where nothing moves can come to rest
        forward, leftward, yaw_rate = self._wanted
        yaw = self._model.pose.rpy()[2]
        cos, sin = math.cos(yaw), math.sin(yaw)
        self._model.set_velocity(Twist(
            (forward * cos - leftward * sin, leftward * cos + forward * sin, 0.0),
            (0.0, 0.0, yaw_rate)))

    def _still(self) -> bool:
        twist = self._model.twist
        return (max(map(abs, twist.linear)) < REST_SPEED
                and max(map(abs, twist.angular)) < REST_RATE)


class PlanarOdometry:
    """The model frame in the world; speeds from the distance since the last sample."""

    def __init__(self, world: World, model: Model):
        self._world, self._model = world, model
        self.restart()

    def restart(self) -> None:
        """Forget the last pose."""
        self._time, self._pose = self._world.time, self._model.pose

    def sample(self) -> OdometryReading:
        """The current pose and speeds."""
        time, pose = self._world.time, self._model.pose
        elapsed, before = time - self._time, self._pose
        self._time, self._pose = time, pose
        if elapsed <= 0:
            return OdometryReading(time, pose, 0.0, 0.0, 0.0)
        yaw = pose.rpy()[2]
        way = [now - then for now, then in zip(pose.position, before.position, strict=True)]
        forward, leftward, _ = rotate(quaternion_from_rpy(0.0, 0.0, -yaw), way)
        turn = math.remainder(yaw - before.rpy()[2], 2 * math.pi)
        return OdometryReading(time, pose, forward / elapsed, leftward / elapsed, turn / elapsed)
