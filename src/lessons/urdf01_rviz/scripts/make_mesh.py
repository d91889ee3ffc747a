#!/usr/bin/env python3
"""Writes meshes/autolabor_mini.stl, the mesh of demo02: a small car, in metres.  生成小车网格。

In the file z points forward, x left and y up; demo02's rpy="1.57 0 1.57" rotates it upright.
"""

import math
import struct
from itertools import chain
from pathlib import Path

FILE = Path(__file__).resolve().parents[1] / "meshes" / "autolabor_mini.stl"
BODY = (0.15, 0.10, 0.30)  # m, x y z
BODY_Y = 0.09  # m, the body's centre above the ground
WHEEL_RADIUS, WHEEL_WIDTH = 0.05, 0.03  # m
WHEEL_X, WHEEL_Z = 0.095, 0.10  # m, from the centre
CORNERS = 24  # of a wheel


def prism(outline, left, right):
    """Triangles of a prism along x; `outline`: (y, z), counter-clockwise as seen from +x."""
    low, high = ([(x, y, z) for y, z in outline] for x in (left, right))
    triangles = []
    for here, (a, b) in enumerate(zip(low, low[1:] + low[:1])):
        c, d = high[(here + 1) % len(high)], high[here]
        triangles += [(a, b, c), (a, c, d)]
    for here in range(1, len(outline) - 1):
        triangles += [(high[0], high[here], high[here + 1]), (low[0], low[here + 1], low[here])]
    return triangles


def car():
    half_x, half_y, half_z = (size / 2 for size in BODY)
    body = [(BODY_Y + y, z) for y, z in ((-half_y, -half_z), (half_y, -half_z),
                                         (half_y, half_z), (-half_y, half_z))]
    triangles = prism(body, -half_x, half_x)
    angles = [math.tau * corner / CORNERS for corner in range(CORNERS)]
    for x, z in ((x, z) for x in (-WHEEL_X, WHEEL_X) for z in (-WHEEL_Z, WHEEL_Z)):
        wheel = [(WHEEL_RADIUS * (1 + math.cos(angle)), z + WHEEL_RADIUS * math.sin(angle))
                 for angle in angles]
        triangles += prism(wheel, x - WHEEL_WIDTH / 2, x + WHEEL_WIDTH / 2)
    return triangles


def normal(a, b, c):
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.hypot(*n)
    return [each / length for each in n]


def stl(triangles):
    """Binary STL: 80 bytes of header, the count, 50 bytes per triangle."""
    records = (struct.pack("<12fH", *normal(*each), *chain(*each), 0) for each in triangles)
    return bytes(80) + struct.pack("<I", len(triangles)) + b"".join(records)


if __name__ == "__main__":
    FILE.write_bytes(stl(car()))
