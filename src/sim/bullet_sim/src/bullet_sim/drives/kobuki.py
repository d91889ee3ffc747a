"""Kobuki's base: wheels with a command time-out, odometry, bumpers, wheels without ground."""

import math
from collections.abc import Iterable, Mapping

from bullet_sim.errors import SimulationError
from bullet_sim.joint import Joint
from bullet_sim.physics.contacts import Contact
from bullet_sim.pose import Pose, quaternion_from_rpy
from bullet_sim.sensors.imu import ImuReading, ImuSensor
from bullet_sim.sensors.odometry import OdometryReading
from bullet_sim.world import World

# Contacts below these heights are the floor, above them parts on the base
LOWEST, HIGHEST = 0.01, 0.13  # m above the model frame
SECTORS = {"left": (math.pi / 6, math.pi / 2), "center": (-math.pi / 6, math.pi / 6),
           "right": (-math.pi / 2, -math.pi / 6)}  # rad from straight ahead, counter-clockwise
PATIENCE = 0.1  # s without contact: a wheel that hops over a threshold has not dropped


class Kobuki:
    """Call `update` at every step. Like the real base, it takes the turn from the gyroscope."""

    def __init__(self, world: World, left: Joint, right: Joint, imu: ImuSensor, torque: float,
                 wheel_separation: float, wheel_diameter: float, timeout: float):
        """Torque in N m, separation and diameter in m, `timeout` of a command in s.

        SimulationError for a separation or diameter that is not above 0.
        """
        if wheel_diameter <= 0 or wheel_separation <= 0:
            raise SimulationError(f"wheel diameter {wheel_diameter} and separation "
                                  f"{wheel_separation} must both be more than 0 m")
        self.wheels = (left, right)
        self._world, self._imu = world, imu
        self._torque, self._timeout = torque, timeout
        self._separation, self._radius = wheel_separation, wheel_diameter / 2
        self.reset()

    def command(self, forward: float, yaw_rate: float) -> None:
        """Set the wanted speed (m/s) and yaw rate (rad/s), until the time-out."""
        half = yaw_rate * self._separation / 2
        self._speeds = (forward - half, forward + half)
        self._commanded = self._world.time

    def switch(self, on: bool) -> None:
        """Switch the motors on or off; without power the wheels are held still."""
        self._powered = on

    def reset(self) -> None:
        """Reset to the state after switching on."""
        self._speeds = (0.0, 0.0)
        self._commanded = self._updated = self._world.time
        self._powered = True
        self._imu.restart()
        self._reading: ImuReading | None = None
        self._forward = 0.0
        self.reset_odometry()

    def reset_odometry(self) -> None:
        """Make the current pose the odometry's origin."""
        self._x = self._y = self._yaw = 0.0

    def update(self) -> None:
        """Update the odometry with the last step, then drive."""
        time = self._world.time
        elapsed, self._updated = time - self._updated, time
        self._reading = self._imu.sample()
        left, right = (joint.velocity * self._radius for joint in self.wheels)
        self._forward = (left + right) / 2
        self._x += self._forward * elapsed * math.cos(self._yaw)
        self._y += self._forward * elapsed * math.sin(self._yaw)
        self._yaw += self._reading.angular_velocity[2] * elapsed
        if time - self._commanded > self._timeout or not self._powered:
            self._speeds = (0.0, 0.0)
        for joint, speed in zip(self.wheels, self._speeds, strict=True):
            joint.drive_velocity(speed / self._radius, self._torque)

    def odometry(self) -> OdometryReading:
        """The current estimate."""
        pose = Pose((self._x, self._y, 0.0), quaternion_from_rpy(0.0, 0.0, self._yaw))
        return OdometryReading(self._updated, pose, self._forward, 0.0,
                               self.imu_reading().angular_velocity[2])

    def imu_reading(self) -> ImuReading:
        """The IMU's reading of the last step."""
        if self._reading is None:
            self._reading = self._imu.sample()
        return self._reading


def pressed_bumpers(contacts: Iterable[Contact], link: str, robot: Pose) -> set[str]:
    """Of the three bumpers, those that are pressed: names of `SECTORS`.

    `link` is the bumper's scoped name, `robot` the model frame.
    """
    pressed = set()
    heading = robot.rpy()[2]
    for contact in contacts:
        if link not in contact.links:
            continue
        sign = -1.0 if contact.links[0] == link else 1.0  # from the robot outwards
        if not LOWEST <= contact.position[2] - robot.position[2] <= HIGHEST:
            continue
        angle = math.remainder(
            math.atan2(sign * contact.normal[1], sign * contact.normal[0]) - heading, math.tau)
        pressed |= {name for name, (low, high) in SECTORS.items() if low <= angle <= high}
    return pressed


class WheelDrop:
    """Finds wheels without ground contact. Call `dropped` regularly: it remembers the last one."""

    def __init__(self, wheels: Mapping[str, str], time: float):
        """`wheels`: scoped names of the wheels' links by wheel name; `time` is now (s)."""
        self._wheels = wheels
        self._touched = dict.fromkeys(wheels, time)

    def dropped(self, contacts: Iterable[Contact], time: float) -> set[str]:
        """Names of the wheels without contact for a while, at `time` (s)."""
        touching = {link for contact in contacts for link in contact.links}
        for name, link in self._wheels.items():
            if link in touching or self._touched[name] > time:  # time was reset
                self._touched[name] = time
        return {name for name, last in self._touched.items() if time - last > PATIENCE}
