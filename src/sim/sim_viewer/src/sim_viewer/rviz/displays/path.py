"""rviz/Path and rviz/Polygon: lines from place to place."""

from typing import Any

import numpy as np

from bullet_sim.pose import Pose
from sim_viewer.rviz.colours import rgba
from sim_viewer.rviz.display_type import DisplayType, Statuses, simple
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import arrows, axes, points, pose_rows, strip
from sim_viewer.rviz.options import Option

STYLES = ("Lines", "Billboards")
HIDDEN, ARROWS, AXES = "None", "Arrows", "Axes"


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
