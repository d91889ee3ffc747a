"""rviz/PoseArray, Pose, PoseWithCovariance, Odometry: arrows or axes, and their covariance.

The covariance is an ellipsoid for the position and a wedge on the floor for the direction.
"""

import math
from typing import Any

import numpy as np

from bullet_sim.pose import Pose, normalised
from sim_viewer.rviz.display_type import OK, DisplayType, Drawer, Statuses, View, simple
from sim_viewer.rviz.displays.points import evenly
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import (
    Z_TO_X,
    arrows,
    axes,
    finite,
    lines,
    moved,
    multiplied,
    pose_rows,
    shapes,
    turned,
)
from sim_viewer.rviz.options import Option, rgba

WIDEST = 1.4  # rad, half of a wedge
THICKNESS = 0.005  # m
ABOUT = "Covariance/Position", "Covariance/Orientation"
OPTIONS = (
    Option("Covariance/Value", "switch", True),
    *(option for name, color, alpha in ((ABOUT[0], "204; 51; 204", 0.3),
                                        (ABOUT[1], "255; 255; 127", 0.5))
      for option in (Option(f"{name}/Value", "switch", True),
                     Option(f"{name}/Color", "color", color),
                     Option(f"{name}/Alpha", "number", alpha, high=1),
                     Option(f"{name}/Scale", "number", 1.0))),
    Option("Covariance/Orientation/Offset", "number", 1.0))
MOST_KEPT = 10_000  # poses of a trail
FLAT, SOLID, AXES, ARROW = "Arrow (Flat)", "Arrow (3D)", "Axes", "Arrow"
# A flat arrow of length 1: its shaft, and the two halves of its head.
FLAT_ARROW = np.array([(0, 0, 0), (1, 0, 0), (1, 0, 0), (0.75, 0.2, 0), (1, 0, 0), (0.75, -0.2, 0)])


def ellipsoid(row: np.ndarray, covariance: Any, options: dict[str, Any]) -> list[Part]:
    """One standard deviation around a pose (7,), from a (36,) covariance in the same frame.

    Problem if the covariance has values that are not finite.
    """
    if not options["Covariance/Value"]:
        return []
    matrix = finite(covariance).reshape(6, 6)
    parts = []
    if options["Covariance/Position/Value"]:
        values, vectors = np.linalg.eigh(matrix[:3, :3])
        vectors[:, 0] *= np.linalg.det(vectors)  # a rotation, no mirror
        place = np.array([[*row[:3], *_quaternion(vectors)]])
        scale = 2 * options["Covariance/Position/Scale"] * np.sqrt(np.maximum(values, 1e-8))
        parts.append(shapes("sphere", place, scale, _colour(options, ABOUT[0])))
    if options["Covariance/Orientation/Value"]:
        angle = np.sqrt(max(matrix[5, 5], 0.0)) * options["Covariance/Orientation/Scale"]
        length = options["Covariance/Orientation/Offset"]
        width = 2 * length * np.tan(min(angle, WIDEST))
        parts.append(_wedge(row[None], length, width, _colour(options, ABOUT[1])))
    return parts


def _wedge(rows: np.ndarray, length: float, width: float, colour: tuple) -> Part:
    """A flat cone with its tip at the pose, that opens along x."""
    middle = rows[:, :3] + turned(rows[:, 3:], np.array([[length / 2, 0.0, 0.0]]))
    back = multiplied(multiplied(rows[:, 3:], np.array([0.0, 0.0, 1.0, 0.0])), Z_TO_X)
    # Of the cone's own axes, x lies upright then and y across.
    return shapes("cone", np.hstack([middle, back]), [THICKNESS, width, length], colour)


def _colour(options: dict[str, Any], name: str) -> tuple:
    return rgba(options, f"{name}/Color", f"{name}/Alpha")


def _quaternion(matrix: np.ndarray) -> tuple[float, ...]:
    """x, y, z, w of a rotation: the eigenvector of Bar-Itzhack's symmetric matrix."""
    (a, b, c), (d, e, f), (g, h, i) = matrix
    table = np.array([[a - e - i, b + d, c + g, h - f], [b + d, e - a - i, f + h, c - g],
                      [c + g, f + h, i - a - e, d - b], [h - f, c - g, d - b, a + e + i]])
    return normalised(np.linalg.eigh(table)[1][:, -1])


def shape_options(color: str, length: float, radius: float, head: float,
                  head_radius: float) -> tuple[Option, ...]:
    """The options that rviz lists for an arrow, with their defaults in m."""
    return (Option("Color", "color", color), Option("Alpha", "number", 1.0, high=1),
            Option("Shaft Length", "number", length), Option("Shaft Radius", "number", radius),
            Option("Head Length", "number", head), Option("Head Radius", "number", head_radius))


