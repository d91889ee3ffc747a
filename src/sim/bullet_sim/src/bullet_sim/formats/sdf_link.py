"""Reads SDF links: inertia, visuals, collisions, sensors and lights."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from bullet_sim.description import Inertial, LinkDescription
from bullet_sim.errors import FormatError
from bullet_sim.formats.sdf_frames import relative_to
from bullet_sim.formats.sdf_light import read_light
from bullet_sim.formats.sdf_sensor import read_sensor
from bullet_sim.formats.sdf_shapes import read_collision, read_visual
from bullet_sim.formats.source import Source
from bullet_sim.formats.xml_values import amount, flag, number, pose
from bullet_sim.pose import IDENTITY, Pose

WORLD = "world"
PLACED_PARTS = ("visual", "collision", "sensor", "light", "inertial")
TENSOR = (("ixx", 1.0), ("ixy", 0.0), ("ixz", 0.0), ("iyy", 1.0), ("iyz", 0.0), ("izz", 1.0))


def read_link(
    element: Element, source: Source, model: str, placed: Pose = IDENTITY
) -> LinkDescription:
    """A link standing at `placed` in the model frame."""
    name = element.get("name", "")
    if not name:
        raise FormatError(f"{model}: a <link> has no name")
    if name == WORLD:
        raise FormatError(f"{model}: no link can be named 'world', joints have that name for what "
                          "stands still; choose another")
    where = f"{model}, link {name!r}"
    _warn_of_frames(element, source, where)
    visuals = [read_visual(visual, source, where) for visual in element.findall("visual")]
    collisions = [read_collision(part, source, where) for part in element.findall("collision")]
    return LinkDescription(
        name=name,
        pose=placed,
        inertial=read_inertial(element, where),
        visuals=tuple(visual for visual in visuals if visual),
        collisions=tuple(collision for collision in collisions if collision),
        sensors=tuple(read_sensor(sensor, where) for sensor in element.findall("sensor")),
        lights=tuple(read_light(light, where) for light in element.findall("light")),
        gravity=flag(element, "gravity", True),
        kinematic=flag(element, "kinematic", False),
        self_collide=flag(element, "self_collide", False),
        linear_damping=amount(element, "velocity_decay/linear", 0.0, where),
        angular_damping=amount(element, "velocity_decay/angular", 0.0, where),
    )


def read_inertial(element: Element, where: str) -> Inertial:
    """A link's `<inertial>`, with SDF's unit defaults."""
    inertial = element.find("inertial")
    if inertial is None:
        return Inertial()
    where = f"{where} <inertial>"
    return Inertial(
        mass=amount(inertial, "mass", 1.0, where),
        pose=pose(inertial, where),
        inertia=tuple(
            (amount if usual else number)(inertial, f"inertia/{key}", usual, where)
            for key, usual in TENSOR  # products of inertia may be negative
        ),
    )


def _warn_of_frames(element: Element, source: Source, where: str) -> None:
    for part in element:
        frame = relative_to(part)
        if part.tag in PLACED_PARTS and frame not in ("", element.get("name")):
            source.warn_once(f"{where}: <{part.tag}> is given relative to {frame!r}, "
                             "which is not supported; the link frame is taken")
