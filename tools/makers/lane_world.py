"""The lane's worlds and the model of its ground."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import cv2
from lane_keeping.world.ground import Plane, draw_ground, plane_of
from lane_keeping.world.scenery import (
    PERSON_RADIUS,
    Crossings,
    Lamp,
    Scenery,
    Tree,
    Zebra,
    load_crossings,
    load_scenery,
    person_begin,
)
from racecar_description.track.painted_plane import model_texts
from racecar_description.track.track_file import load_track_file
from sdf import box, cylinder, sphere

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "src/lessons/lane_keeping"
MODEL = "lane_track"
PERSON_HEIGHT = 0.9  # m
PERSON_RATE = 50.0  # Hz, of a person's odometry
CLOTHES = ("1 0.35 0", "0.85 0 0.6", "0 0.35 0.9", "0.8 0 0")  # one per person, then repeated
TROUSERS, SKIN, BARK, LEAVES, METAL = "0.1 0.15 0.6", "0.9 0.7 0.55", "0.35 0.25 0.15", (
    "0.2 0.4 0.15"), "0.45 0.47 0.5"


def files() -> dict[str, bytes]:
    """The files' bytes by path in the repository: the ground, lane.world, and it without people."""
    crossings, scenery = load_crossings(PACKAGE / "config/crossings.yaml"), load_scenery(
        PACKAGE / "config/lane_scenery.yaml")
    track_file = load_track_file(ROOT / "src/evaluation/tracks/lane.yaml")
    plane, texture = plane_of(track_file), draw_ground(track_file, crossings, scenery)
    model = model_texts(MODEL, description=_DESCRIPTION, size=(plane.width, plane.height),
                        uri=f"model://{MODEL}", part="")
    texts = {
        **{f"models/{MODEL}/{path}": text for path, text in model.items()},
        "worlds/lane.world": _world(plane, scenery, _people(crossings)),
        "worlds/lane_empty.world": _world(plane, scenery, []),
    }
    made = {name: text.encode() for name, text in texts.items()}
    made[f"models/{MODEL}/materials/textures/{MODEL}.png"] = cv2.imencode(
        ".png", texture[..., ::-1], [cv2.IMWRITE_PNG_COMPRESSION, 9])[1].tobytes()
    return {f"{PACKAGE.relative_to(ROOT)}/{name}": data for name, data in made.items()}


def _world(plane: Plane, scenery: Scenery, people: list[str]) -> str:
    parts = [_tree(number, tree) for number, tree in enumerate(scenery.trees, 1)]
    parts += [_lamp(number, lamp) for number, lamp in enumerate(scenery.lamps, 1)]
    return (_WORLD.replace("MIDDLE", f"{plane.x:g} {plane.y:g}")
            .replace("PARTS", "\n".join(parts + people)))


def _people(crossings: Crossings) -> list[str]:
    return [_person(number, zebra, crossings) for number, zebra in enumerate(crossings.zebras, 1)]


def _tree(number: int, tree: Tree) -> str:
    crown, trunk = sphere(tree.crown), cylinder(0.06, tree.height)
    return _static(f"tree_{number}", tree.x, tree.y, [
        ("trunk", f"0 0 {tree.height / 2:g}", trunk, BARK, True),
        ("crown", f"0 0 {tree.height:g}", crown, LEAVES, False)])


def _lamp(number: int, lamp: Lamp) -> str:
    return _static(f"lamp_{number}", lamp.x, lamp.y, [
        ("pole", f"0 0 {lamp.height / 2:g}", cylinder(0.035, lamp.height), METAL, True),
        ("head", f"0 0 {lamp.height:g}", sphere(0.16), "0.95 0.95 0.8", False)])


