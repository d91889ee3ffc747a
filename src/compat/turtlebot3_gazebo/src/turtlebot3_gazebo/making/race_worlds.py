"""The two AutoRace worlds, written as Gazebo saves them: poses in `<state>` win over the others."""

from __future__ import annotations

import json

from turtlebot3_gazebo.making import sdf
from turtlebot3_gazebo.making.courses import LANE_2020, WAY_2020
from turtlebot3_gazebo.making.lanes import beside, rounded
from turtlebot3_gazebo.making.props import BAR, BAR_HIGH, LAMPS, LIGHT, bar_posts
from turtlebot3_gazebo.making.sdf import DARK, GREY, Numbers, Part, box, cylinder, sphere
from turtlebot3_gazebo.making.worlds import include, world

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
