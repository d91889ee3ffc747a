"""The TurtleBot3 robots' meshes, from plain solids.

Names and scales are those that URDF files elsewhere refer to: STL in mm, the R200 in m. Bases are
in the frame of their URDF visual (x forward, z up, z = 0 is base_link), the laser in base_scan, a
wheel round the y axis. Nothing may stand before a camera: it would hide the line on the floor.
"""

from itertools import pairwise
from math import cos, radians, sin

from solids import box, collada_bytes, cylinder, moved, prism, ring, stl_bytes, turned

MESHES = "src/compat/turtlebot3_description/meshes"
PLATE = 4.0  # mm, thickness


def plate(half, corner, z, cell, slat):
    """A square waffle plate of 2 x half mm with cut corners: a rim, and slats every cell mm."""
    rim = 8.0
    edges = []
    for low, high in ((-half, -half + rim), (half - rim, half)):
        edges += [box((low, high), (-half + corner, half - corner), z),
                  box((-half + corner, half - corner), (low, high), z)]
    for sx in (-1, 1):
        for sy in (-1, 1):
            edges.append(corner_strip(half, corner, rim, sx, sy, z))
    count = round(2 * half / cell)
    for i in range(1, count):
        place = -half + 2 * half * i / count
        reach = half - max(0.0, abs(place) + slat / 2 - (half - corner)) - 1.0
        edges += [box((place - slat / 2, place + slat / 2), (-reach, reach), z),
                  box((-reach, reach), (place - slat / 2, place + slat / 2), z)]
    return edges


def corner_strip(half, corner, rim, sx, sy, z):
    """The slanting rim over one cut corner."""
    points = [(half - corner, half), (half - corner, half - rim),
              (half - rim, half - corner), (half, half - corner)]
    outline = [(sx * x, sy * y) for x, y in points]
    return prism(outline if sx * sy > 0 else outline[::-1], *z)


def posts(places, z, radius=4.0):
    return [cylinder(radius, z, 6, x, y, capped=False) for x, y in places]


def caster(x, y):
    """A ball under the plate, as two discs, with its mounting."""
    return [cylinder(9.0, (-3.0, 3.0), 12, x, y), cylinder(6.0, (-8.5, -3.0), 12, x, y)]


def drive_motors(x, gap, z):
    """Two servos that end at the inner faces of the wheels, at y = +-gap."""
    return [box((x - 17.0, x + 17.0), y, z) for y in ((gap - 46.0, gap), (-gap, 46.0 - gap))]


def waffle():
    """Body 264 x 264 x 94 mm; wheels at x = 64, casters at (-113, +-64), laser above the middle."""
    levels = (2.0, 31.0, 60.0, 90.0)
    solids = []
    for level in levels:
        solids += plate(132.0, 36.0, (level, level + PLATE), 33.0, 7.0)
    grid = [(sx * x, sy * y) for sx in (-1, 1) for sy in (-1, 1) for x, y in ((120, 60), (60, 120))]
    for low, high in pairwise(levels):
        solids += posts(grid, (low + PLATE, high))
    solids += caster(-113.0, 64.0) + caster(-113.0, -64.0) + drive_motors(64.0, 132.0, (6.0, 40.0))
    solids += [box((-60.0, 60.0), (-35.0, 35.0), (6.0, 29.0)),      # battery
               box((-50.0, 55.0), (-40.0, 40.0), (40.0, 44.0)),     # motor board
               box((-45.0, 45.0), (-45.0, 45.0), (68.0, 84.0))]     # computer
    return solids + posts([(-25, 25), (-25, -25), (50, 0)], (94.0, 100.0))


def waffle_pi():
    """The waffle with its camera, whose lens ends 0.5 mm behind camera_rgb_frame (x 140, z 93)."""
    lens = turned(cylinder(4.0, (137.5, 139.5), 12), (2, 0, 1))
    return [*waffle(), box((131.0, 134.0), (-15.0, 15.0), (83.5, 108.0)),
            box((134.0, 137.5), (-12.5, 12.5), (84.0, 108.0)), moved(lens, (0.0, 0.0, 93.0))]


