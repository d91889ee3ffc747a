"""rviz/LaserScan and rviz/PointCloud2: points coloured by a field, by an axis, or all alike."""

from typing import Any

import numpy as np
from node_basics.point_cloud2 import BadCloud, records

from bullet_sim.pose import Pose
from sim_viewer.rviz.display_type import OK, DisplayType, Problem, Statuses, simple
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import turned
from sim_viewer.rviz.options import Option, between, rainbow, rgba, spread

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
COLOURS = ("rgb", "rgba")
PACKED = "RGB8", "RGBF32"  # the Color Transformers that need them


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
    return [points(positions, colours, options)], counted(len(chosen), len(hit))


LASER_SCAN = DisplayType(
    "rviz/LaserScan", simple(scan_points), messages=("sensor_msgs/LaserScan",), topic="/scan",
    options=(Option("Color Transformer", "choice", "Intensity",
                    ("Intensity", "AxisColor", "FlatColor")), *OPTIONS))


def cloud_points(message: Any, options: dict[str, Any], most: int,
                 pose: Pose) -> tuple[list[Part], Statuses]:
    """As many points as the page takes, evenly from the cloud. Problem if sizes do not fit."""
    try:
        table = records(message)
    except BadCloud as error:
        raise Problem(str(error)) from error
    chosen = table[evenly(len(table), most)]
    positions = np.stack([chosen[axis].astype(np.float32) for axis in "xyz"], axis=1)
    kind, names = options["Color Transformer"], chosen.dtype.names
    colour = next((name for name in COLOURS if name in names), None)
    channel = options["Channel Name"]
    if kind in PACKED and colour:
        colours = packed_colours(chosen[colour])
    else:
        if kind in PACKED:  # what rviz uses if a cloud has no colours
            options = options | {"Color Transformer": "Intensity" if channel in names
                                 else "AxisColor"}
        values = chosen[channel] if channel in names else None
        colours = colours_of(positions, values, options, pose)
    return [points(positions, colours, options)], counted(len(chosen), len(table))


def packed_colours(values: np.ndarray) -> np.ndarray:
    """(n, 3) of 24 bits in a float or an integer: 0xRRGGBB."""
    bits = np.ascontiguousarray(values).view(f"{values.dtype.byteorder}u4")
    return np.stack([bits >> 16 & 255, bits >> 8 & 255, bits & 255], axis=1).astype(np.uint8)


POINT_CLOUD = DisplayType(
    "rviz/PointCloud2", simple(cloud_points), messages=("sensor_msgs/PointCloud2",),
    topic="/camera/depth/points", most_bytes=1 << 29,
    options=(Option("Color Transformer", "choice", "RGB8",
                    ("RGB8", "RGBF32", "Intensity", "AxisColor", "FlatColor")),
             *OPTIONS))
