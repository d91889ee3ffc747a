#!/usr/bin/env python3
"""Writes meshes/gear.stl, the mesh of demo02: a gear wheel, in metres.  生成齿轮网格。"""

import math
import struct
from itertools import chain
from pathlib import Path

FILE = Path(__file__).resolve().parents[1] / "meshes" / "gear.stl"
TEETH = 12
HOLE, ROOT, TIP = 0.03, 0.08, 0.10  # m, radii
THICKNESS = 0.04  # m
CORNERS = 4 * TEETH  # root, root, tip, tip for each tooth


def point(corner, radius, z):
    angle = math.tau * (corner % CORNERS) / CORNERS
    return radius * math.cos(angle), radius * math.sin(angle), z


def quad(a, b, c, d):
    """Two triangles, counter-clockwise seen from outside.  从外面看为逆时针"""
    return [(a, b, c), (a, c, d)]


def gear():
    low, high = 0.0, THICKNESS
    triangles = []
    for corner in range(CORNERS):
        after = corner + 1
        radius, next_radius = (TIP if each % 4 >= 2 else ROOT for each in (corner, after))
        a, b = point(corner, radius, low), point(after, next_radius, low)
        c, d = point(after, next_radius, high), point(corner, radius, high)
        e, f = point(corner, HOLE, low), point(after, HOLE, low)
        g, h = point(after, HOLE, high), point(corner, HOLE, high)
        triangles += quad(a, b, c, d) + quad(f, e, h, g) + quad(d, c, g, h) + quad(b, a, e, f)
    return triangles


def normal(a, b, c):
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.hypot(*n)
    return [each / length for each in n]


def stl(triangles):
    """Binary STL: 80 bytes of header, the count, 50 bytes for each triangle."""
    records = (struct.pack("<12fH", *normal(*each), *chain(*each), 0) for each in triangles)
    return bytes(80) + struct.pack("<I", len(triangles)) + b"".join(records)


if __name__ == "__main__":
    FILE.write_bytes(stl(gear()))
