"""An extended Kalman filter over a body's pose, velocity and acceleration.

The state is x y z (m), roll pitch yaw (rad), all in the world's frame; then vx vy vz (m/s), rates
about the body's x y z (rad/s) and ax ay az (m/s2), in the body's. The law of motion is that of a
body with constant acceleration and constant rates, as in T. Moore, D. Stouch, "A Generalized
Extended Kalman Filter Implementation for the Robot Operating System" (2014).

Rotations: quaternions (x, y, z, w), matrices (3, 3) and roll, pitch, yaw (fixed axes x, y, z; rad).
"""

from dataclasses import dataclass, field

import numpy as np

SIZE = 15
POSITION, ANGLES, VELOCITY, RATES, ACCELERATION = (slice(i, i + 3) for i in range(0, SIZE, 3))
PROCESS_NOISE = (0.05, 0.05, 0.06, 0.03, 0.03, 0.06, 0.025, 0.025, 0.04, 0.01, 0.01, 0.02, 0.01,
                 0.01, 0.015)  # upstream's, variances per second
INITIAL_VARIANCE = 1e-9
SMALLEST_VARIANCE = 1e-9  # a measurement's: 0 would be one that is never wrong
STEP = 1e-6  # of the differences that the Jacobian is made of


def matrix_of(quaternion: np.ndarray) -> np.ndarray:
    """Of a quaternion of any length; one of zeros, which messages often hold, turns nothing."""
    length = np.linalg.norm(quaternion)
    if length == 0.0:
        return np.eye(3)
    x, y, z, w = np.asarray(quaternion, dtype=float) / length
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def angles_of(matrix: np.ndarray) -> np.ndarray:
    """roll, pitch, yaw (3,)."""
    return np.array([np.arctan2(matrix[2, 1], matrix[2, 2]),
                     np.arcsin(np.clip(-matrix[2, 0], -1.0, 1.0)),
                     np.arctan2(matrix[1, 0], matrix[0, 0])])


def quaternion_of(angles: np.ndarray) -> np.ndarray:
    """(x, y, z, w) of roll, pitch, yaw."""
    sr, sp, sy = np.sin(np.asarray(angles) / 2.0)
    cr, cp, cy = np.cos(np.asarray(angles) / 2.0)
    return np.array([sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
                     cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy])


def pose_matrix(position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """A transform (4, 4) of a place (3,) and a matrix (3, 3)."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation, position
    return pose


def wrapped(angles: np.ndarray | float) -> np.ndarray | float:
    """Within -pi and pi."""
    return np.arctan2(np.sin(angles), np.cos(angles))


def moved(states: np.ndarray, dt: float) -> np.ndarray:
    """States (n, 15) after `dt` seconds."""
    after = states.copy()
    roll, pitch, yaw = states[:, ANGLES].T
    sr, cr, sp, cp = np.sin(roll), np.cos(roll), np.sin(pitch), np.cos(pitch)
    sy, cy = np.sin(yaw), np.cos(yaw)
    cp = np.where(np.abs(cp) < STEP, STEP, cp)  # upright: yaw and roll are one there
    way = states[:, VELOCITY] * dt + states[:, ACCELERATION] * (0.5 * dt * dt)
    x, y, z = way.T
    after[:, 0] += cy * cp * x + (cy * sp * sr - sy * cr) * y + (cy * sp * cr + sy * sr) * z
    after[:, 1] += sy * cp * x + (sy * sp * sr + cy * cr) * y + (sy * sp * cr - cy * sr) * z
    after[:, 2] += -sp * x + cp * sr * y + cp * cr * z
    rate_x, rate_y, rate_z = states[:, RATES].T
    sideways = sr * rate_y + cr * rate_z
    after[:, 3] += (rate_x + sp / cp * sideways) * dt
    after[:, 4] += (cr * rate_y - sr * rate_z) * dt
    after[:, 5] += sideways / cp * dt
    after[:, VELOCITY] += states[:, ACCELERATION] * dt
    return after


@dataclass
class Ekf:
    """state (15,), covariance (15, 15) and process_noise (15, 15), variances per second."""

    state: np.ndarray = field(default_factory=lambda: np.zeros(SIZE))
    covariance: np.ndarray = field(default_factory=lambda: np.eye(SIZE) * INITIAL_VARIANCE)
    process_noise: np.ndarray = field(default_factory=lambda: np.diag(PROCESS_NOISE))

    def predict(self, dt: float) -> None:
        """Let `dt` seconds pass; nothing changes where no finite estimate comes of it."""
        offsets = np.vstack([np.zeros(SIZE), np.eye(SIZE) * STEP, np.eye(SIZE) * -STEP])
        after = moved(self.state + offsets, dt)
        jacobian = (after[1:SIZE + 1] - after[SIZE + 1:]).T / (2.0 * STEP)
        state = after[0]
        state[ANGLES] = wrapped(state[ANGLES])
        self._take(state, jacobian @ self.covariance @ jacobian.T + self.process_noise * dt)

    def correct(self, indices: np.ndarray, values: np.ndarray, covariance: np.ndarray,
                rejection: float = np.inf) -> bool:
        """Take in a measurement of some entries of the state; False if it is too far off.

        False, too, if no finite estimate comes of it: then its covariance is none.

        indices, values: (m,); covariance: (m, m); rejection: Mahalanobis distance.
        """
        noise = np.array(covariance, dtype=float)
        diagonal = np.abs(np.diag(noise))
        np.fill_diagonal(noise, np.maximum(diagonal, SMALLEST_VARIANCE))
        innovation = np.asarray(values, dtype=float) - self.state[indices]
        angular = np.isin(indices, np.arange(SIZE)[ANGLES])
        innovation[angular] = wrapped(innovation[angular])
        spread = self.covariance[np.ix_(indices, indices)] + noise
        try:
            inverse = np.linalg.inv(spread)
        except np.linalg.LinAlgError:
            return False
        if innovation @ inverse @ innovation >= rejection * rejection:
            return False
        gain = self.covariance[:, indices] @ inverse
        kept = np.eye(SIZE)
        kept[:, indices] -= gain
        state = self.state + gain @ innovation
        state[ANGLES] = wrapped(state[ANGLES])
        covariance = kept @ self.covariance @ kept.T + gain @ noise @ gain.T
        return self._take(state, covariance)

    def _take(self, state: np.ndarray, covariance: np.ndarray) -> bool:
        """False, and nothing changes, if they are not finite."""
        if not (np.isfinite(state).all() and np.isfinite(covariance).all()):
            return False
        self.state, self.covariance = state, covariance
        return True
