"""Fixed-joint lumping: a child's mass, shapes and sensors become its parent's.

As in sdformat's parser_urdf.cc, ReduceFixedJoints.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from xml.etree.ElementTree import Element

import numpy as np

from bullet_sim.description import (
    Collision,
    Inertial,
    LightDescription,
    LinkDescription,
    PluginDescription,
    SensorDescription,
    Visual,
)
from bullet_sim.formats.urdf.extensions import put
from bullet_sim.formats.urdf.tree import UrdfJoint, UrdfTree
from bullet_sim.formats.xml_values import numbers, or_default, vector_text
from bullet_sim.pose import IDENTITY, Pose, rotation_matrix, symmetric_matrix

LUMP = "_fixed_joint_lump__"
OFFSETS = ("xyzOffset", "rpyOffset")


@dataclass
class Body:
    """A link during lumping; shapes keep their first owner's name or their own."""

    link: LinkDescription
    inertial: Inertial | None
    visuals: list[tuple[str, str, Visual]] = field(default_factory=list)  # owner, stem, visual
    collisions: list[tuple[str, str, Collision]] = field(default_factory=list)
    sensors: list[SensorDescription] = field(default_factory=list)
    lights: list[LightDescription] = field(default_factory=list)
    members: dict[str, Pose] = field(default_factory=dict)  # links in this body, in its frame

    @staticmethod
    def of(link: LinkDescription, inertial: Inertial | None) -> Body:
        """A body that is only one link so far."""
        return Body(
            link, inertial,
            [(link.name, shape.name or link.name, shape) for shape in link.visuals],
            [(link.name, shape.name or link.name, shape) for shape in link.collisions],
            list(link.sensors), list(link.lights), {link.name: IDENTITY},
        )

    def take_in(self, child: Body, origin: Pose) -> None:
        """Add everything of `child`; `origin`: the pose of its frame in this body."""
        self.inertial = combined(self.inertial, child.inertial, origin)
        self.visuals += [(owner, stem, _moved(s, origin)) for owner, stem, s in child.visuals]
        self.collisions += [(owner, stem, _moved(s, origin)) for owner, stem, s in child.collisions]
        self.sensors += [_moved(sensor, origin) for sensor in child.sensors]
        self.lights += [_moved(light, origin) for light in child.lights]
        self.members |= {name: origin * pose for name, pose in child.members.items()}

    def as_link(self, pose: Pose) -> LinkDescription:
        """The finished link at `pose` in the model frame."""
        collisions, renamed = _named(self.link.name, self.collisions, "_collision")
        return replace(
            self.link,
            pose=pose,
            inertial=self.inertial or Inertial(),
            visuals=_named(self.link.name, self.visuals, "_visual")[0],
            collisions=collisions,
            sensors=tuple(_with_contact_names(sensor, renamed) for sensor in self.sensors),
            lights=tuple(self.lights),
        )


def lump(
    tree: UrdfTree, bodies: dict[str, Body], is_lumped: Callable[[UrdfJoint], bool]
) -> dict[str, Body]:
    """The surviving bodies by link name, each with what it took in, deepest children first."""
    surviving = dict(bodies)

    def gather(name: str) -> None:
        for joint in tree.outward.get(name, ()):
            gather(joint.child)
            if is_lumped(joint):
                surviving[name].take_in(surviving.pop(joint.child), joint.origin)

    gather(tree.root)
    return surviving


def combined(parent: Inertial | None, child: Inertial | None, origin: Pose) -> Inertial | None:
    """Both masses as one, about their common centre, along the parent link's axes."""
    if child is None:
        return parent
    moved = replace(child, pose=origin * child.pose)
    parts = [part for part in (parent, moved) if part is not None]
    mass = sum(part.mass for part in parts)
    if mass == 0.0:
        return parent
    centre = sum(part.mass * np.array(part.pose.position) for part in parts) / mass
    tensor = np.zeros((3, 3))
    for part in parts:
        turn = rotation_matrix(part.pose.orientation)
        arm = np.array(part.pose.position) - centre
        tensor += turn @ symmetric_matrix(part.inertia) @ turn.T
        tensor += part.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))  # parallel axis theorem
    six = tuple(float(tensor[i, j]) for i, j in zip(*np.triu_indices(3), strict=True))
    return Inertial(mass=mass, pose=Pose(tuple(map(float, centre))), inertia=six)


def _moved(part, origin: Pose):
    return replace(part, pose=origin * part.pose)


def _named(
    link: str, shapes: list[tuple[str, str, Visual | Collision]], ending: str
) -> tuple[tuple, dict[str, str]]:
    """Shapes with sdformat's names, and for each the name it would have without lumping."""
    named, renamed = [], {}
    own_count: dict[str, int] = {}
    for index, (owner, stem, shape) in enumerate(shapes):
        name = f"{stem}{ending}" + (f"_{index}" if index else "")
        if not name.startswith(link):  # sdformat recognises lumped shapes only by this prefix
            name = link + LUMP + name
        own_index = own_count.get(owner, 0)
        own_count[owner] = own_index + 1
        renamed.setdefault(f"{stem}{ending}" + (f"_{own_index}" if own_index else ""), name)
        named.append(replace(shape, name=name))
    return tuple(named), renamed


def _with_contact_names(sensor: SensorDescription, renamed: dict[str, str]) -> SensorDescription:
    """Rename the collisions that a contact sensor names to their names after lumping."""
    if sensor.element is None or sensor.element.find("contact/collision") is None:
        return sensor
    element = copy.deepcopy(sensor.element)
    for collision in element.findall("contact/collision"):
        text = (collision.text or "").strip()
        collision.text = renamed.get(text, text)
    return replace(sensor, element=element)


def follow_lumping(
    plugin: PluginDescription, lumped: dict[str, tuple[str, Pose]]
) -> PluginDescription:
    """Replace a plugin's lumped `bodyName` or `frameName` by the survivor, with offsets."""
    element = copy.deepcopy(plugin.element)
    origin = None
    for tag in ("bodyName", "frameName"):
        child = element.find(tag)
        name = "" if child is None else (child.text or "").strip()
        if name in lumped:
            child.text, origin = lumped[name]
    if origin is not None:
        xyz, rpy = (_offset(element, tag, plugin.name) for tag in OFFSETS)
        place = origin * Pose.from_xyz_rpy(xyz, rpy)
        put(element, OFFSETS[0], vector_text(place.position))
        put(element, OFFSETS[1], vector_text(place.rpy()))
    return replace(plugin, element=element)


def _offset(element: Element, tag: str, plugin: str) -> tuple[float, ...]:
    text = (element.findtext(tag) or "").strip() or "0 0 0"
    return or_default(lambda: numbers(text, 3, f"plugin {plugin!r} <{tag}>"), (0.0, 0.0, 0.0))
