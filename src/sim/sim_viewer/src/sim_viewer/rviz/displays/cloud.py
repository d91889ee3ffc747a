"""rviz/PointCloud2: points with the colours of a field, an axis, or one for all."""

from typing import Any

import numpy as np

from bullet_sim.pose import Pose
from sim_viewer.rviz.display_type import DisplayType, Problem, Statuses, simple
from sim_viewer.rviz.displays import point_style
from sim_viewer.rviz.displays.point_style import colours_of, counted, evenly
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.options import Option

# sensor_msgs/PointField's datatypes
NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
COLOURS = ("rgb", "rgba")
PACKED = "RGB8", "RGBF32"  # the Color Transformers that need them


def cloud_points(message: Any, options: dict[str, Any], most: int,
                 pose: Pose) -> tuple[list[Part], Statuses]:
    """As many points as the page takes, evenly from the cloud. Problem if sizes do not fit."""
    table = records(message)
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
    return [point_style.points(positions, colours, options)], counted(len(chosen), len(table))


def records(message: Any) -> np.ndarray:
    """A structured array (n,) with the message's fields, among them x, y, z.

    Problem if sizes and fields do not fit together.
    """
    width, height, step = message.width, message.height, message.point_step
    order = ">" if message.is_bigendian else "<"
    fields = {field.name: (order + NUMBERS[field.datatype], field.offset)
              for field in message.fields if field.datatype in NUMBERS}
    if missing := {"x", "y", "z"} - set(fields):
        raise Problem(f"The cloud has no field {min(missing)}")
    data = np.frombuffer(message.data, np.uint8)
    row = message.row_step or width * step
    if height <= 1:
        row = width * step
    if any(at + np.dtype(kind).itemsize > step for kind, at in fields.values()):
        raise Problem(f"A field lies outside of the point_step of {step} bytes")
    if row < width * step or len(data) < height * row:
        raise Problem(f"Data size ({len(data)} bytes) does not match width ({width}) times height "
                      f"({height}) times point_step ({step}).  Dropping message.")
    kind = np.dtype({"names": list(fields), "formats": [kind for kind, _ in fields.values()],
                     "offsets": [at for _, at in fields.values()], "itemsize": step})
    lines = data[:height * row].reshape(height, row)[:, :width * step]
    return np.ascontiguousarray(lines).reshape(-1).view(kind) if lines.size else np.empty(0, kind)


def packed_colours(values: np.ndarray) -> np.ndarray:
    """(n, 3) of 24 bits in a float or an integer: 0xRRGGBB."""
    bits = np.ascontiguousarray(values).view(f"{values.dtype.byteorder}u4")
    return np.stack([bits >> 16 & 255, bits >> 8 & 255, bits & 255], axis=1).astype(np.uint8)


TYPE = DisplayType(
    "rviz/PointCloud2", simple(cloud_points), messages=("sensor_msgs/PointCloud2",),
    topic="/camera/depth/points", most_bytes=1 << 29,
    options=(Option("Color Transformer", "choice", "RGB8",
                    ("RGB8", "RGBF32", "Intensity", "AxisColor", "FlatColor")),
             *point_style.OPTIONS))
