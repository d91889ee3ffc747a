"""rviz/LaserScan: the points that a laser has hit."""

from typing import Any

import numpy as np

from bullet_sim.pose import Pose
from sim_viewer.rviz.display_type import DisplayType, Problem, Statuses, simple
from sim_viewer.rviz.displays import point_style
from sim_viewer.rviz.displays.point_style import colours_of, counted, evenly
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.options import Option


def scan_points(message: Any, options: dict[str, Any], most: int,
                pose: Pose) -> tuple[list[Part], Statuses]:
    """Points of all beams with a range within the laser's limits. Problem for invalid angles."""
    ranges = np.asarray(message.ranges, float)
    if not np.isfinite([message.angle_min, message.angle_increment]).all():
        raise Problem("The scan's angles are not numbers")
    hit = np.flatnonzero((ranges >= message.range_min) & (ranges <= message.range_max)
                         & np.isfinite(ranges))
    chosen = hit[evenly(len(hit), most)]
    angles = message.angle_min + chosen * float(message.angle_increment)
    positions = np.zeros((len(chosen), 3))
    positions[:, 0] = ranges[chosen] * np.cos(angles)
    positions[:, 1] = ranges[chosen] * np.sin(angles)
    strengths = np.asarray(message.intensities, float)
    channel = strengths[chosen] if len(strengths) == len(ranges) else None
    colours = colours_of(positions, channel, options, pose)
    return [point_style.points(positions, colours, options)], counted(len(chosen), len(hit))


TYPE = DisplayType(
    "rviz/LaserScan", simple(scan_points), messages=("sensor_msgs/LaserScan",), topic="/scan",
    options=(Option("Color Transformer", "choice", "Intensity",
                    ("Intensity", "AxisColor", "FlatColor")), *point_style.OPTIONS))
