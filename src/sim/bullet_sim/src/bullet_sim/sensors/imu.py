"""Gazebo's IMU sensor (gravity included), and the true motion of a link (without)."""

from dataclasses import dataclass

import numpy as np

from bullet_sim.description import SensorDescription
from bullet_sim.link import Link
from bullet_sim.pose import IDENTITY, Quaternion, Vector3, conjugate, multiply, rotate
from bullet_sim.sensors.noise import SensorNoise
from bullet_sim.twist import shifted_twist
from bullet_sim.world import World


@dataclass(frozen=True)
class ImuReading:
    """In the axes of the sensor, with gravity and noise, unlike a LinkMotionReading."""

    time: float  # s, simulated
    orientation: Quaternion  # sensor in the reference frame, by default the world
    angular_velocity: Vector3  # rad/s
    linear_acceleration: Vector3  # m/s^2, the specific force: at rest g upwards


class ImuSensor:
    """Measures at the sensor's origin, with the noise of its SDF element.

    Orientations are in the world or, with `from_first`, relative to the first one.
    """

    def __init__(self, world: World, link: Link, description: SensorDescription,
                 from_first: bool = False):
        self._world, self._link, self._mount = world, link, description.pose
        first = (link.pose * description.pose).orientation
        self._reference = conjugate(first) if from_first else IDENTITY.orientation
        name = f"{link.scoped_name}::{description.name}"
        self._gyroscope = SensorNoise(world, f"{name} rate", description.imu.angular_velocity)
        self._accelerometer = SensorNoise(
            world, f"{name} acceleration", description.imu.linear_acceleration)
        self.restart()

    def restart(self) -> None:
        """Forget the last velocity."""
        self._last: tuple[float, Vector3] | None = None

    def sample(self) -> ImuReading:
        """The acceleration is the mean since the last sample; at first, gravity alone."""
        link_pose = self._link.pose
        pose, time = link_pose * self._mount, self._world.time
        twist = shifted_twist(self._link.twist, link_pose.position, pose.position)
        felt = -np.array(self._world.description.gravity)
        if self._last is not None and time > self._last[0]:
            felt += np.subtract(twist.linear, self._last[1]) / (time - self._last[0])
        self._last = (time, twist.linear)
        back = conjugate(pose.orientation)
        rate = self._gyroscope.apply(np.array(rotate(back, twist.angular)))
        acceleration = self._accelerometer.apply(np.array(rotate(back, felt)))
        return ImuReading(time, multiply(self._reference, pose.orientation),
                          tuple(rate.tolist()), tuple(acceleration.tolist()))


@dataclass(frozen=True)
class LinkMotionReading:
    """Of the link's origin, in world axes, without gravity and noise; not an IMU's reading."""

    time: float  # s, simulated
    orientation: Quaternion  # link in the world
    world_angular_velocity: Vector3  # rad/s
    world_acceleration: Vector3  # m/s^2, mean since the last sample


class LinkMotion:
    """Samples a link; IMU plugins rotate the readings into their axes and add noise."""

    def __init__(self, world: World, link: Link):
        self._world = world
        self._link = link
        self.restart()

    def restart(self) -> None:
        """Forget the last velocity."""
        self._last: tuple[float, Vector3] | None = None

    def sample(self) -> LinkMotionReading:
        """Read the link; the first acceleration is zero."""
        time, twist = self._world.time, self._link.twist
        acceleration = (0.0, 0.0, 0.0)
        if self._last is not None and time > self._last[0]:
            elapsed = time - self._last[0]
            acceleration = tuple(
                (now - before) / elapsed
                for now, before in zip(twist.linear, self._last[1], strict=True)
            )
        self._last = (time, twist.linear)
        return LinkMotionReading(time, self._link.pose.orientation, twist.angular, acceleration)
