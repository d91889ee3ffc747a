"""rviz/PointStamped: a ball at each of the last points, such as those of Publish Point."""

from typing import Any

import numpy as np

from bullet_sim.pose import Pose
from sim_viewer.rviz.colours import rgba
from sim_viewer.rviz.display_type import DisplayType, Statuses, simple
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import points, shapes
from sim_viewer.rviz.options import Option


def ball(message: Any, options: dict[str, Any], _most: int,
         _pose: Pose) -> tuple[list[Part], Statuses]:
    """Its diameter is the option Radius, as in rviz. Problem if values are not finite."""
    row = np.append(points([message.point])[0], (0.0, 0.0, 0.0, 1.0))
    return [shapes("sphere", row[None], [options["Radius"]] * 3, rgba(options))], {}


TYPE = DisplayType(
    "rviz/PointStamped", simple(ball), messages=("geometry_msgs/PointStamped",),
    topic="/clicked_point", options=(
        Option("Color", "color", "204; 41; 204"), Option("Alpha", "number", 1.0, high=1),
        Option("Radius", "number", 0.2), Option("History Length", "integer", 1, low=1, high=500)))
