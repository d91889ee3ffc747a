"""The AutoRace courses: their floors, what missions put up and take away, and the two worlds.

The worlds are written as Gazebo saves them: poses in `<state>` win over the others.
"""

from __future__ import annotations

import json

import sdf
from painting import RED, YELLOW, Canvas, Painter, Point, beside, rounded
from painting import WHITE as WHITE_PAINT
from racecar_description.track.painted_plane import model_texts
from sdf import DARK, GREY, WHITE, Numbers, Part, box, cylinder, sphere
from turtlebot3_arenas import include, world

LIGHT = (1.39, -1.57)  # m, x and y of the traffic light
LAMPS = {  # height in m, colour
    "red": (0.11, (1.0, 0.0, 0.0)), "green": (0.21, (0.0, 1.0, 0.0)),
    "yellow": (0.31, (1.0, 1.0, 0.0)),
}
BAR = (-1.72, 0.56)  # m, x and y of the crossing
BAR_LONG, BAR_HIGH = 0.36, 0.12  # m
BURGER_INERTIAL = ("<inertial><pose>0 0 0.07 0 0 0</pose><mass>1</mass><inertia><ixx>0.0035</ixx>"
                   "<iyy>0.0035</iyy><izz>0.0035</izz></inertia></inertial>")
SIDE = 4.0  # m
FLOOR = "A black floor of 4 x 4 m with the lanes of a race."
FLOOR_2017, FLOOR_2020 = (10, 10, 10), (0, 0, 0)
# Driven in this order; the tunnel lies between the end and the start. Signs stand beside the lanes.
WAY_2017: tuple[Point, ...] = ((0.0, -1.787), (1.787, -1.787), (1.787, 1.787), (-1.787, 1.787),
                               (-1.787, 0.0))
WAY_2020: tuple[Point, ...] = (
    (0.0, -1.747), (1.747, -1.747), (1.747, -0.93), (0.35, -0.93), (0.35, -0.14), (1.62, -0.14),
    (1.62, 1.747), (-0.45, 1.747), (-0.9, 1.25), (-1.72, 1.25), (-1.72, 0.0),
)
LANE_2020 = 0.3, 0.25  # m: radius of its bends, width
SCENE = """  <scene>
    <ambient>0 0 0 1</ambient>
    <background>0.7 0.7 0.7 1</background>
    <shadows>0</shadows>
  </scene>"""
SUN = """  <light name="sun" type="directional">
    <cast_shadows>0</cast_shadows>
    <pose>0 0 10 0 0 0</pose>
    <diffuse>0.8 0.8 0.8 1</diffuse>
    <specular>0.2 0.2 0.2 1</specular>
    <direction>-0.5 0.5 -1</direction>
  </light>"""
POINT_LIGHT = """  <light name="{name}" type="point">
    <pose>0 0 {z} 0 0 0</pose>
    <diffuse>0.35 0.35 0.35 1</diffuse>
    <specular>0.1 0.1 0.1 1</specular>
    <attenuation><range>20</range><constant>0.5</constant><linear>0.1</linear><quadratic>0.02</quadratic></attenuation>
    <cast_shadows>0</cast_shadows>
  </light>"""
GROUND = """  <model name="ground2"><pose>0 0 -0.1 0 0 0</pose>
    <static>1</static>
    <link name="link">
      <collision name="collision"><geometry><box><size>8 8 0.01</size></box></geometry></collision>
      <visual name="visual"><geometry><box><size>10 10 0.01</size></box></geometry>
        <material><script><uri>file://media/materials/scripts/gazebo.material</uri>
        <name>Gazebo/FlatBlack</name></script></material></visual>
    </link>
  </model>"""
WALL_THICK, WALL_HIGH = 0.05, 0.5  # m
WALLS = {  # link: middle, yaw, length; round the square between (-2, -2) and (0, 0)
    "west": ((-2.0, -1.0), 1.5708, 2.0), "south": ((-1.0, -2.0), 0.0, 2.0),
    "north": ((-0.75, 0.0), 0.0, 1.5), "east": ((0.0, -0.75), 1.5708, 1.5),
}
OBSTACLES = {"tunnel_obstacle_1": (-1.2, -0.6), "tunnel_obstacle_2": (-0.6, -1.1),
             "tunnel_obstacle_3": (-1.5, -1.4)}
