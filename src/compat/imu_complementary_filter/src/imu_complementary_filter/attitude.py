"""The attitude of an IMU from its rates, corrected by gravity and the magnetic field.

R. G. Valenti, I. Dryanovski, J. Xiao, "Keeping a good attitude: a quaternion-based orientation
filter for IMUs and MARGs" (2015); the corrections are rotation vectors here, not quaternions.
"""

from dataclasses import dataclass, field

import numpy as np

GRAVITY = 9.81          # m/s2
STILL_RATE = 0.2        # rad/s, of an IMU that does not turn
STILL_CHANGE = 0.1      # m/s2 off gravity, of one that stands
STILL_STEP = 0.01       # rad/s between two measurements
ADAPT = 0.1, 0.2        # |a| / g - 1 up to which the gain is whole, and from which it is 0


def product(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Of two quaternions (x, y, z, w): the second rotation, then the first."""
    vector = (first[3] * second[:3] + second[3] * first[:3] + np.cross(first[:3], second[:3]))
    return np.array([*vector, first[3] * second[3] - first[:3] @ second[:3]])


def rotation_by(vector: np.ndarray) -> np.ndarray:
    """The quaternion of a rotation vector (3,), rad."""
    angle = float(np.linalg.norm(vector))
    return np.array([*(vector * (0.5 * np.sinc(angle / (2 * np.pi)))), np.cos(angle / 2)])


def turned(quaternion: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """A vector (3,) after the rotation."""
    across = 2.0 * np.cross(quaternion[:3], vector)
    return vector + quaternion[3] * across + np.cross(quaternion[:3], across)


@dataclass
class Attitude:
    """`quaternion` (x, y, z, w) of the IMU in the world, whose z is up; None before the first.

    Gains are shares from 0 to 1 of what is off that a measurement corrects. Without a magnetic
    field yaw begins at 0. `bias` (3,), rad/s, is what the rates are while it stands still.
    """

    gain_acc: float = 0.01
    gain_mag: float = 0.01
    bias_alpha: float = 0.01
    do_bias_estimation: bool = True
    do_adaptive_gain: bool = True
    quaternion: np.ndarray | None = None
    bias: np.ndarray = field(default_factory=lambda: np.zeros(3))
    is_still: bool = False
    _rates: np.ndarray = field(default_factory=lambda: np.zeros(3))

    def update(self, acceleration: np.ndarray, rates: np.ndarray, dt: float,
               magnetic: np.ndarray | None = None) -> None:
        """A measurement (3,), m/s2 and rad/s, `dt` s after the last; `magnetic` (3,), any unit."""
        size = float(np.linalg.norm(acceleration))
        if self.quaternion is None:
            self.quaternion = np.array([0.0, 0.0, 0.0, 1.0])
            gain_acc = gain_mag = 1.0
        else:
            self._estimate_bias(size, rates)
            self.quaternion = product(self.quaternion, rotation_by((rates - self.bias) * dt))
            gain_acc, gain_mag = self.gain_acc * self._share(size), self.gain_mag
        self._rates = rates
        if size > 0.0:
            up = turned(self.quaternion, acceleration / size)
            self._turn(_between(up, np.array([0.0, 0.0, 1.0])) * gain_acc)
        if magnetic is not None and np.hypot(*turned(self.quaternion, magnetic)[:2]) > 0.0:
            x, y, _ = turned(self.quaternion, magnetic)  # north is the world's x
            self._turn(np.array([0.0, 0.0, -np.arctan2(y, x) * gain_mag]))
        self.quaternion = self.quaternion / np.linalg.norm(self.quaternion)

    def angles(self) -> np.ndarray:
        """Roll, pitch, yaw (3,), rad, about fixed axes; once there was a measurement."""
        x, y, z, w = self.quaternion
        return np.array([np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
                         np.arcsin(np.clip(2 * (w * y - z * x), -1.0, 1.0)),
                         np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))])

    def _turn(self, vector: np.ndarray) -> None:
        self.quaternion = product(rotation_by(vector), self.quaternion)

    def _share(self, size: float) -> float:
        """Less of the gain, the more the IMU is accelerated."""
        if not self.do_adaptive_gain:
            return 1.0
        return float(np.interp(abs(size / GRAVITY - 1.0), ADAPT, (1.0, 0.0)))

    def _estimate_bias(self, size: float, rates: np.ndarray) -> None:
        self.is_still = bool(abs(size - GRAVITY) <= STILL_CHANGE
                             and (np.abs(rates - self._rates) <= STILL_STEP).all()
                             and (np.abs(rates - self.bias) <= STILL_RATE).all())
        if self.do_bias_estimation and self.is_still:
            self.bias = self.bias + self.bias_alpha * (rates - self.bias)


def _between(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """The rotation vector (3,), rad, from one unit vector to another."""
    axis = np.cross(first, second)
    length = float(np.linalg.norm(axis))
    if length < 1e-12:
        return np.zeros(3) if first @ second > 0 else np.array([np.pi, 0.0, 0.0])
    return axis * (np.arctan2(length, first @ second) / length)
