"""Reads SDF links: inertia, visuals, collisions, sensors and lights."""

from dataclasses import replace
from typing import TypeVar
from xml.etree.ElementTree import Element

from bullet_sim.description import Inertial, LinkDescription
from bullet_sim.errors import FormatError
from bullet_sim.formats.prop_shapes import read_parts
from bullet_sim.formats.sdf.frames import Frames, relative_to
from bullet_sim.formats.sdf.scene import read_light
from bullet_sim.formats.sdf.sensor import read_sensor
from bullet_sim.formats.sdf.shapes import read_collision, read_visual
from bullet_sim.formats.source import Source
from bullet_sim.formats.xml_values import amount, child_text, flag, pose, size
from bullet_sim.pose import IDENTITY

WORLD = "world"
ENDLESS = {"nan", "inf", "infinity"}
Placed = TypeVar("Placed")  # a description with a pose, or None
TENSOR = (("ixx", 1.0), ("ixy", 0.0), ("ixz", 0.0), ("iyy", 1.0), ("iyz", 0.0), ("izz", 1.0))


def read_link(
    element: Element, source: Source, model: str, frames: Frames | None = None
) -> LinkDescription:
    """A link, posed by its model's frames; without these at its model's origin.

    FormatError if it has no name, or the name `world`.
    """
    name = element.get("name", "")
    if not name:
        raise FormatError(f"{model}: a <link> has no name")
    if name == WORLD:
        raise FormatError(f"{model}: no link can be named 'world', joints use that name for the "
                          "fixed world; choose another")
    where = f"{model}, link {name!r}"
    if frames is None:
        frames = Frames(source, model)
        frames.add(name, "", IDENTITY)
    place = _PartPlaces(name, frames, source, where)
    warned = len(source.warned)
    collisions = [place(collision, part) for part in element.findall("collision")
                  for collision in read_parts(read_collision, part, source, where, name)]
    if not collisions and len(source.warned) == warned:
        _warn_of_lost_collisions(element, source, where)
    visuals = [place(visual, part) for part in element.findall("visual")
               for visual in read_parts(read_visual, part, source, where, name)]
    return LinkDescription(
        name=name,
        pose=frames.in_model(name),
        inertial=place(read_inertial(element, where), element.find("inertial")),
        visuals=tuple(visuals),
        collisions=tuple(collisions),
        sensors=tuple(
            place(read_sensor(sensor, where), sensor) for sensor in element.findall("sensor")),
        lights=tuple(
            place(read_light(light, where), light) for light in element.findall("light")),
        gravity=flag(element, "gravity", True),
        kinematic=flag(element, "kinematic", False),
        self_collide=flag(element, "self_collide", False),
        **_decay(element, where),
    )


def _warn_of_lost_collisions(element: Element, source: Source, where: str) -> None:
    """Name the files that were not found, even if another link's warning named them."""
    files = [child_text(shape, "uri") or child_text(shape, "filename")
             for shape in element.findall("collision/geometry/*")]
    if any(files):
        source.warn_once(f"{where}: nothing collides with it, and it falls for ever if nothing "
                         f"holds it: {', '.join(dict.fromkeys(filter(None, files)))} not found")


def _decay(element: Element, where: str) -> dict[str, float]:
    """Damping of a link's motion; SDF 1.2 called it `<damping>`."""
    tag = "damping" if element.find("velocity_decay") is None else "velocity_decay"
    return {"linear_damping": amount(element, f"{tag}/linear", 0.0, where),
            "angular_damping": amount(element, f"{tag}/angular", 0.0, where)}


class _PartPlaces:
    """Converts the pose of a part from the frame that it names to the link's frame."""

    def __init__(self, link: str, frames: Frames, source: Source, where: str):
        self._link = link
        self._frames = frames
        self._source = source
        self._where = where

    def __call__(self, part: Placed, element: Element | None) -> Placed:
        frame = "" if element is None else relative_to(element)
        if part is None or frame in ("", self._link):
            return part
        if frame not in self._frames:
            self._source.warn_once(f"{self._where}: <{element.tag}> is given relative to "
                                   f"{frame!r}, which is not in the model; the link frame is taken")
            return part
        link_in_model = self._frames.in_model(self._link)
        frame_in_link = link_in_model.inverse() * self._frames.in_model(frame)
        return replace(part, pose=frame_in_link * part.pose)


def drop_endless_inertia(model: Element) -> None:
    """Take `nan` and `inf` out of a static model, as nothing reads its inertia; Gazebo is silent.

    Exporters write them for what has no mass.
    """
    for inertial in model.iter("inertial"):
        for parent in list(inertial.iter()):
            for value in list(parent):
                words = (value.text or "").lower().replace("-", " ").replace("+", " ").split()
                if not ENDLESS.isdisjoint(words):
                    parent.remove(value)


def read_inertial(element: Element, where: str) -> Inertial:
    """A link's `<inertial>`, with SDF's defaults: 1 kg and a unit tensor."""
    inertial = element.find("inertial")
    if inertial is None:
        return Inertial()
    where = f"{where} <inertial>"
    return Inertial(
        mass=amount(inertial, "mass", 1.0, where),
        pose=pose(inertial, where),
        inertia=tuple(
            (amount if usual else size)(inertial, f"inertia/{key}", usual, where)
            for key, usual in TENSOR  # products of inertia may be negative
        ),
    )