BARRIERS = ((1.49, 0.54), (1.74, 1.0), (1.49, 1.4))
BEFORE: Numbers = (3.0, 0.0, 0.25)  # where models stood before the world was saved
SIGNS_2017 = {"traffic_parking": (1.84, 1.27, 0.13, 0, 0, -0.356),
              "traffic_tunnel": (-1.544, -0.08, 0.125), "traffic_stop": (-2.05, 0.65, 0.125)}
SIGNS_2020 = {"traffic_parking": (0.74, 1.95, 0.13, 0, 0, -1.57),
              "traffic_tunnel": (-1.544, 0.0, 0.125),
              "traffic_stop": (-1.35, 1.04, 0.125, 0, 0, -1.57),
              "traffic_pl_left": (0.5, 1.9, 0.13),
              "traffic_construction": (1.0, 0.04, 0.125, 0, 0, -1.57),
              "traffic_intersection": (1.95, -1.0, 0.125),
              "traffic_noentry": (0.95, -0.758, 0.125), "checker": (5.5, -1.75, 0.0)}


def lamp(colour: str) -> str:
    """The lamp that is lit: a glowing ball round the dark one that stands in the world."""
    height, rgb = LAMPS[colour]
    part = Part("lamp", sphere(0.046), sdf.ORIGIN, rgb, solid=False, glows=True)
    return sdf.model(f"traffic_light_{colour}", [sdf.link("link", [part], (*LIGHT, height))])


def bar_down() -> str:
    parts = [Part("red", box(BAR_LONG / 3, 0.02, 0.03), sdf.ORIGIN, (0.9, 0.1, 0.1)),
             *(Part(name, box(BAR_LONG / 3, 0.02, 0.03), (x, 0, 0), WHITE)
               for name, x in (("west", -BAR_LONG / 3), ("east", BAR_LONG / 3)))]
    return sdf.model("traffic_bar_down", [sdf.link("link", parts, (*BAR, BAR_HIGH))])


def bar_up() -> str:
    """Upright over the eastern post."""
    parts = [Part("red", box(0.03, 0.02, BAR_LONG / 3), sdf.ORIGIN, (0.9, 0.1, 0.1)),
             *(Part(name, box(0.03, 0.02, BAR_LONG / 3), (0, 0, z), WHITE)
               for name, z in (("low", -BAR_LONG / 3), ("high", BAR_LONG / 3)))]
    place = (BAR[0] + BAR_LONG / 2 + 0.03, BAR[1], BAR_HIGH + BAR_LONG / 2)
    return sdf.model("traffic_bar_up", [sdf.link("link", parts, place)])


def bar_posts() -> str:
    """The link that stands in the world all the time, its origin in the bar's middle."""
    parts = [Part(name, box(0.03, 0.03, BAR_HIGH), (x, 0, -BAR_HIGH / 2), DARK)
             for name, x in (("west", -BAR_LONG / 2 - 0.03), ("east", BAR_LONG / 2 + 0.03))]
    return sdf.link("link", parts)


def burger() -> str:
    """A robot to be parked: its mission writes <static>1</static> over the 0."""
    parts = [Part("body", box(0.14, 0.14, 0.13), (-0.032, 0, 0.075), DARK),
             Part("wheel_left", cylinder(0.033, 0.018), (0, 0.08, 0.033, 1.5708, 0, 0), DARK),
             Part("wheel_right", cylinder(0.033, 0.018), (0, -0.08, 0.033, 1.5708, 0, 0), DARK),
             Part("laser", cylinder(0.035, 0.04), (-0.032, 0, 0.175), (0.3, 0.3, 0.3)),
             Part("caster", sphere(0.01), (-0.081, 0, 0.01), DARK)]
    return sdf.model("turtlebot3_burger", [sdf.link("base", parts, mass=BURGER_INERTIAL)], static=0)


def props() -> dict[str, bytes]:
    """Path below `models/` -> bytes."""
    texts = {f"traffic_light_{colour}": (lamp(colour), f"The {colour} lamp, lit.")
             for colour in LAMPS}
    texts |= {"traffic_bar_down": (bar_down(), "The crossing's bar, closed."),
              "traffic_bar_up": (bar_up(), "The crossing's bar, open."),
              "turtlebot3_burger": (burger(), "A burger to be parked.")}
    files: dict[str, bytes] = {}
    for folder in ("turtlebot3_autorace", "turtlebot3_autorace_2020"):
        for name, (text, description) in texts.items():
            files |= sdf.model_files(f"{folder}/{name}", text, description)
    return files


