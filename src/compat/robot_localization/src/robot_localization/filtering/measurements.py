"""What a sensor says, as numbers for the filter."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from robot_localization.filtering.ekf import SIZE, Ekf, angles_of, matrix_of

LEAVES_THE_FLOOR = (2, 3, 4, 8, 9, 10, 14)  # z, roll, pitch, their rates, az: 0 in two_d_mode
FLOOR_VARIANCE = 1e-6
LONG_AGO = 1e5  # s; a longer gap is a clock that was set


class BadConfig(ValueError):
    """A parameter that the filter cannot use."""


@dataclass(frozen=True)
class Measurement:
    """Entries `indices` (m,) of the state at `stamp` (s) are `values` (m,), with `covariance`."""

    stamp: float
    indices: np.ndarray
    values: np.ndarray
    covariance: np.ndarray
    rejection: float = np.inf


def chosen(config: object, name: str) -> np.ndarray:
    """The 15 true or false of parameter `name` as an array (15,)."""
    if (not isinstance(config, Sequence) or isinstance(config, str) or len(config) != SIZE
            or not all(isinstance(value, bool | int) for value in config)):
        raise BadConfig(f"{name} has to be a list of {SIZE} true or false: x y z, roll pitch yaw, "
                        "their velocities, and ax ay az")
    return np.array(config, dtype=bool)


def square(numbers: object, name: str) -> np.ndarray:
    """The 225 numbers, or 15 of a diagonal, of parameter `name` as a matrix (15, 15)."""
    try:
        values = np.array(numbers, dtype=float)
    except (TypeError, ValueError):
        values = np.zeros(0)
    if values.size == SIZE:
        return np.diag(values)
    if values.size != SIZE * SIZE:
        raise BadConfig(f"{name} has to be a list of {SIZE * SIZE} numbers, or of the {SIZE} on "
                        f"the diagonal; it has {values.size}")
    return values.reshape(SIZE, SIZE)


def of_block(stamp: float, config: np.ndarray, first: int, values: np.ndarray,
             covariance: np.ndarray, rejection: float = np.inf) -> Measurement | None:
    """What `config` (15,) chooses of the state's entries from `first` on; None if nothing.

    values: (n,); covariance: (n, n). What is not a number is left out, too; None, if it is the
    covariance of two that are left.
    """
    used = np.flatnonzero(config[first:first + len(values)] & np.isfinite(values)
                          & np.isfinite(np.diag(covariance)))
    kept = covariance[np.ix_(used, used)]
    if not len(used) or not np.isfinite(kept).all():
        return None
    return Measurement(stamp, first + used, values[used], kept, rejection)


def velocity_between(before: np.ndarray, after: np.ndarray, dt: float) -> np.ndarray:
    """vx vy vz and rates (6,) in the body's frame, of two poses (4, 4) `dt` seconds apart."""
    change = np.linalg.inv(before) @ after
    return np.concatenate([change[:3, 3], angles_of(change[:3, :3])]) / dt


def turned(covariance: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """A covariance (6, 6) or (3, 3) after a rotation (3, 3)."""
    block = np.kron(np.eye(len(covariance) // 3), rotation)
    return block @ covariance @ block.T


def moved_twist(twist: np.ndarray, base_from_sensor: np.ndarray) -> np.ndarray:
    """A sensor's velocity and rates (6,) as the body's: its lever arm is taken off."""
    rotation, arm = base_from_sensor[:3, :3], base_from_sensor[:3, 3]
    rates = rotation @ twist[3:]
    return np.concatenate([rotation @ twist[:3] + np.cross(arm, rates), rates])


def without_gravity(acceleration: np.ndarray, rotation: np.ndarray, gravity: float) -> np.ndarray:
    """What an accelerometer says (3,), less what it says at rest, turned as (3, 3) in the world."""
    return acceleration - rotation.T @ np.array([0.0, 0.0, gravity])


@dataclass
class Filter:
    """The filter in time: measurements in any order, estimates in theirs."""

    ekf: Ekf = field(default_factory=Ekf)
    flat: bool = False  # two_d_mode
    stamp: float | None = None  # of the state

    def take(self, measurements: list[Measurement]) -> None:
        """Take in measurements, the oldest first; one from before the state corrects it as is."""
        for measurement in sorted(measurements, key=lambda m: m.stamp):
            if self.stamp is None:
                self._begin(measurement)
                continue
            self.advance(measurement.stamp)
            self.ekf.correct(measurement.indices, measurement.values, measurement.covariance,
                             measurement.rejection)
            self._stay_on_floor()

    def advance(self, stamp: float) -> None:
        """Predict up to `stamp`; nothing if that is past."""
        if self.stamp is None or stamp <= self.stamp:
            return
        dt = stamp - self.stamp
        self.ekf.predict(dt if dt < LONG_AGO else 0.01)
        self.stamp = stamp
        self._stay_on_floor()

    def place(self, stamp: float, pose: np.ndarray, covariance: np.ndarray) -> None:
        """Begin anew at a pose (6,) with its covariance (6, 6), standing still."""
        self.ekf.state = np.zeros(SIZE)
        self.ekf.state[:6] = pose
        self.ekf.covariance = np.eye(SIZE) * 1e-6
        self.ekf.covariance[:6, :6] = covariance
        self.stamp = stamp
        self._stay_on_floor()

    def _begin(self, measurement: Measurement) -> None:
        self.ekf.state[measurement.indices] = measurement.values
        self.ekf.covariance[np.ix_(measurement.indices, measurement.indices)] = (
            measurement.covariance)
        self.stamp = measurement.stamp
        self._stay_on_floor()

    def _stay_on_floor(self) -> None:
        if self.flat:
            floor = np.array(LEAVES_THE_FLOOR)
            self.ekf.correct(floor, np.zeros(len(floor)), np.eye(len(floor)) * FLOOR_VARIANCE)


def turned_by(quaternion: np.ndarray, base_from_sensor: np.ndarray) -> np.ndarray:
    """How the body is turned (3, 3), from how a sensor on it is."""
    return matrix_of(quaternion) @ base_from_sensor[:3, :3].T
