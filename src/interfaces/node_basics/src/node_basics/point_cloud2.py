"""Decodes sensor_msgs/PointCloud2, whatever its fields, byte order and padding."""

from __future__ import annotations

from typing import Any

import numpy as np

# sensor_msgs/PointField's datatypes
NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}


class BadCloud(ValueError):
    """A cloud whose sizes and fields do not fit together, or without x, y and z."""


def records(cloud: Any) -> np.ndarray:
    """A structured array (n,) with the message's fields, among them x, y and z; row after row."""
    width, height, step = cloud.width, cloud.height, cloud.point_step
    kind = _point(cloud)
    row = width * step if height <= 1 else cloud.row_step or width * step
    if row < width * step or len(cloud.data) < height * row:
        raise BadCloud(f"Data size ({len(cloud.data)} bytes) does not match width ({width}) times "
                       f"height ({height}) times point_step ({step}).  Dropping message.")
    rows = np.frombuffer(cloud.data, np.uint8, height * row).reshape(height, row)[:, :width * step]
    return np.ascontiguousarray(rows).reshape(-1).view(kind) if rows.size else np.empty(0, kind)


def positions(cloud: Any) -> np.ndarray:
    """Its points, (n, 3), m, as float64; some may not be finite."""
    table = records(cloud)
    return np.stack([table[axis].astype(float) for axis in "xyz"], axis=1)


def _point(cloud: Any) -> np.dtype:
    """The type of one point."""
    order = ">" if cloud.is_bigendian else "<"
    fields = {field.name: (order + NUMBERS[field.datatype], field.offset)
              for field in cloud.fields if field.datatype in NUMBERS}
    if missing := [axis for axis in "xyz" if axis not in fields]:
        raise BadCloud(f"the cloud has no field {', '.join(missing)}; it needs x, y and z, and has "
                       f"{', '.join(fields) or 'none'}")
    for name, (number, offset) in fields.items():
        if offset + np.dtype(number).itemsize > cloud.point_step:
            raise BadCloud(f"field {name} lies outside of the point_step of {cloud.point_step} "
                           "bytes")
    return np.dtype({"names": list(fields), "formats": [number for number, _ in fields.values()],
                     "offsets": [offset for _, offset in fields.values()],
                     "itemsize": cloud.point_step})
