"""Dead reckoning in the plane: adds up small motions and averages the speeds of the last few."""

import math
from collections import deque

from bullet_sim.pose import Pose, quaternion_from_rpy
from bullet_sim.sensors.odometry import OdometryReading

# s; no speed is computed from a shorter time (diff_drive_controller's odometry.cpp, update)
SHORTEST = 1e-4
STRAIGHT = 1e-6  # rad; a smaller turn counts as straight


class PlanarOdometry:
    """Starts at zero, at any pose in the world; speeds are averaged over `window` updates."""

    def __init__(self, window: int):
        self._speeds: deque[tuple[float, float, float]] = deque(maxlen=max(1, window))
        self._x = self._y = self._yaw = 0.0
        self._time = 0.0

    def restart(self, time: float) -> None:
        """Continue from the same pose; time counts from here, and speeds start at zero."""
        self._time = time
        self._speeds.clear()

    def move(self, time: float, forward: float, leftward: float, turn: float) -> None:
        """Add the motion since the last call, in m and rad, in the frame of the pose before."""
        elapsed = time - self._time
        if elapsed < 0:  # time was reset, and joints with it
            self.restart(time)
            return
        self._advance(forward, leftward, turn)
        if elapsed < SHORTEST:
            return
        self._time = time
        self._speeds.append((forward / elapsed, leftward / elapsed, turn / elapsed))

    def update_open_loop(self, time: float, forward: float, yaw_rate: float) -> None:
        """Open loop: use these speeds (m/s, rad/s) as the motion since the last call."""
        elapsed = max(0.0, time - self._time)
        self._time = time
        self._speeds.clear()
        self._speeds.append((forward, 0.0, yaw_rate))
        self._advance(forward * elapsed, 0.0, yaw_rate * elapsed)

    def sample(self) -> OdometryReading:
        """The current estimate."""
        pose = Pose((self._x, self._y, 0.0), quaternion_from_rpy(0.0, 0.0, self._yaw))
        count = max(1, len(self._speeds))
        forward, leftward, yaw_rate = (
            sum(speed[i] for speed in self._speeds) / count for i in range(3))
        return OdometryReading(self._time, pose, forward, leftward, yaw_rate)

    def _advance(self, forward: float, leftward: float, turn: float) -> None:
        """Move along the arc of constant twist: the exponential map of SE(2)."""
        if abs(turn) < STRAIGHT:
            along, across = 1.0, turn / 2
        else:
            along, across = math.sin(turn) / turn, (1.0 - math.cos(turn)) / turn
        dx, dy = along * forward - across * leftward, across * forward + along * leftward
        cos, sin = math.cos(self._yaw), math.sin(self._yaw)
        self._x += cos * dx - sin * dy
        self._y += sin * dx + cos * dy
        self._yaw += turn
