"""No to and fro: a direction that was turned round may not be turned again on the spot."""

from __future__ import annotations

import numpy as np

from nav_algorithms.poses import wrap_angle


class Oscillation:
    """Per axis, the sign of the last motion, and the only sign allowed until the robot has moved.

    As dwa_local_planner's flags: forward and backward always count, strafing and turning only
    where the robot does not drive.
    """

    def __init__(self, reset_distance: float, reset_angle: float) -> None:
        """The robot has moved after `reset_distance`, m, or `reset_angle`, rad."""
        self.reset_distance, self.reset_angle = reset_distance, reset_angle
        self.reset()

    def reset(self) -> None:
        """Forgets all."""
        self.last = np.zeros(3)
        self.only = np.zeros(3)
        self.where = np.zeros(3)

    def allowed(self, samples: np.ndarray) -> np.ndarray:
        """Which of the samples (S, 3) may be taken, bool (S,)."""
        return (samples * self.only >= 0.0).all(axis=1)

    def took(self, velocity: np.ndarray, pose: np.ndarray, min_vel_trans: float) -> None:
        """Remembers what was commanded at `pose`."""
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
        if self.only.any():
            moved = np.hypot(*(pose[:2] - self.where[:2]))
            if (moved > self.reset_distance
                    or abs(wrap_angle(pose[2] - self.where[2])) > self.reset_angle):
                self.reset()
