"""The mesh of urdf01_rviz's demo02: a small car, in metres.

In the file z points forward, x left and y up; demo02's rpy="1.57 0 1.57" rotates it upright.
"""

import math

from solids import prism, stl_bytes, turned

FILE = "src/lessons/urdf01_rviz/meshes/autolabor_mini.stl"
BODY = (0.15, 0.10, 0.30)  # m, x y z
BODY_Y = 0.09  # m, the body's centre above the ground
WHEEL_RADIUS, WHEEL_WIDTH = 0.05, 0.03  # m
WHEEL_X, WHEEL_Z = 0.095, 0.10  # m, from the centre
CORNERS = 24  # of a wheel


def along_x(outline, left, right):
    """A prism along x; `outline`: (y, z), counter-clockwise as seen from +x."""
    return turned(prism(outline, left, right), (2, 0, 1))


def car():
    """The body and its four wheels."""
    half_x, half_y, half_z = (size / 2 for size in BODY)
    body = [(BODY_Y + y, z) for y, z in ((-half_y, -half_z), (half_y, -half_z),
                                         (half_y, half_z), (-half_y, half_z))]
    solids = [along_x(body, -half_x, half_x)]
    angles = [math.tau * corner / CORNERS for corner in range(CORNERS)]
    for x, z in ((x, z) for x in (-WHEEL_X, WHEEL_X) for z in (-WHEEL_Z, WHEEL_Z)):
        wheel = [(WHEEL_RADIUS * (1 + math.cos(angle)), z + WHEEL_RADIUS * math.sin(angle))
                 for angle in angles]
        solids.append(along_x(wheel, x - WHEEL_WIDTH / 2, x + WHEEL_WIDTH / 2))
    return solids


def files() -> dict[str, bytes]:
    """The file's bytes by its path in the repository."""
    return {FILE: stl_bytes(car(), digits=7)}
