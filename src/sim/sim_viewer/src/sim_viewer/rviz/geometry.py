"""Rows of poses, and the shapes that arrows and axes are made of. Without ROS."""

from typing import Any

import numpy as np

from bullet_sim.pose import Pose
from sim_viewer.rviz.display_type import Problem
from sim_viewer.rviz.drawing import Part

INVALID = "Message contained invalid floating point values (nans or infs)"
NOT_UNIT = "Message contained invalid quaternions (length not equal to 1)!"
UNIT_TOLERANCE = 0.1  # of a quaternion's squared length
# Turns z, along which cylinders and cones stand, to x, along which arrows point.
Z_TO_X = np.array([0.0, np.sqrt(0.5), 0.0, np.sqrt(0.5)])
AXES = ((0, (255, 0, 0)), (1, (0, 255, 0)), (2, (0, 0, 255)))


def finite(values: Any) -> np.ndarray:
    """The values as float64; Problem if one is not finite."""
    array = np.asarray(values, float)
    if not np.isfinite(array).all():
        raise Problem(INVALID)
    return array


def pose_row(message: Any) -> list[float]:
    """x, y, z and the quaternion of a geometry_msgs/Pose."""
    place, turn = message.position, message.orientation
    return [place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w]


def pose_rows(messages: list) -> np.ndarray:
    """(n, 7), quaternions of unit length; Problem for values not finite, or not near unit length.

    A quaternion of zeros was not set: it means no rotation, as in rviz.
    """
    rows = finite([pose_row(one) for one in messages]).reshape(-1, 7)
    rows[~rows[:, 3:].any(axis=1), 6] = 1.0
    square = (rows[:, 3:] ** 2).sum(axis=1)
    if (np.abs(square - 1.0) > UNIT_TOLERANCE).any():
        raise Problem(NOT_UNIT)
    rows[:, 3:] /= np.sqrt(square)[:, None]
    return rows


def pose_of(message: Any) -> Pose:
    """A geometry_msgs/Pose, checked as `pose_rows` does, which may raise Problem."""
    return row_pose(pose_rows([message])[0])


def row_pose(row: np.ndarray) -> Pose:
    """A pose from x, y, z and the quaternion."""
    return Pose(tuple(map(float, row[:3])), tuple(map(float, row[3:7])))


def points(messages: Any) -> np.ndarray:
    """(n, 3) of geometry_msgs/Point; Problem if values are not finite."""
    return finite([(one.x, one.y, one.z) for one in messages]).reshape(-1, 3)


def turned(quaternions: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """(n, 3): vectors rotated by quaternions (n, 4)."""
    axis, w = quaternions[:, :3], quaternions[:, 3:4]
    cross = 2.0 * np.cross(axis, vectors)
    return vectors + w * cross + np.cross(axis, cross)


def multiplied(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """(n, 4): rotations by `second`, then by `first`."""
    a, w = first[..., :3], first[..., 3:4]
    b, v = second[..., :3], second[..., 3:4]
    return np.concatenate([w * b + v * a + np.cross(a, b),
                           w * v - (a * b).sum(axis=-1, keepdims=True)], axis=-1)


def towards(vectors: np.ndarray) -> np.ndarray:
    """(n, 4): rotations that turn x into the direction of each vector (n, 3)."""
    flat = np.hypot(vectors[:, 0], vectors[:, 1])
    yaw, pitch = np.arctan2(vectors[:, 1], vectors[:, 0]), -np.arctan2(vectors[:, 2], flat)
    zero = np.zeros_like(yaw)
    return multiplied(np.stack([zero, zero, np.sin(yaw / 2), np.cos(yaw / 2)], axis=1),
                      np.stack([zero, np.sin(pitch / 2), zero, np.cos(pitch / 2)], axis=1))


def shapes(shape: str, rows: np.ndarray, scales: Any, colours: Any) -> Part:
    """rows (n, 7); scales (n, 3) m and colours (n, 4) of 0 to 255, or one for all."""
    count = len(rows)
    table = np.hstack([rows, np.broadcast_to(np.asarray(scales, float), (count, 3))])
    return Part("shapes", {"rows": table.astype(np.float32),
                           "colour": np.broadcast_to(colours, (count, 4)).astype(np.uint8)},
                {"shape": shape})


def bars(shape: str, rows: np.ndarray, start: Any, length: Any, diameter: Any,
         colours: Any) -> Part:
    """Cylinders or cones along x of poses (n, 7), from `start` on; m, each (n,) or one."""
    count = len(rows)
    start, length, diameter = (np.broadcast_to(np.asarray(one, float), count)
                               for one in (start, length, diameter))
    middle = np.zeros((count, 3))
    middle[:, 0] = start + length / 2
    placed = np.hstack([rows[:, :3] + turned(rows[:, 3:7], middle),
                        multiplied(rows[:, 3:7], Z_TO_X)])
    return shapes(shape, placed, np.stack([diameter, diameter, length], axis=1), colours)


def arrows(rows: np.ndarray, shaft: tuple[Any, Any], head: tuple[Any, Any],
           colours: Any) -> list[Part]:
    """Arrows along x of poses (n, 7); length and diameter in m of shaft and head."""
    return [bars("cylinder", rows, 0.0, *shaft, colours),
            bars("cone", rows, shaft[0], *head, colours)]


def axes(rows: np.ndarray, length: Any, radius: Any, alpha: float = 1.0) -> list[Part]:
    """Red x, green y, blue z at each pose (n, 7)."""
    turns = towards(np.eye(3))
    return [bars("cylinder", np.hstack([rows[:, :3], multiplied(rows[:, 3:7], turns[axis])]),
                 0.0, length, 2.0 * np.asarray(radius), (*colour, round(255 * alpha)))
            for axis, colour in AXES]


def strip(positions: np.ndarray, colours: Any, width: float, closed: bool = False) -> Part:
    """Lines from each point (n, 3) to the next."""
    following = np.roll(positions, -1, axis=0)
    pairs = np.stack([positions, following], axis=1)
    shades = np.broadcast_to(colours, (len(positions), 4))
    pair_shades = np.stack([shades, np.roll(shades, -1, axis=0)], axis=1)
    if not closed:
        pairs, pair_shades = pairs[:-1], pair_shades[:-1]
    return lines(pairs.reshape(-1, 3), pair_shades.reshape(-1, 4), width)


def lines(positions: np.ndarray, colours: Any, width: float) -> Part:
    """Line segments between pairs of the points (2 n, 3), `width` m wide."""
    count = len(positions)
    return Part("lines", {"position": positions.astype(np.float32),
                          "colour": np.broadcast_to(colours, (count, 4)).astype(np.uint8)},
                {"width": float(width)})


def moved(rows: np.ndarray, pose: Pose) -> np.ndarray:
    """Poses (n, 7 and more) of a frame, in the frame that `pose` is given in."""
    result = np.array(rows, float)
    turn = np.broadcast_to(np.array(pose.orientation, float), (len(rows), 4))
    result[:, :3] = turned(turn, result[:, :3]) + pose.position
    result[:, 3:7] = multiplied(turn, result[:, 3:7])
    return result
