"""The bytes of a sensor_msgs/PointCloud2 as arrays, and back."""

from collections.abc import Sequence

import numpy as np

TYPES = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}  # PointField


class BadCloud(ValueError):
    """A cloud without what a point needs."""


def xyz_of(data: bytes, fields: Sequence[tuple[str, int, int]], width: int, height: int,
           point_step: int, row_step: int, big_endian: bool) -> np.ndarray:
    """Points (n, 3) in m, of fields (name, offset, PointField type)."""
    known = {name: (offset, kind) for name, offset, kind in fields}
    if missing := [name for name in "xyz" if name not in known]:
        raise BadCloud(f"the cloud has no field {', '.join(missing)}; it has "
                       f"{', '.join(known) or 'none'}")
    for name in "xyz":
        offset, kind = known[name]
        if kind not in TYPES or offset + np.dtype(TYPES[kind]).itemsize > point_step:
            raise BadCloud(f"field {name} has type {kind} at byte {offset}, which a point of "
                           f"{point_step} bytes cannot hold")
    if width * height == 0:
        return np.zeros((0, 3))
    if len(data) < row_step * height or row_step < point_step * width:
        raise BadCloud(f"the cloud says {height} rows of {width} points of {point_step} bytes, "
                       f"and has {len(data)} bytes")
    order = ">" if big_endian else "<"
    point = np.dtype({"names": list("xyz"),
                      "formats": [order + TYPES[known[name][1]] for name in "xyz"],
                      "offsets": [known[name][0] for name in "xyz"], "itemsize": point_step})
    rows = [np.frombuffer(data, point, width, row * row_step) for row in range(height)]
    points = rows[0] if height == 1 else np.concatenate(rows)
    return np.stack([points[name].astype(float) for name in "xyz"], axis=1)
