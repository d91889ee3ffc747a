"""Rigid poses: a position in metres and a unit quaternion (x, y, z, w), composed like frames.

NumPy loads with the first matrix: spawn_model and gz need none, and start in half of the time.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

Vector3 = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True)
class Pose:
    """Pose of a frame in another one; `pose_a_b * pose_b_c` is `pose_a_c`."""

    position: Vector3 = (0.0, 0.0, 0.0)  # m
    orientation: Quaternion = (0.0, 0.0, 0.0, 1.0)  # x, y, z, w; unit length

    @staticmethod
    def from_xyz_rpy(xyz: Sequence[float], rpy: Sequence[float] = (0.0, 0.0, 0.0)) -> Pose:
        """From URDF's and SDF's numbers: metres, and roll, pitch, yaw about fixed axes in rad."""
        return Pose(_triple(xyz), quaternion_from_rpy(*rpy))

    def __mul__(self, other: Pose) -> Pose:
        x, y, z = rotate(self.orientation, other.position)
        px, py, pz = self.position
        return Pose((px + x, py + y, pz + z), multiply(self.orientation, other.orientation))

    def inverse(self) -> Pose:
        """The pose of the other frame in this one."""
        back = conjugate(self.orientation)
        x, y, z = rotate(back, self.position)
        return Pose((-x, -y, -z), back)

    def transform(self, point: Sequence[float]) -> Vector3:
        """A point in this frame, transformed into the frame in which this pose is given."""
        x, y, z = rotate(self.orientation, point)
        px, py, pz = self.position
        return (px + x, py + y, pz + z)

    def rpy(self) -> Vector3:
        """Roll, pitch, yaw about fixed axes, rad."""
        return rpy_from_quaternion(self.orientation)

    def matrix(self) -> np.ndarray:
        """Homogeneous (4, 4) float64 matrix, column vectors."""
        import numpy as np

        x, y, z = self.position
        first, second, third = _rotation_rows(self.orientation)
        return np.array([(*first, x), (*second, y), (*third, z), (0.0, 0.0, 0.0, 1.0)])


IDENTITY = Pose()


def _triple(values: Sequence[float]) -> Vector3:
    x, y, z = values
    return (float(x), float(y), float(z))


def multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    """Hamilton product: rotate by `b`, then by `a`."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def conjugate(q: Quaternion) -> Quaternion:
    """The opposite rotation of a unit quaternion."""
    return (-q[0], -q[1], -q[2], q[3])


def normalised(q: Sequence[float]) -> Quaternion:
    """Unit length; all zeros become no rotation (gazebo_ros_api_plugin.cpp, setModelState)."""
    x, y, z, w = (float(value) for value in q)
    length = math.sqrt(x * x + y * y + z * z + w * w)
    if length == 0.0:
        return (0.0, 0.0, 0.0, 1.0)
    return (x / length, y / length, z / length, w / length)


def rotate(q: Quaternion, v: Sequence[float]) -> Vector3:
    """Vector `v` rotated by `q`."""
    x, y, z, w = q
    vx, vy, vz = v
    tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
    return (
        vx + w * tx + y * tz - z * ty,
        vy + w * ty + z * tx - x * tz,
        vz + w * tz + x * ty - y * tx,
    )


def quaternion_from_rpy(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Rotation about fixed x, then y, then z (URDF, SDF, REP 103)."""
    cr, sr = math.cos(roll / 2), math.sin(roll / 2)
    cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def rpy_from_quaternion(q: Quaternion) -> Vector3:
    """Inverse of `quaternion_from_rpy`, pitch in [-pi/2, pi/2]."""
    x, y, z, w = q
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))
    yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return (roll, pitch, yaw)


def rotation_matrix(q: Quaternion) -> np.ndarray:
    """(3, 3) float64 rotation matrix of a unit quaternion."""
    import numpy as np

    return np.array(_rotation_rows(q))


def _rotation_rows(q: Quaternion) -> tuple[Vector3, Vector3, Vector3]:
    x, y, z, w = q
    return ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))


def symmetric_matrix(six: Sequence[float]) -> np.ndarray:
    """(3, 3) matrix of a tensor's xx, xy, xz, yy, yz, zz."""
    import numpy as np

    xx, xy, xz, yy, yz, zz = six
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def shortest_angular_distance(start: float, to: float) -> float:
    """The angle from `start` to `to`, in (-pi, pi], rad."""
    turn = math.fmod(to - start, math.tau)
    if turn <= -math.pi:
        return turn + math.tau
    return turn - math.tau if turn > math.pi else turn