def drawn(rows: np.ndarray, options: dict[str, Any]) -> list[Part]:
    """Poses (n, 7) as the option `Shape` says."""
    if options["Shape"] == AXES:
        return axes(rows, options["Axes Length"], options["Axes Radius"], options["Alpha"])
    if options["Shape"] == FLAT:
        corners = np.repeat(rows, len(FLAT_ARROW), axis=0)
        strokes = np.tile(FLAT_ARROW * options["Arrow Length"], (len(rows), 1))
        return [lines(corners[:, :3] + turned(corners[:, 3:], strokes), rgba(options), 0.0)]
    return arrows(rows, (options["Shaft Length"], 2 * options["Shaft Radius"]),
                  (options["Head Length"], 2 * options["Head Radius"]), rgba(options))


def array(message: Any, options: dict[str, Any], most: int,
          _pose: Pose) -> tuple[list[Part], Statuses]:
    """All poses of a PoseArray, such as amcl's particles. Problem for an invalid pose."""
    there = len(message.poses)
    rows = pose_rows(list(message.poses))[evenly(there, max(most // 10, 1))]
    return drawn(rows, options), {} if len(rows) == there else {
        "Poses": (OK, f"showing {len(rows)} of {there} poses")}


def stamped(message: Any, options: dict[str, Any], _most: int,
            _pose: Pose) -> tuple[list[Part], Statuses]:
    """A PoseStamped; Problem for an invalid pose."""
    return drawn(pose_rows([message.pose]), options), {}


def with_covariance(message: Any, options: dict[str, Any], _most: int,
                    _pose: Pose) -> tuple[list[Part], Statuses]:
    """A PoseWithCovarianceStamped, such as amcl_pose; Problem for an invalid pose."""
    rows = pose_rows([message.pose.pose])
    return drawn(rows, options) + ellipsoid(rows[0], message.pose.covariance, options), {}


class Trail(Drawer):
    """The last poses of an Odometry, at least the tolerances apart."""

    def __init__(self, options: dict[str, Any]):
        super().__init__(options)
        self._rows = np.empty((0, 7))
        self._newest: tuple[Pose, np.ndarray, Any] | None = None

    def take(self, message: Any, pose: Pose | None, now: float) -> None:
        """Problem for an invalid pose."""
        own = pose_rows([message.pose.pose])
        row = moved(own, pose)
        if len(self._rows) and not self._far(self._rows[-1], row[0]):
            return
        keep = self.options["Keep"] or MOST_KEPT  # 0: without a limit, in rviz
        self._rows = np.concatenate([self._rows, row])[-keep:]
        self._newest, self.changed = (pose, own[0], message.pose.covariance), True

    def _far(self, last: np.ndarray, row: np.ndarray) -> bool:
        half = min(1.0, abs(float(np.dot(last[3:], row[3:]))))
        return (np.linalg.norm(last[:3] - row[:3]) > self.options["Position Tolerance"]
                or 2 * math.acos(half) > self.options["Angle Tolerance"])

    def draw(self, view: View) -> list[Part] | None:
        """The whole trail; Problem for an invalid covariance."""
        if not self.changed or self._newest is None:
            return None
        self.changed = False
        frame, row, covariance = self._newest
        around = ellipsoid(row, covariance, self.options)
        for part in around:
            part.pose = frame
        return drawn(self._rows, self.options) + around


CROSS = (Option("Axes Length", "number", 1.0), Option("Axes Radius", "number", 0.1))
SHAPE = Option("Shape", "choice", ARROW, (ARROW, AXES))
BIG = shape_options("255; 25; 0", 1.0, 0.05, 0.3, 0.1)
ARRAY = DisplayType(
    "rviz/PoseArray", simple(array), messages=("geometry_msgs/PoseArray",),
    topic="/particlecloud", options=(
        Option("Shape", "choice", FLAT, (FLAT, SOLID, AXES)), Option("Arrow Length", "number", 0.3),
        *shape_options("255; 25; 0", 0.23, 0.01, 0.07, 0.03),
        Option("Axes Length", "number", 0.3), Option("Axes Radius", "number", 0.01)))
STAMPED = DisplayType("rviz/Pose", simple(stamped), messages=("geometry_msgs/PoseStamped",),
                      topic="/move_base/current_goal", options=(SHAPE, *BIG, *CROSS))
WITH_COVARIANCE = DisplayType(
    "rviz/PoseWithCovariance", simple(with_covariance),
    messages=("geometry_msgs/PoseWithCovarianceStamped",), topic="/amcl_pose",
    options=(SHAPE, *BIG, *CROSS, *OPTIONS))
ODOMETRY = DisplayType(
    "rviz/Odometry", Trail, messages=("nav_msgs/Odometry",), topic="/odom", options=(
        Option("Position Tolerance", "number", 0.1), Option("Angle Tolerance", "number", 0.1),
        Option("Keep", "integer", 100, high=MOST_KEPT), SHAPE, *BIG, *CROSS, *OPTIONS))
