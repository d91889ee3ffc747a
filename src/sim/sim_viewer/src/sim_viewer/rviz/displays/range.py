"""rviz/Range: the cone of an ultrasonic or infrared sensor."""

from typing import Any

import numpy as np

from bullet_sim.pose import Pose
from sim_viewer.rviz.colours import rgba
from sim_viewer.rviz.display_type import DisplayType, Statuses, simple
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import bars, finite
from sim_viewer.rviz.options import Option


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


TYPE = DisplayType(
    "rviz/Range", simple(cone), messages=("sensor_msgs/Range",), topic="/range", options=(
        Option("Color", "color", "255; 255; 255"), Option("Alpha", "number", 0.5, high=1),
        Option("Buffer Length", "integer", 1, low=1, high=100)))
