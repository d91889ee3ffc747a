"""From a model description to trees that the engine can load: components and welds.

The engine has one friction per link and no plane inside a compound shape, so collisions of a link
that differ in surface, and every plane, ride on a welded link of their own.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass, field, replace

from bullet_sim.description import (
    Collision,
    Inertial,
    JointDescription,
    LinkDescription,
    ModelDescription,
    Plane,
)
from bullet_sim.pose import IDENTITY, Pose

log = logging.getLogger(__name__)

WORLD = "world"
# A welded shape needs some mass to count as movable for the collision filter; this is no load.
WELD_INERTIAL = Inertial(mass=1e-6, inertia=(1e-9, 0.0, 0.0, 1e-9, 0.0, 1e-9))
MASSLESS = Inertial(mass=0.0, inertia=(0.0,) * 6)


@dataclass
class PhysicsLink:
    """A link as the engine sees it; `offset` is its frame in the described link's frame."""

    name: str
    described: str  # name of the link of the description that it belongs to
    inertial: Inertial
    collisions: list[Collision]
    offset: Pose = IDENTITY
    parent: str | None = None
    joint: JointDescription | None = None  # None with a parent: welded
    pose_parent: Pose = IDENTITY  # this frame in the parent's physics frame, joint at zero


@dataclass
class Tree:
    """One connected set of links; the first one is the base."""

    links: list[PhysicsLink] = field(default_factory=list)
    fixed: bool = False
    self_collide: bool = False


def assemble(model: ModelDescription) -> list[Tree]:
    """Trees of a model, in the order of its links. A static model is one welded tree."""
    if model.static:
        return [_welded_tree(model)] if model.links else []
    return [_jointed_tree(model, roots) for roots in _components(model)]


def _components(model: ModelDescription) -> list[list[LinkDescription]]:
    """Root links (with all they carry, breadth first) of each connected component."""
    children: dict[str, list[str]] = {}
    parents: dict[str, str] = {}
    for joint in model.joints:
        if joint.child in parents:
            log.warning("model %s: joint %s closes a loop; it has no effect",
                        model.name, joint.name)
            continue
        parents[joint.child] = joint.parent
        if joint.parent != WORLD:
            children.setdefault(joint.parent, []).append(joint.child)
    by_name = {link.name: link for link in model.links}
    components = []
    for link in model.links:
        if parents.get(link.name, WORLD) != WORLD:
            continue
        order = [link.name]
        for name in order:
            order.extend(children.get(name, ()))
        components.append([by_name[name] for name in order])
    return components


def _jointed_tree(model: ModelDescription, links: list[LinkDescription]) -> Tree:
    joints: dict[str, JointDescription] = {}
    for joint in model.joints:
        joints.setdefault(joint.child, joint)
    tree = Tree(self_collide=model.self_collide)
    frames: dict[str, Pose] = {}  # physics frame of each link in the model
    anchor = joints.get(links[0].name)
    if anchor is not None:
        tree.fixed = True
        if anchor.type != "fixed":
            tree.links.append(PhysicsLink(WORLD, WORLD, MASSLESS, []))
            frames[WORLD] = IDENTITY
    for link in links:
        joint = joints.get(link.name)
        movable = joint is not None and not (joint.parent == WORLD and joint.type == "fixed")
        offset = joint.pose if movable else IDENTITY
        frames[link.name] = link.pose * offset
        parent = joint.parent if movable else None
        pose = frames[parent].inverse() * frames[link.name] if parent else frames[link.name]
        _add(tree, link, offset, parent, joint if movable else None, pose)
    return tree


def _welded_tree(model: ModelDescription) -> Tree:
    tree = Tree(fixed=True)
    base = model.links[0]
    for link in model.links:
        parent = None if link is base else base.name
        pose = link.pose if link is base else base.pose.inverse() * link.pose
        _add(tree, replace(link, inertial=MASSLESS), IDENTITY, parent, None, pose)
    return tree


def _add(tree: Tree, link: LinkDescription, offset: Pose, parent: str | None,
         joint: JointDescription | None, pose_parent: Pose) -> None:
    """Append the link and the welded carriers of its odd collisions."""
    back = offset.inverse()
    groups: list[list[Collision]] = []
    for collision in link.collisions:
        moved = replace(collision, pose=back * collision.pose)
        fits = [group for group in groups if _share_link(group[0], moved)]
        if fits:
            fits[0].append(moved)
        else:
            groups.append([moved])
    own = groups[0] if groups else []
    inertial = replace(link.inertial, pose=back * link.inertial.pose)
    tree.links.append(
        PhysicsLink(link.name, link.name, inertial, own, offset, parent, joint, pose_parent)
    )
    welded = MASSLESS if link.inertial.mass == 0.0 else WELD_INERTIAL
    for number, group in enumerate(groups[1:], start=1):
        name = f"{link.name}__surface_{number}"
        tree.links.append(PhysicsLink(name, link.name, welded, group, offset, link.name))


def _share_link(a: Collision, b: Collision) -> bool:
    planes = isinstance(a.geometry, Plane) or isinstance(b.geometry, Plane)
    return a.surface == b.surface and a.laser_retro == b.laser_retro and not planes
