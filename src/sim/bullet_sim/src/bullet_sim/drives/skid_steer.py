"""Skid steering: the wheels of each side turn at one speed."""

from __future__ import annotations

from collections.abc import Sequence

from bullet_sim.errors import SimulationError
from bullet_sim.joint import Joint


class SkidSteer:
    """Turns (forward, yaw rate) into motor targets; call `update` at the drive's own rate."""

    def __init__(self, left: Sequence[Joint], right: Sequence[Joint], wheel_separation: float,
                 wheel_diameter: float, torque: float):
        """Separation and diameter in m, torque in N m for each wheel.

        As in gazebo_ros_skid_steer_drive.cpp, a negative separation reverses turns, and a negative
        diameter reverses all.
        SimulationError for a separation or diameter of 0.
        """
        if not wheel_diameter or not wheel_separation:
            raise SimulationError(f"wheel diameter {wheel_diameter} and separation "
                                  f"{wheel_separation} must not be 0 m")
        self._sides = (tuple(left), tuple(right))
        self._separation = wheel_separation
        self._radius = wheel_diameter / 2
        self._torque = torque
        self.stop()

    def command(self, forward: float, yaw_rate: float) -> None:
        """Wanted speed (m/s) and rate of yaw (rad/s); held until the next command."""
        half = yaw_rate * self._separation / 2
        self._speeds = (forward - half, forward + half)

    def stop(self) -> None:
        """Forget the command."""
        self._speeds = (0.0, 0.0)

    def update(self) -> None:
        """Give the motors their targets."""
        for joints, speed in zip(self._sides, self._speeds, strict=True):
            for joint in joints:
                joint.drive_velocity(speed / self._radius, self._torque)
