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
MOVING = ("revolute", "continuous", "prismatic")  # what the engine can move and drive
Member = tuple[LinkDescription, JointDescription | None]  # None: nothing carries the link
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
    joint: JointDescription | None = None  # None with a parent: welded, or held fixed
    pose_parent: Pose = IDENTITY  # this frame in the parent's physics frame, joint at zero
    linear_damping: float = 0.0  # <velocity_decay>
    angular_damping: float = 0.0


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
    for joint in model.joints:
        if joint.type not in (*MOVING, "fixed"):
            log.warning("model %s: joint %s is of type %s, which is not supported: it is held "
                        "fixed; those that move are: %s",
                        model.name, joint.name, joint.type, ", ".join(MOVING))
    return [_jointed_tree(model, members) for members in _components(model)]


def _components(model: ModelDescription) -> list[list[Member]]:
    """Each connected set of links, breadth first from its root."""
    joints_of: dict[str, list[JointDescription]] = {link.name: [] for link in model.links}
    for joint in model.joints:
        for end in {joint.parent, joint.child} - {WORLD}:
            joints_of[end].append(joint)
    links = {link.name: link for link in model.links}
    carrier: dict[str, JointDescription | None] = {}  # link -> joint between it and its parent
    components = []
    for root in _roots_first(model, joints_of):
        if root.name in carrier:
            continue
        anchors = [joint for joint in joints_of[root.name] if WORLD in _ends(joint)]
        carrier[root.name] = _towards(root.name, anchors[0], links) if anchors else None
        order = [root.name]
        for name in order:
            for joint in joints_of[name]:
                other = joint.child if joint.parent == name else joint.parent
                if other != WORLD and other not in carrier:
                    carrier[other] = _towards(other, joint, links)
                    order.append(other)
        components.append([(links[name], carrier[name]) for name in order])
    _warn_of_loops(model, carrier)
    return components


def _roots_first(
    model: ModelDescription, joints_of: dict[str, list[JointDescription]]
) -> list[LinkDescription]:
    """Links held by the world, then those that are no joint's child, then the others."""
    children = {joint.child for joint in model.joints}

    def rank(link: LinkDescription) -> int:
        if any(WORLD in _ends(joint) for joint in joints_of[link.name]):
            return 0
        return 2 if link.name in children else 1

    return sorted(model.links, key=rank)


def _ends(joint: JointDescription) -> tuple[str, str]:
    return joint.parent, joint.child


def _towards(
    child: str, joint: JointDescription, links: dict[str, LinkDescription]
) -> JointDescription:
    """The joint with `child` as its child, turned round if need be; its position stays the same."""
    if joint.child == child:
        return joint
    old_child = IDENTITY if joint.child == WORLD else links[joint.child].pose
    x, y, z = joint.axis
    return replace(joint, parent=joint.child, child=child, axis=(-x, -y, -z),
                   pose=links[child].pose.inverse() * old_child * joint.pose)


def _warn_of_loops(
    model: ModelDescription, carrier: dict[str, JointDescription | None]
) -> None:
    used = {joint.name for joint in carrier.values() if joint is not None}
    for joint in model.joints:
        if joint.name not in used:
            log.warning("model %s: joint %s closes a loop; it has no effect",
                        model.name, joint.name)


def _jointed_tree(model: ModelDescription, members: list[Member]) -> Tree:
    tree = Tree(self_collide=model.self_collide)
    frames: dict[str, Pose] = {}  # physics frame of each link in the model
    anchor = members[0][1]
    if anchor is not None:
        tree.fixed = True
        if anchor.type in MOVING:
            tree.links.append(PhysicsLink(WORLD, WORLD, MASSLESS, []))
            frames[WORLD] = IDENTITY
    for link, joint in members:
        moves = joint is not None and joint.type in MOVING
        offset = joint.pose if moves else IDENTITY
        frames[link.name] = link.pose * offset
        parent = joint.parent if joint is not None and joint.parent in frames else None
        pose = frames[parent].inverse() * frames[link.name] if parent else frames[link.name]
        _add(tree, link, offset, parent, joint if moves else None, pose)
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
        PhysicsLink(link.name, link.name, inertial, own, offset, parent, joint, pose_parent,
                    link.linear_damping, link.angular_damping)
    )
    welded = MASSLESS if link.inertial.mass == 0.0 else WELD_INERTIAL
    for number, group in enumerate(groups[1:], start=1):
        name = f"{link.name}__surface_{number}"
        tree.links.append(PhysicsLink(name, link.name, welded, group, offset, link.name))


def _share_link(a: Collision, b: Collision) -> bool:
    planes = isinstance(a.geometry, Plane) or isinstance(b.geometry, Plane)
    return a.surface == b.surface and a.laser_retro == b.laser_retro and not planes