def burger():
    """Body 138 x 138 x 142 mm; wheels at x = 32, a caster at (-49, 0), laser above the middle."""
    levels = (2.0, 42.0, 88.0, 138.0)
    solids = []
    for level in levels:
        solids += plate(69.0, 20.0, (level, level + PLATE), 28.0, 7.0)
    grid = [(sx * 58, sy * 34) for sx in (-1, 1) for sy in (-1, 1)]
    for low, high in pairwise(levels):
        solids += posts(grid, (low + PLATE, high))
    solids += caster(-49.0, 0.0) + drive_motors(32.0, 68.0, (8.0, 42.0))
    solids += [box((-55.0, 10.0), (-22.0, 22.0), (6.0, 34.0)),      # battery
               box((-52.0, 52.0), (-37.0, 37.0), (54.0, 58.0)),     # motor board
               box((-42.0, 43.0), (-28.0, 28.0), (100.0, 104.0)),   # computer
               box((-40.0, -20.0), (-26.0, 26.0), (104.0, 118.0))]  # its sockets
    return solids + posts([(-25, 25), (-25, -25), (50, 0)], (142.0, 150.0))


def tire(side):
    """A wheel of radius 33 and width 18 mm round y; its hub shows left (side 1) or right (-1)."""
    solids = [ring(24.0, 33.0, (-9.0, 9.0), 28), cylinder(7.0, (-6.0, 8.0), 8)]
    solids += [spoke(72.0 * i) for i in range(5)]
    upright = [turned(solid, (1, 2, 0)) for solid in solids]  # along y now, the hub to the left
    return upright if side > 0 else [half_turn(solid) for solid in upright]


def spoke(angle_deg):
    """One of the five arms between hub and rim, in the plane z = 0."""
    cosine, sine = cos(radians(angle_deg)), sin(radians(angle_deg))
    corners = [(5.0, -3.5), (24.5, -3.5), (24.5, 3.5), (5.0, 3.5)]
    return prism([(cosine * x - sine * y, sine * x + cosine * y) for x, y in corners], -3.0, 6.0)


def half_turn(solid):
    """About z."""
    return solid * (-1.0, -1.0, 1.0)


def lds():
    """The laser: a base plate with its motor ahead of it, and the turning head, in base_scan."""
    return [cylinder(35.0, (-22.0, -9.0), 20), box((10.0, 62.0), (-20.0, 20.0), (-22.0, -9.0)),
            cylinder(12.0, (-9.0, -3.0), 12, 50.0), cylinder(22.0, (-9.0, 0.0), 16),
            cylinder(28.0, (0.0, 9.0), 20)]


def r200():
    """A bar 130 mm wide along x, y up, z forward, in m; it ends behind the frames at z = 0.005."""
    lens = cylinder(0.0045, (0.0042, 0.0047), 10)
    eyes = [moved(lens, (x, y, 0.0))
            for x, y in ((0.018, 0.013), (0.028, 0.013), (0.065, 0.007), (0.105, 0.007))]
    case = box((0.0, 0.13), (-0.003, 0.017), (-0.003, 0.0032))
    front = box((0.003, 0.127), (-0.001, 0.0155), (0.0032, 0.0042))
    return {"aluminium": ((0.62, 0.63, 0.65), [case]),
            "front": ((0.05, 0.05, 0.06), [front]),
            "glass": ((0.10, 0.14, 0.30), eyes)}


def files() -> dict[str, bytes]:
    """The files' bytes by path in the repository."""
    stl = {"bases/burger_base.stl": burger(), "bases/waffle_base.stl": waffle(),
           "bases/waffle_pi_base.stl": waffle_pi(), "wheels/left_tire.stl": tire(1),
           "wheels/right_tire.stl": tire(-1), "sensors/lds.stl": lds()}
    return {**{f"{MESHES}/{path}": stl_bytes(solids) for path, solids in stl.items()},
            f"{MESHES}/sensors/r200.dae": collada_bytes(r200())}