def _person(number: int, zebra: Zebra, crossings: Crossings) -> str:
    """A person moved by commands on /pedestrian_N/cmd_vel; floats, so that nothing slows it."""
    x, y, yaw = person_begin(zebra, crossings)
    shirt = CLOTHES[(number - 1) % len(CLOTHES)]
    visuals = "\n".join(_visual(*part) for part in (
        ("left_leg", "0 0.06 0.2", cylinder(0.05, 0.4), TROUSERS),
        ("right_leg", "0 -0.06 0.2", cylinder(0.05, 0.4), TROUSERS),
        ("body", "0 0 0.55", box(0.15, 0.24, 0.32), shirt),
        ("head", "0 0 0.8", sphere(0.09), SKIN)))
    collision = (f'<collision name="body"><pose>0 0 {PERSON_HEIGHT / 2} 0 0 0</pose>'
                 f"<geometry>{cylinder(PERSON_RADIUS, PERSON_HEIGHT - 0.02)}</geometry>"
                 "</collision>")
    name = f"pedestrian_{number}"
    return (_PERSON.replace("NAME", name).replace("POSE", f"{x:.4f} {y:.4f} 0 0 0 {yaw:.6f}")
            .replace("SHAPES", f"{collision}\n{visuals}").replace("RATE", f"{PERSON_RATE:g}"))


def _static(name: str, x: float, y: float, parts: Iterable[tuple]) -> str:
    """A static model; each part: name, pose, shape, colour, and whether it has a collision."""
    inner = []
    for part, pose, shape, colour, solid in parts:
        inner.append(_visual(part, pose, shape, colour))
        if solid:
            inner.append(f'<collision name="{part}"><pose>{pose} 0 0 0</pose>'
                         f"<geometry>{shape}</geometry></collision>")
    shapes = "\n".join(inner)
    return (f'<model name="{name}"><static>true</static><pose>{x:g} {y:g} 0 0 0 0</pose>'
            f'<link name="link">\n{shapes}\n</link></model>')


def _visual(name: str, pose: str, shape: str, colour: str) -> str:
    return (f'<visual name="{name}"><pose>{pose} 0 0 0</pose><geometry>{shape}</geometry>'
            f"<material><ambient>{colour} 1</ambient><diffuse>{colour} 1</diffuse></material>"
            "</visual>")


_DESCRIPTION = """Lawn with a road in the shape of 凹, one lane, zebra crossings and shade.
Written by tools/makers."""

_PERSON = """<model name="NAME">
<pose>POSE</pose>
<link name="body"><gravity>false</gravity>
<inertial><pose>0 0 0.45 0 0 0</pose><mass>20</mass><inertia><ixx>2</ixx><ixy>0</ixy><ixz>0</ixz>
<iyy>2</iyy><iyz>0</iyz><izz>0.5</izz></inertia></inertial>
SHAPES
</link>
<plugin name="walk" filename="libgazebo_ros_planar_move.so">
<commandTopic>/NAME/cmd_vel</commandTopic><odometryTopic>/NAME/odom</odometryTopic>
<odometryFrame>world</odometryFrame><robotBaseFrame>NAME</robotBaseFrame>
<odometryRate>RATE</odometryRate><cmdTimeout>0.5</cmdTimeout>
</plugin></model>"""

_WORLD = """<?xml version="1.0"?>
<!-- The lane in the shape of 凹. Written by tools/makers.
     凹 形车道，由 tools/makers 生成 -->
<sdf version="1.4">
<world name="default">
<scene>
<ambient>0.4 0.4 0.4 1</ambient>
<background>0.62 0.75 0.88 1</background>
<shadows>false</shadows>
</scene>
<include><uri>model://sun</uri></include>
<include><uri>model://ground_plane</uri></include>
<include><uri>model://lane_track</uri><pose>MIDDLE 0.001 0 0 0</pose></include>
PARTS
<physics type="ode">
<max_step_size>0.001</max_step_size>
<real_time_factor>1</real_time_factor>
<real_time_update_rate>1000</real_time_update_rate>
</physics>
</world>
</sdf>
"""
