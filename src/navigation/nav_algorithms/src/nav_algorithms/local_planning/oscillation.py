"""Prevents oscillation: after a reversal, the direction may not be reversed again on the spot."""

from __future__ import annotations

import numpy as np

from nav_algorithms.poses import wrap_angle

GROWTH, LARGEST = 2.0, 3.0  # of the angle, rad; differences are at most half a turn


class Oscillation:
    """Per axis, the sign of the last motion, and the only sign allowed until the robot has moved.

    As dwa_local_planner's flags: forward and backward always count, strafing and turning only
    if the robot does not drive. Unlike there, the angle that counts as a move grows each time the
    robot has only turned: it looks farther round instead of oscillating for ever.
    """

    def __init__(self, reset_distance: float, reset_angle: float) -> None:
        """The robot has moved after `reset_distance`, m, or `reset_angle`, rad."""
        self.reset_distance, self.reset_angle = reset_distance, reset_angle
        self.reset()

    def reset(self) -> None:
        """Forget everything."""
        self._begin_anew()
        self.angle = self.reset_angle
        self.spot = np.zeros(2)  # where the robot has only turned

    def _begin_anew(self) -> None:
        self.last = np.zeros(3)
        self.only = np.zeros(3)
        self.where = np.zeros(3)

    def allowed(self, samples: np.ndarray) -> np.ndarray:
        """Which of the samples (S, 3) are allowed, bool (S,)."""
        return (samples * self.only >= 0.0).all(axis=1)

    def took(self, velocity: np.ndarray, pose: np.ndarray, min_vel_trans: float) -> None:
        """Remember the command at `pose`."""
        turned = False
        for axis in range(3):
            if axis and abs(velocity[0]) > min_vel_trans:
                continue
            sign = np.sign(velocity[axis])
            if sign and self.last[axis] == -sign:
                self.only[axis], turned = sign, True
            if sign:
                self.last[axis] = sign
        if turned:
            self.where = np.array(pose, float)

    def at(self, pose: np.ndarray) -> None:
        """Take the robot's pose: far enough from where it reversed, everything is allowed."""
        if np.hypot(*(pose[:2] - self.spot)) > self.reset_distance:
            self.angle, self.spot = self.reset_angle, pose[:2].copy()
        if not self.only.any():
            return
        if np.hypot(*(pose[:2] - self.where[:2])) > self.reset_distance:
            self._begin_anew()
        elif abs(wrap_angle(pose[2] - self.where[2])) > self.angle:
            self._begin_anew()
            self.angle = min(GROWTH * self.angle, LARGEST)
