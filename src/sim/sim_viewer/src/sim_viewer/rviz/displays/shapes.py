"""Displays of one shape: rviz/Path, Polygon, Grid, Axes, PointStamped and Range."""

from collections.abc import Callable
from typing import Any

import numpy as np

from bullet_sim.pose import IDENTITY, Pose
from sim_viewer.rviz.display_type import DisplayType, Drawer, Statuses, View, simple
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import (
    arrows,
    axes,
    bars,
    finite,
    lines,
    points,
    pose_rows,
    shapes,
    strip,
)
from sim_viewer.rviz.options import FIXED_FRAME, Option, rgba

STYLES = ("Lines", "Billboards")
HIDDEN, ARROWS, AXES = "None", "Arrows", "Axes"
PLANES = {"XY": (0, 1), "XZ": (0, 2), "YZ": (1, 2)}
PERIOD = 0.5  # s between look-ups of the reference frame's pose
FRAME = Option("Reference Frame", "frame", FIXED_FRAME)


def path_lines(message: Any, options: dict[str, Any], most: int,
               _pose: Pose) -> tuple[list[Part], Statuses]:
    """A line, and arrows or axes at each pose if wanted. Problem if values are not finite."""
    chosen = message.poses[::max(1, -(-len(message.poses) // most))]
    positions = points([one.pose.position for one in chosen])
    positions += [options[f"Offset/{axis}"] for axis in "XYZ"]
    wide = options["Line Style"] == "Billboards"
    parts = [strip(positions, rgba(options), options["Line Width"] if wide else 0.0)]
    if options["Pose Style"] != HIDDEN and len(positions):
        rows = pose_rows([one.pose for one in chosen])
        rows[:, :3] = positions
        parts += _poses(rows, options)
    return parts, {}


def _poses(rows: np.ndarray, options: dict[str, Any]) -> list[Part]:
    if options["Pose Style"] == AXES:
        return axes(rows, options["Length"], options["Radius"], options["Alpha"])
    return arrows(rows, (options["Shaft Length"], options["Shaft Diameter"]),
                  (options["Head Length"], options["Head Diameter"]),
                  rgba(options, "Pose Color"))


def polygon_lines(message: Any, options: dict[str, Any], _most: int,
                  _pose: Pose) -> tuple[list[Part], Statuses]:
    """The closed outline; Problem if values are not finite."""
    corners = points(message.polygon.points)
    return [strip(corners, rgba(options), 0.0, closed=True)], {}


PATH = DisplayType(
    "rviz/Path", simple(path_lines), messages=("nav_msgs/Path",), topic="/path", options=(
        Option("Color", "color", "25; 255; 0"), Option("Alpha", "number", 1.0, high=1),
        Option("Buffer Length", "integer", 1, low=1, high=100),
        Option("Line Style", "choice", "Lines", STYLES), Option("Line Width", "number", 0.03),
        *(Option(f"Offset/{axis}", "number", 0.0, low=-1e6) for axis in "XYZ"),
        Option("Pose Style", "choice", HIDDEN, (HIDDEN, AXES, ARROWS)),
        Option("Pose Color", "color", "255; 85; 255"),
        Option("Length", "number", 0.3), Option("Radius", "number", 0.03),
        Option("Shaft Length", "number", 0.1), Option("Shaft Diameter", "number", 0.1),
        Option("Head Length", "number", 0.2), Option("Head Diameter", "number", 0.3)))
POLYGON = DisplayType(
    "rviz/Polygon", simple(polygon_lines), messages=("geometry_msgs/PolygonStamped",),
    topic="/footprint", options=(Option("Color", "color", "25; 255; 0"),
                                 Option("Alpha", "number", 1.0, high=1)))


class Fixed(Drawer):
    """Something that never changes, at a reference frame."""

    def __init__(self, options: dict[str, Any], build: Callable[[dict[str, Any]], list[Part]]):
        super().__init__(options)
        self._build = build

    def draw(self, view: View) -> list[Part]:
        frame = self.options["Reference Frame"]
        pose = IDENTITY if frame in ("", FIXED_FRAME) else view.pose(frame)
        parts = self._build(self.options)
        for part in parts:
            part.pose = pose
        return parts


def grid_lines(options: dict[str, Any]) -> list[Part]:
    """A grid of as many cells as the options say, centred on the frame's origin."""
    cells, size = options["Plane Cell Count"], options["Cell Size"]
    half = cells * size / 2
    places = np.linspace(-half, half, cells + 1)
    edge = np.full_like(places, half)
    across = [np.stack([places, -edge], 1), np.stack([places, edge], 1)]
    flat = np.concatenate([np.stack(across, 1), np.stack(across, 1)[..., ::-1]]).reshape(-1, 2)
    positions = np.zeros((len(flat), 3))
    first, second = PLANES[options["Plane"]]
    positions[:, first], positions[:, second] = flat[:, 0], flat[:, 1]
    positions += [options[f"Offset/{axis}"] for axis in "XYZ"]
    wide = options["Line Style/Value"] == "Billboards"
    return [lines(positions, rgba(options), options["Line Style/Line Width"] if wide else 0.0)]


def cross(options: dict[str, Any]) -> list[Part]:
    """Axes at the reference frame's origin."""
    row = np.array([[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]])
    return axes(row, options["Length"], options["Radius"])


GRID = DisplayType(
    "rviz/Grid", lambda options: Fixed(options, grid_lines), period=PERIOD, options=(
        FRAME, Option("Plane Cell Count", "integer", 10, low=1, high=1000),
        Option("Cell Size", "number", 1.0, low=1e-4), Option("Color", "color", "160; 160; 164"),
        Option("Alpha", "number", 0.5, high=1), Option("Plane", "choice", "XY", tuple(PLANES)),
        Option("Line Style/Value", "choice", "Lines", STYLES),
        Option("Line Style/Line Width", "number", 0.03, high=10),
        *(Option(f"Offset/{axis}", "number", 0.0, low=-1e6) for axis in "XYZ")))
AXES_AT_A_FRAME = DisplayType(
    "rviz/Axes", lambda options: Fixed(options, cross), period=PERIOD, options=(
        FRAME, Option("Length", "number", 1.0), Option("Radius", "number", 0.1)))


def ball(message: Any, options: dict[str, Any], _most: int,
         _pose: Pose) -> tuple[list[Part], Statuses]:
    """Its diameter is the option Radius, as in rviz. Problem if values are not finite."""
    row = np.append(points([message.point])[0], (0.0, 0.0, 0.0, 1.0))
    return [shapes("sphere", row[None], [options["Radius"]] * 3, rgba(options))], {}


POINT = DisplayType(
    "rviz/PointStamped", simple(ball), messages=("geometry_msgs/PointStamped",),
    topic="/clicked_point", options=(
        Option("Color", "color", "204; 41; 204"), Option("Alpha", "number", 1.0, high=1),
        Option("Radius", "number", 0.2), Option("History Length", "integer", 1, low=1, high=500)))


def cone(message: Any, options: dict[str, Any], _most: int,
         _pose: Pose) -> tuple[list[Part], Statuses]:
    """A cone from the sensor to the measured range; nothing if that is outside of its limits.

    Problem if the angle is not finite.
    """
    angle = finite([message.field_of_view])[0]
    reach = float(message.range)
    if not message.min_range <= reach <= message.max_range or not np.isfinite(reach):
        return [], {}
    # A cone's tip is where it ends along x: it starts at the range and points back.
    back = np.array([[reach, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]])
    width = 2.0 * reach * np.tan(min(abs(angle), 3.0) / 2)
    return [bars("cone", back, 0.0, reach, width, rgba(options))], {}


RANGE = DisplayType(
    "rviz/Range", simple(cone), messages=("sensor_msgs/Range",), topic="/range", options=(
        Option("Color", "color", "255; 255; 255"), Option("Alpha", "number", 0.5, high=1),
        Option("Buffer Length", "integer", 1, low=1, high=100)))
