"""The racecar's meshes, from simple solids.

Wavefront OBJ in m. The chassis is in base_link's frame (x forward, z up, z = 0 is the ground), the
wheel in its own, with the axle along y. No part may be in the camera's view or the laser's plane.

A solid is a list of faces, a face a list of corners (x, y, z), counter-clockwise from outside.
"""

from itertools import pairwise
from math import cos, pi, sin

from solids import mtl_text, obj_text

MESHES = "src/racecar_description/meshes"
LIBRARY = "racecar.mtl"
COLOURS = {  # RGB
    "paint": (0.78, 0.05, 0.06), "stripe": (0.95, 0.95, 0.93), "glass": (0.05, 0.07, 0.10),
    "carbon": (0.13, 0.13, 0.14), "rubber": (0.06, 0.06, 0.06), "rim": (0.75, 0.76, 0.78),
}


def loft(outlines):
    """A closed skin over outlines with equal numbers of corners, from the rear to the front."""
    faces = [outlines[0][::-1], outlines[-1]]
    for rear, front in pairwise(outlines):
        for i in range(len(rear)):
            j = (i + 1) % len(rear)
            faces.append([rear[i], rear[j], front[j], front[i]])
    return faces


def across(x, y, z):
    """A vertical rectangle at x, seen from the front; y, z: (low, high) each."""
    return [(x, y[0], z[0]), (x, y[1], z[0]), (x, y[1], z[1]), (x, y[0], z[1])]


def box(x, y, z):
    """A cuboid; x, y, z: (low, high) each."""
    return loft([across(x[0], y, z), across(x[1], y, z)])


def both(solid):
    """The solid and its mirror image on the car's right side."""
    return solid + [[(x, -y, z) for x, y, z in face[::-1]] for face in solid]


def hull(x, bottom, middle, top, heights):
    """A six-sided outline: half widths at three heights."""
    low, mid, high = heights
    return [(x, -bottom, low), (x, bottom, low), (x, middle, mid),
            (x, top, high), (x, -top, high), (x, -middle, mid)]


def lathe(profile, sides):
    """A profile [(y, radius), ...] rotated about y, from the right face to the left one."""
    angles = [2 * pi * i / sides for i in range(sides)]
    rings = [[(r * sin(a), y, r * cos(a)) for a in angles] for y, r in profile]
    return loft(rings)


def spoke(angle, inner, outer, half_width, y):
    """A bar from one radius to another in the plane of a wheel; y: (low, high)."""
    def at(radius, side):
        return (radius * cos(angle) - side * sin(angle), radius * sin(angle) + side * cos(angle))

    corners = [at(inner, -half_width), at(outer, -half_width), at(outer, half_width),
               at(inner, half_width)]
    right = [(x, y[0], z) for x, z in corners]
    left = [(x, y[1], z) for x, z in corners]
    return loft([right[::-1], left[::-1]])


def chassis():
    """The solids of all fixed parts, by material."""
    body = loft([
        hull(-0.060, 0.035, 0.045, 0.030, (0.045, 0.075, 0.095)),
        hull(0.000, 0.050, 0.060, 0.036, (0.034, 0.085, 0.132)),
        hull(0.070, 0.060, 0.070, 0.034, (0.030, 0.092, 0.166)),
        hull(0.115, 0.060, 0.072, 0.036, (0.030, 0.095, 0.168)),
        hull(0.150, 0.060, 0.072, 0.050, (0.030, 0.095, 0.122)),
        hull(0.250, 0.055, 0.065, 0.046, (0.030, 0.088, 0.112)),
        hull(0.325, 0.040, 0.048, 0.036, (0.032, 0.072, 0.092)),
        hull(0.400, 0.026, 0.030, 0.020, (0.040, 0.054, 0.068)),
    ])
    pods = both(loft([
        across(0.065, (0.060, 0.116), (0.030, 0.072)),
        across(0.150, (0.060, 0.124), (0.028, 0.086)),
        across(0.235, (0.060, 0.120), (0.028, 0.088)),
        across(0.268, (0.060, 0.105), (0.032, 0.070)),
    ]))
    screen = loft([
        across(0.112, (-0.037, 0.037), (0.110, 0.163)),
        across(0.150, (-0.047, 0.047), (0.105, 0.146)),
        across(0.235, (-0.040, 0.040), (0.100, 0.1175)),
    ])
    stripe = loft([across(0.235, (-0.013, 0.013), (0.09, 0.1165)),
                   across(0.325, (-0.011, 0.011), (0.08, 0.0935)),
                   across(0.402, (-0.009, 0.009), (0.05, 0.0690))])
    stripe += loft([across(-0.060, (-0.013, 0.013), (0.08, 0.0965)),
                    across(0.000, (-0.013, 0.013), (0.10, 0.1335)),
                    across(0.070, (-0.013, 0.013), (0.12, 0.1675)),
                    across(0.110, (-0.013, 0.013), (0.12, 0.1690))])
    return {"paint": body + pods + rear_wing(), "glass": screen, "stripe": stripe,
            "carbon": underside() + camera_mast()}


def rear_wing():
    """A plane on two posts, between two vertical end plates."""
    plane = loft([across(-0.092, (-0.118, 0.118), (0.142, 0.148)),
                  across(-0.045, (-0.118, 0.118), (0.132, 0.140))])
    return plane + both(box((-0.095, -0.040), (0.118, 0.123), (0.105, 0.155)))


def underside():
    """Floor, front wing, rear bumper, axles, and the posts of the rear wing."""
    return [
        *box((-0.055, 0.395), (-0.085, 0.085), (0.026, 0.034)),
        *box((0.388, 0.412), (-0.138, 0.138), (0.032, 0.038)),
        *both(box((0.384, 0.412), (0.134, 0.138), (0.032, 0.062))),
        *box((-0.078, -0.062), (-0.130, 0.130), (0.038, 0.058)),
        *box((-0.004, 0.004), (-0.100, 0.100), (0.046, 0.054)),
        *box((0.331, 0.339), (-0.100, 0.100), (0.046, 0.054)),
        *both(box((-0.074, -0.056), (0.018, 0.024), (0.060, 0.138))),
    ]


def camera_mast():
    """A post behind the laser, with an arm that holds the camera above it."""
    return [*box((0.292, 0.304), (-0.006, 0.006), (0.080, 0.200)),
            *box((0.292, 0.364), (-0.006, 0.006), (0.192, 0.202))]


def wheel():
    """The solids of a wheel (radius 50 mm, width 45 mm), by material."""
    tyre = lathe([(-0.0225, 0.035), (-0.0225, 0.044), (-0.0150, 0.050), (0.0150, 0.050),
                  (0.0225, 0.044), (0.0225, 0.035)], 28)
    spokes = []
    for i in range(5):
        spokes += spoke(2 * pi * i / 5, 0.006, 0.036, 0.0045, (-0.0240, 0.0240))
    return {"rubber": tyre, "rim": spokes + lathe([(-0.0255, 0.009), (0.0255, 0.009)], 12)}


def files() -> dict[str, bytes]:
    """The files' bytes by path in the repository."""
    texts = {LIBRARY: mtl_text(COLOURS), "chassis.obj": obj_text(chassis(), LIBRARY),
             "wheel.obj": obj_text(wheel(), LIBRARY)}
    return {f"{MESHES}/{name}": text.encode("ascii") for name, text in texts.items()}
