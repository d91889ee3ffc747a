"""Decodes sensor_msgs/PointCloud2, whatever its fields, byte order and padding."""

from __future__ import annotations

from typing import Any

import numpy as np

# sensor_msgs/PointField's datatypes
NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}


class BadCloud(ValueError):
    """A cloud whose sizes and fields do not fit together, or without x, y and z."""


def records(cloud: Any) -> np.ndarray:
    """A structured array (n,), row after row, with the fields that lie within a point.

    Among them are x, y and z; the last row may be without its padding.
    """
    width, height, step = cloud.width, cloud.height, cloud.point_step
    fields = _fields(cloud)
    if width * height == 0:  # whatever its steps are
        return np.empty(0, [(name, number) for name, (number, _) in fields.items()])
    kind = _point(fields, step)
    row = width * step if height == 1 else cloud.row_step or width * step
    if row < width * step or len(cloud.data) < (height - 1) * row + width * step:
        raise BadCloud(f"Data size ({len(cloud.data)} bytes) does not match width ({width}) times "
                       f"height ({height}) times point_step ({step}).  Dropping message.")
    rows = np.ndarray((height, width * step), np.uint8, cloud.data, strides=(row, 1))
    return rows.reshape(-1).view(kind)


def positions(cloud: Any) -> np.ndarray:
    """Its points, (n, 3), m, as float64; some may not be finite."""
    table = records(cloud)
    return np.stack([table[axis].astype(float) for axis in "xyz"], axis=1)


def _fields(cloud: Any) -> dict[str, tuple[str, int]]:
    """Each field's number, as NumPy writes it, and its offset in bytes."""
    order = ">" if cloud.is_bigendian else "<"
    fields = {field.name: (order + NUMBERS[field.datatype], field.offset)
              for field in cloud.fields if field.datatype in NUMBERS}
    if missing := [axis for axis in "xyz" if axis not in fields]:
        raise BadCloud(f"the cloud has no field {', '.join(missing)}; it needs x, y and z, and has "
                       f"{', '.join(fields) or 'none'}")
    return fields


def _point(fields: dict[str, tuple[str, int]], step: int) -> np.dtype:
    """The type of one point of `step` bytes."""
    fitting = {name: (number, offset) for name, (number, offset) in fields.items()
               if offset + np.dtype(number).itemsize <= step}
    for axis in "xyz":
        if axis not in fitting:
            raise BadCloud(f"field {axis} lies outside of the point_step of {step} bytes")
    return np.dtype({"names": list(fitting), "formats": [number for number, _ in fitting.values()],
                     "offsets": [offset for _, offset in fitting.values()], "itemsize": step})
