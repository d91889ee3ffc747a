"""Converts sensor messages to points in the sensor's frame, m."""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import Transform
from node_basics.point_cloud2 import positions
from sensor_msgs.msg import LaserScan, PointCloud, PointCloud2

NEARLY = 1e-4   # m by which an infinite range is put below range_max, as upstream
LONGEST = 60.0  # s, longest sweep; tf's buffer holds less


def timed_points(message: LaserScan | PointCloud | PointCloud2, data_type: str,
                 inf_is_valid: bool) -> tuple[np.ndarray, np.ndarray]:
    """(points (N, 3), times (N,), s after the stamp); ValueError for an invalid message."""
    if data_type == "LaserScan":
        return points_of_scan(message, inf_is_valid)
    points = points_of_cloud(message) if data_type == "PointCloud" else positions(message)
    points = points[np.isfinite(points).all(axis=1)]
    return points, np.zeros(len(points))


def placed(points: np.ndarray, start: tuple, end: tuple, when: np.ndarray) -> np.ndarray:
    """Points (N, 3) of a sensor that moved uniformly from `start` to `end` while measuring.

    Both as returned by `rotation_and_translation`; `when` (N,), s after the start.
    """
    first = points @ start[0].T + start[1]
    if not when.any():
        return first
    return first + (when / when[-1])[:, None] * (points @ end[0].T + end[1] - first)


def points_of_scan(message: LaserScan, inf_is_valid: bool) -> tuple[np.ndarray, np.ndarray]:
    """(points (N, 3), their times (N,), s after the message's stamp).

    Ranges count from range_min to below range_max. With `inf_is_valid`, +inf is a ray that ended
    at range_max; else it is ignored. Raises ValueError for invalid angles or times.
    """
    if not np.isfinite((message.angle_min, message.angle_increment)).all():
        raise ValueError(f"a scan from {message.angle_min} rad in steps of "
                         f"{message.angle_increment} rad leads nowhere")
    if not message.time_increment * len(message.ranges) <= LONGEST:
        raise ValueError(f"a scan of {len(message.ranges)} beams {message.time_increment} s apart "
                         f"(time_increment) takes longer than {LONGEST:g} s")
    ranges = np.asarray(message.ranges, float)
    beams = np.arange(len(ranges))
    if inf_is_valid:
        ranges = np.where(np.isposinf(ranges), message.range_max - NEARLY, ranges)
    with np.errstate(invalid="ignore"):
        counts = (ranges >= message.range_min) & (ranges < message.range_max)
    ranges, beams = ranges[counts], beams[counts]
    angles = message.angle_min + beams * message.angle_increment
    points = np.stack((ranges * np.cos(angles), ranges * np.sin(angles), np.zeros(len(ranges))), 1)
    return points, beams * max(message.time_increment, 0.0)


def points_of_cloud(message: PointCloud) -> np.ndarray:
    """Its points, (N, 3); some may not be finite."""
    return np.array([(p.x, p.y, p.z) for p in message.points], float).reshape(-1, 3)


def rotation_and_translation(transform: Transform) -> tuple[np.ndarray, np.ndarray]:
    """((3, 3), (3,), m) of a geometry_msgs/Transform: a point p becomes rotation @ p + shift."""
    q = np.array([transform.rotation.x, transform.rotation.y, transform.rotation.z,
                  transform.rotation.w])
    x, y, z, w = q / np.linalg.norm(q)
    rotation = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    shift = transform.translation
    return rotation, np.array([shift.x, shift.y, shift.z])