def bay(painter: Painter, left: float, low: float, right: float, high: float, open_at: str) -> None:
    """A parking bay of white lines, one of its sides broken."""
    corners = {"west": ((left, low), (left, high)), "east": ((right, low), (right, high)),
               "south": ((left, low), (right, low)), "north": ((left, high), (right, high))}
    for side, ends in corners.items():
        if side == open_at:
            painter.dashes(*ends, WHITE_PAINT)
        else:
            painter.line(ends, WHITE_PAINT)


def course_2017() -> Canvas:
    """One lane round the square; parking inside of the east side, a stop line before the bar."""
    canvas = Canvas(2048, SIDE, FLOOR_2017)
    painter = Painter(canvas, yaw=-1.54, line_width=0.018)
    painter.lane(WAY_2017, radius=0.4, width=0.296)
    painter.area([(1.62, 0.75), (1.66, 0.75), (1.66, 1.05), (1.62, 1.05)], FLOOR_2017)  # a gap
    painter.dashes((1.639, 0.75), (1.639, 1.05), YELLOW)
    bay(painter, 1.1, 0.45, 1.5, 0.8, "north")
    bay(painter, 1.1, 1.0, 1.5, 1.35, "south")
    painter.line([(-1.92, 0.7), (-1.66, 0.7)], WHITE_PAINT, 0.03)
    return canvas


def course_2020() -> Canvas:
    """A lane with an intersection, a building site, parking, a crossing; it ends at the tunnel."""
    canvas = Canvas(1024, SIDE, FLOOR_2020)
    painter = Painter(canvas, yaw=-3.14, line_width=0.02)
    painter.lane(WAY_2020, *LANE_2020)
    painter.line([(0.95, -1.86), (0.95, -1.63)], RED, 0.035)  # the start
    short_cut(painter)
    parking(painter)
    painter.line([(-1.83, 0.68), (-1.61, 0.68)], WHITE_PAINT, 0.03)
    return canvas


def short_cut(painter: Painter) -> None:
    """The way over the intersection that a sign forbids: from lane to lane at x = 1.05."""
    for y in (-0.805, -0.265):  # mouths in the lines of both lanes
        painter.area([(0.94, y - 0.03), (1.16, y - 0.03), (1.16, y + 0.03), (0.94, y + 0.03)],
                     FLOOR_2020)
    painter.line([(0.925, -0.805), (0.925, -0.265)], YELLOW)
    painter.line([(1.175, -0.805), (1.175, -0.265)], WHITE_PAINT)


def parking(painter: Painter) -> None:
    """Two bays, left and right of a way that leaves the northern lane at x = 0.48."""
    painter.area([(0.37, 1.59), (0.59, 1.59), (0.59, 1.65), (0.37, 1.65)], FLOOR_2020)
    painter.dashes((0.355, 1.6), (0.355, 1.0), WHITE_PAINT)
    painter.dashes((0.605, 1.6), (0.605, 1.0), WHITE_PAINT)
    painter.line([(0.355, 0.6), (0.605, 0.6)], WHITE_PAINT)
    bay(painter, 0.605, 0.6, 0.905, 1.0, "west")
    bay(painter, 0.055, 0.6, 0.355, 1.0, "east")


def courses() -> dict[str, bytes]:
    """Path below `models/` -> bytes."""
    files: dict[str, bytes] = {}
    for folder, canvas in (("turtlebot3_autorace/autorace_course", course_2017()),
                           ("turtlebot3_autorace_2020/course", course_2020())):
        texts = model_texts("course", description=FLOOR, size=(SIDE, SIDE),
                            uri=f"model://{folder}", part="course_")
        files |= {f"{folder}/{path}": text.encode() for path, text in texts.items()}
        files[f"{folder}/materials/textures/course.png"] = canvas.png()
    return files


def tunnel(name: str) -> str:
    """Four walls, each a link."""
    links = [sdf.link(link, [Part(link, box(length, WALL_THICK, WALL_HIGH), colour=GREY)],
                      (x, y, 0.0, 0, 0, yaw)) for link, ((x, y), yaw, length) in WALLS.items()]
    return sdf.model(name, links, BEFORE)


def tunnel_state(name: str) -> str:
    """The model at the origin; link poses are those in the world."""
    high = WALL_HIGH / 2
    links = "".join(f'\n      <link name="{link}">{sdf.pose((x, y, high, 0, 0, yaw))}</link>'
                    for link, ((x, y), yaw, _) in WALLS.items())
    return f'    <model name="{name}">{sdf.pose((0, 0, high))}{links}\n    </model>'


