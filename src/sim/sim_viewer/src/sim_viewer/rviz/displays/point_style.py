"""The options that scans and clouds share: shape, size and colour of their points."""

from typing import Any

import numpy as np

from bullet_sim.pose import Pose
from sim_viewer.rviz.colours import between, rainbow, rgba, spread
from sim_viewer.rviz.display_type import OK, Statuses
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import turned
from sim_viewer.rviz.options import Option

STYLES = ("Points", "Squares", "Flat Squares", "Spheres", "Boxes")
AXIS = {"X": 0, "Y": 1, "Z": 2}
OPTIONS = (
    Option("Style", "choice", "Flat Squares", STYLES),
    Option("Size (m)", "number", 0.01, low=1e-4, high=100),
    Option("Size (Pixels)", "number", 3, low=1, high=100),
    Option("Alpha", "number", 1.0, high=1),
    Option("Decay Time", "number", 0.0, high=1000),
    Option("Color", "color", "255; 255; 255"),
    Option("Channel Name", "text", "intensity"),
    Option("Use rainbow", "switch", True), Option("Invert Rainbow", "switch", False),
    Option("Min Color", "color", "0; 0; 0"), Option("Max Color", "color", "255; 255; 255"),
    Option("Autocompute Intensity Bounds", "switch", True),
    Option("Min Intensity", "number", 0.0, low=-1e9, high=1e9),
    Option("Max Intensity", "number", 4096.0, low=-1e9, high=1e9),
    Option("Axis", "choice", "Z", tuple(AXIS)), Option("Use Fixed Frame", "switch", True),
    Option("Autocompute Value Bounds/Value", "switch", True),
    Option("Autocompute Value Bounds/Min Value", "number", -10.0, low=-1e6),
    Option("Autocompute Value Bounds/Max Value", "number", 10.0, low=-1e6),
)


def points(positions: np.ndarray, colours: Any, options: dict[str, Any]) -> Part:
    """Positions (n, 3) in m and colours (n, 3) or one; points that are not finite are left out."""
    known = np.isfinite(positions).all(axis=1)
    shades = np.empty((len(positions), 4), np.uint8)
    shades[:, :3], shades[:, 3] = colours, round(255 * options["Alpha"])
    in_px = options["Style"] == "Points"
    return Part("points", {"position": positions[known].astype(np.float32),
                           "colour": shades[known]},
                {"size": options["Size (Pixels)"] if in_px else options["Size (m)"],
                 "unit": "px" if in_px else "m", "round": options["Style"] == "Spheres"})


def colours_of(positions: np.ndarray, channel: np.ndarray | None, options: dict[str, Any],
               pose: Pose) -> np.ndarray | tuple:
    """By the option `Color Transformer`: from an axis, from a channel (n,), or one for all.

    `pose` is that of the frame of `positions` in the fixed frame.
    """
    kind = options["Color Transformer"]
    if kind == "AxisColor":
        own = options["Autocompute Value Bounds/Value"]
        bounds = None if own else (options["Autocompute Value Bounds/Min Value"],
                                   options["Autocompute Value Bounds/Max Value"])
        if options["Use Fixed Frame"]:
            positions = turned(np.array([pose.orientation]), positions) + pose.position
        return rainbow(spread(positions[:, AXIS[options["Axis"]]], bounds))
    if kind == "Intensity" and channel is not None:
        own = options["Autocompute Intensity Bounds"]
        bounds = None if own else (options["Min Intensity"], options["Max Intensity"])
        values = spread(channel, bounds)
        if not options["Use rainbow"]:
            return between(values, options["Min Color"], options["Max Color"])
        return rainbow(1.0 - values if options["Invert Rainbow"] else values)
    return rgba(options)[:3]


def counted(shown: int, there: int) -> Statuses:
    """The status that says how many points are shown."""
    text = f"Showing {there} points" if shown == there else f"showing {shown} of {there} points"
    return {"Points": (OK, text)}


def evenly(count: int, most: int) -> slice | np.ndarray:
    """Indices of `most` of `count` things at most: all, or that many, evenly spread."""
    return slice(None) if count <= most else np.arange(most) * count // most
