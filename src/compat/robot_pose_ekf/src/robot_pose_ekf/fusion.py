"""Fuses how far each sensor says that the robot moved, by robot_localization's Kalman filter.

Wheels, visual odometry and the yaw of an IMU drift, so only their change since the last update
counts, put to the pose that was estimated there; roll and pitch of an IMU and a GPS's place are
taken as they are. The rules are upstream's (robot_pose_ekf 1.15).
"""

from collections import deque
from dataclasses import dataclass, field

import numpy as np
from robot_localization.filtering.ekf import (
    SIZE,
    Ekf,
    angles_of,
    matrix_of,
    pose_matrix,
    quaternion_of,
)

POSE = np.arange(6)
FREE = 1e6         # variance that a second adds to each entry of the pose: what sensors say counts
HISTORY = 200      # measurements of a sensor that are kept
IMU_VARIANCE = 0.00017**2  # rad^2, of an IMU that gives none
CHANGES = {"odom": POSE, "vo": POSE, "imu": np.array([5]), "gps": np.array([], int)}
USED = {"odom": POSE, "vo": POSE, "imu": POSE[3:], "gps": POSE[:3]}


def matrix(pose: np.ndarray) -> np.ndarray:
    """A transform (4, 4) of x y z, m, and roll pitch yaw, rad, (6,)."""
    return pose_matrix(pose[:3], matrix_of(quaternion_of(pose[3:])))


@dataclass
class Sensor:
    """Poses (6,) with the covariance (6, 6) of the newest."""

    stamps: deque = field(default_factory=lambda: deque(maxlen=HISTORY))
    poses: deque = field(default_factory=lambda: deque(maxlen=HISTORY))
    covariance: np.ndarray = field(default_factory=lambda: np.eye(6))
    heard: float = -np.inf  # when the newest came, s

    def take(self, stamp: float, pose: np.ndarray, covariance: np.ndarray, now: float) -> None:
        """A measurement at `stamp`, s, that came at `now`; one that is not newer is left out."""
        if self.stamps and now < self.heard:  # the clock was set back
            self.stamps.clear()
            self.poses.clear()
        if not self.stamps or stamp > self.stamps[-1]:
            self.stamps.append(stamp)
            self.poses.append(pose)
            self.covariance, self.heard = covariance, now

    def at(self, stamp: float) -> np.ndarray:
        """The pose (6,) then, between those measured; the nearest before the first and after."""
        poses = np.array(self.poses)
        poses[:, 3:] = np.unwrap(poses[:, 3:], axis=0)
        return np.array([np.interp(stamp, self.stamps, column) for column in poses.T])


class Fusion:
    """The sensors by name, and the estimate at `stamp`, s; None before the first odometry."""

    def __init__(self, names: list[str], timeout: float) -> None:
        """`timeout`: s without a measurement after which a sensor no longer counts."""
        self.sensors = {name: Sensor() for name in names}
        self.stamp: float | None = None
        self._timeout = timeout
        self._ekf = Ekf(process_noise=np.diag([FREE] * 6 + [0.0] * (SIZE - 6)))
        self._before: dict[str, np.ndarray] = {}

    def active(self, now: float) -> list[str]:
        """Names of the sensors that count now."""
        return [name for name, sensor in self.sensors.items()
                if 0.0 <= now - sensor.heard <= self._timeout]

    def update(self, now: float) -> bool:
        """Take in what came, up to what all sensors that count have; False if nothing is new."""
        names = self.active(now)
        if not names:
            self._before.clear()  # what is measured after a silence is no step from before it
            return False
        stamp = min(self.sensors[name].stamps[-1] for name in names)
        if self.stamp is None:
            return self._begin(names, stamp)
        if stamp < self.stamp and now < self.stamp:
            self.stamp = None  # the clock was set back
            return self._begin(names, stamp)
        if stamp <= self.stamp:
            return False
        dt, old = stamp - self.stamp, self.pose
        self._ekf.predict(dt)
        for name in names:
            self._correct(name, stamp, old, dt)
        self._before = {name: self.sensors[name].at(stamp) for name in names}
        self.stamp = stamp
        return True

    @property
    def pose(self) -> np.ndarray:
        """x y z, m, and roll pitch yaw, rad, (6,)."""
        return self._ekf.state[:6].copy()

    @property
    def covariance(self) -> np.ndarray:
        """Of the pose, (6, 6)."""
        return self._ekf.covariance[:6, :6].copy()

    def _begin(self, names: list[str], stamp: float) -> bool:
        first = next((name for name in ("gps", "odom", "vo") if name in names), None)
        if first is None:
            return False
        self._ekf.state = np.zeros(SIZE)
        self._ekf.state[:6] = self.sensors[first].at(stamp)
        self._ekf.covariance = np.diag([1e-6] * 6 + [0.0] * (SIZE - 6))
        self._before = {name: self.sensors[name].at(stamp) for name in names}
        self.stamp = stamp
        return True

    def _correct(self, name: str, stamp: float, old: np.ndarray, dt: float) -> None:
        sensor, used, changes = self.sensors[name], USED[name], CHANGES[name]
        measured = sensor.at(stamp)
        if len(changes):
            if name not in self._before:
                return
            before = self._before[name]
            if name == "imu":
                measured[5] = old[5] + measured[5] - before[5]
            else:
                moved = matrix(old) @ np.linalg.inv(matrix(before)) @ matrix(measured)
                measured = np.concatenate([moved[:3, 3], angles_of(moved[:3, :3])])
        self._ekf.correct(used, measured[used], sensor.covariance[np.ix_(used, used)] * dt * dt)