def single(name: str, part: Part) -> str:
    """A model of one part, where it stood before the world was saved."""
    return sdf.model(name, [sdf.link("link", [part])], BEFORE)


def state(poses: dict[str, Numbers], lights: dict[str, Numbers], *more: str) -> str:
    lines = [f'    <{kind} name="{name}">{sdf.pose(place)}</{kind}>'
             for kind, places in (("model", poses), ("light", lights))
             for name, place in places.items()]
    return "\n".join(['  <state world_name="default">', *lines, *more, "  </state>"])


def lamps() -> tuple[list[str], dict[str, Numbers]]:
    """The dark lamps and their post; and where they stand."""
    texts, places = [], {}
    for i, (height, rgb) in enumerate(LAMPS.values()):
        name = "unit_sphere" if i == 0 else f"unit_sphere_{i}"
        dim = tuple(0.3 * part for part in rgb)
        texts.append(single(name, Part("lamp", sphere(0.045), colour=dim)))
        places[name] = (*LIGHT, height)
    texts.append(single("traffic_light_post", Part("post", cylinder(0.008, 0.31), colour=DARK)))
    places["traffic_light_post"] = (LIGHT[0] + 0.05, LIGHT[1], 0.155)
    return texts, places


def race(folder: str, course: tuple[str, float], signs: dict[str, Numbers], wall: str,
         obstacles: list[str], lights: dict[str, Numbers], barriers: dict[str, Numbers]) -> bytes:
    """A race's world."""
    lamp_texts, poses = lamps()
    poses |= {"unit_box": (*BAR, BAR_HIGH), "ground": (0.0, 0.0, -0.1)}  # `ground` is no more
    parts = [single(name, Part("obstacle", cylinder(0.1, WALL_HIGH), colour=GREY))
             for name in obstacles]
    poses |= {name: (*place, WALL_HIGH / 2)
              for name, place in zip(obstacles, OBSTACLES.values(), strict=True)}
    parts += [single(name, Part("barrier", box(0.1, 0.03, 0.3), colour=(0.9, 0.35, 0.05)))
              for name in barriers]
    return world(
        SCENE, SUN, *(POINT_LIGHT.format(name=name, z=9) for name in lights), GROUND,
        include(f"{folder}/{course[0]}", (0, 0, 0, 0, 0, course[1])),
        *(include(f"{folder}/{name}", place) for name, place in signs.items()),
        tunnel(wall), *parts, sdf.model("unit_box", [bar_posts()], BEFORE), *lamp_texts,
        state(poses | barriers, lights, tunnel_state(wall)))


def race_worlds() -> dict[str, bytes]:
    """File name below `worlds/` -> bytes."""
    corners = [(1.5, 1.5, 2.5), (1.5, -1.5, 2.5), (-1.5, 1.5, 2.5), (-1.5, -1.5, 2.5)]
    lights = {f"user_point_light_{i}": place for i, place in enumerate(corners)}
    three = dict(list(lights.items())[:3])
    barriers = {f"barrier_{i}": (*place, 0.15) for i, place in enumerate(BARRIERS, 1)}
    return {
        "turtlebot3_autorace.world": race(
            "turtlebot3_autorace", ("autorace_course", -1.54), SIGNS_2017, "tunnel_wall_3",
            ["tunnel_occ_2_1", "tunnel_occ_2_2", "tunnel_occ_2_3"], lights, {}),
        "turtlebot3_autorace_2020.world": race(
            "turtlebot3_autorace_2020", ("course", -3.14), SIGNS_2020, "tunnel_wall",
            list(OBSTACLES), three, barriers),
        "turtlebot3_autorace_2020.json": plan_2020(),
    }


def plan_2020() -> bytes:
    """Where lane, walls, obstacles and barriers are, m and rad, for who judges drives in it."""
    radius, width = LANE_2020
    middle = rounded(WAY_2020, radius)
    lines = {"middle": middle, "left": beside(middle, width / 2),
             "right": beside(middle, -width / 2)}
    walls = [{"middle": place, "yaw": yaw, "length": length}
             for place, yaw, length in WALLS.values()]
    plan = {"lane": lines, "walls": walls, "obstacles": list(OBSTACLES.values()),
            "barriers": BARRIERS}
    return (json.dumps(plan) + "\n").encode()
