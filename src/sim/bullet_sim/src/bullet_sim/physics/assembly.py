"""From a model description to trees that the engine can load: components and welds.

The engine has one friction per link and no plane inside a compound shape, so collisions of a link
with different surfaces, and every plane, are on welded links of their own.
"""

from dataclasses import dataclass, field, replace

from bullet_sim.description import (
    Collision,
    Inertial,
    JointDescription,
    LinkDescription,
    ModelDescription,
    Plane,
)
from bullet_sim.physics.axes import MOVING, single_axis_joints
from bullet_sim.physics.inertia import sound_inertial
from bullet_sim.pose import IDENTITY, Pose
from bullet_sim.twist import negative

WORLD = "world"
Member = tuple[LinkDescription, JointDescription | None]  # None: no joint carries the link
# A welded link needs some mass to count as movable for the collision filter; this is negligible.
WELD_INERTIAL = Inertial(mass=1e-6, inertia=(1e-9, 0.0, 0.0, 1e-9, 0.0, 1e-9))
NO_DIRECTION = (0.0, 0.0, 0.0)  # the default of <fdir1>
MASSLESS = Inertial(mass=0.0, inertia=(0.0,) * 6)
MOST_LINKS = 128  # of a tree, in PyBullet; it reports nothing of a larger one


@dataclass
class PhysicsLink:
    """A link in the engine; `offset` is its frame in the described link's frame."""

    name: str
    described: str  # name of the description's link to which it belongs
    inertial: Inertial
    collisions: list[Collision]
    offset: Pose = IDENTITY
    parent: str | None = None
    joint: JointDescription | None = None  # None with a parent: welded, or held fixed
    pose_parent: Pose = IDENTITY  # this frame in the parent's physics frame, joint at zero
    linear_damping: float = 0.0  # <velocity_decay>
    angular_damping: float = 0.0
    carrier: JointDescription | None = None  # the joint that holds it, moving or fixed
    turned: bool = False  # whether it is the parent of that joint in the description


@dataclass
class Tree:
    """One connected set of links; the first one is the base."""

    links: list[PhysicsLink] = field(default_factory=list)
    fixed: bool = False  # no forces act on the base
    kinematic: bool = False  # but it moves with a given velocity
    self_collide: bool = False

    @property
    def fixed_base(self) -> bool:
        """Whether the base is fixed to the world."""
        return self.fixed and not self.kinematic


def assemble(model: ModelDescription) -> list[Tree]:
    """Trees of a model, in the order of its links. A static model is welded into few of them.
    """
    if model.static:
        return _welded_trees(model)
    written = {joint.name: joint for joint in model.joints}
    return [_jointed_tree(model, members, written) for members in _components(model)]


def _components(model: ModelDescription) -> list[list[Member]]:
    """Each connected set of links, breadth first from its root."""
    joints_of: dict[str, list[JointDescription]] = {link.name: [] for link in model.links}
    for joint in model.joints:
        for end in {joint.parent, joint.child} - {WORLD} if joint.type != "gearbox" else ():
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
    return components


def _roots_first(
    model: ModelDescription, joints_of: dict[str, list[JointDescription]]
) -> list[LinkDescription]:
    """Links held by the world, kinematic ones, those that are no joint's child, the others."""
    children = {joint.child for joint in model.joints}

    def rank(link: LinkDescription) -> int:
        if any(WORLD in _ends(joint) for joint in joints_of[link.name]):
            return 0
        if link.kinematic:
            return 1
        return 3 if link.name in children else 2

    return sorted(model.links, key=rank)


def _ends(joint: JointDescription) -> tuple[str, str]:
    return joint.parent, joint.child


def _towards(
    child: str, joint: JointDescription, links: dict[str, LinkDescription]
) -> JointDescription:
    """The joint with `child` as its child, reversed if necessary; its position stays the same."""
    if joint.child == child:
        return joint
    old_child = IDENTITY if joint.child == WORLD else links[joint.child].pose
    return replace(joint, parent=joint.child, child=child, axis=negative(joint.axis),
                   axis2=replace(joint.axis2, axis=negative(joint.axis2.axis)),
                   pose=links[child].pose.inverse() * old_child * joint.pose)


def loop_joints(model: ModelDescription, trees: list[Tree]) -> list[JointDescription]:
    """Joints that carry no link: they close loops, or couple others (gearbox)."""
    carriers = {link.carrier.name for tree in trees for link in tree.links if link.carrier}
    return [] if model.static else [
        joint for joint in model.joints if joint.name not in carriers]


def _jointed_tree(model: ModelDescription, members: list[Member],
                  written: dict[str, JointDescription]) -> Tree:
    tree = Tree(self_collide=model.self_collide or any(link.self_collide for link, _ in members))
    frames: dict[str, Pose] = {}  # physics frame of each link in the model
    anchor = members[0][1]
    tree.kinematic = tree.fixed = members[0][0].kinematic and anchor is None
    if anchor is not None:
        tree.fixed = True
        if anchor.type in MOVING or anchor.provide_feedback:
            tree.links.append(PhysicsLink(WORLD, WORLD, MASSLESS, []))
            frames[WORLD] = IDENTITY
    for described, joint in members:
        link = replace(described, inertial=sound_inertial(
            described.inertial, described.collisions, f"model {model.name}, link {described.name}"))
        moves = joint is not None and joint.type in MOVING
        offset = joint.pose if moves else IDENTITY
        frames[link.name] = link.pose * offset
        parent = joint.parent if joint is not None and joint.parent in frames else None
        pose = frames[parent].inverse() * frames[link.name] if parent else frames[link.name]
        turned = joint is not None and joint.child != written[joint.name].child
        *between, last = single_axis_joints(joint, turned) if moves else [None]
        for stage in between:
            name = f"{link.name}__{stage.name}"
            tree.links.append(
                PhysicsLink(name, link.name, WELD_INERTIAL, [], offset, parent, stage, pose))
            parent, pose = name, IDENTITY
        first = len(tree.links)
        _add(tree, link, offset, parent, last, pose)
        tree.links[first].carrier, tree.links[first].turned = joint, turned
    return tree


def _welded_trees(model: ModelDescription) -> list[Tree]:
    trees: list[Tree] = []
    for link in model.links:
        own = Tree(fixed=True)  # of this link alone, with its surfaces
        _add(own, replace(link, inertial=MASSLESS), IDENTITY, None, None, link.pose)
        if not trees or len(trees[-1].links) + len(own.links) > MOST_LINKS:
            trees.append(own)
            continue
        base, first = trees[-1].links[0], own.links[0]
        first.parent, first.pose_parent = base.name, base.pose_parent.inverse() * link.pose
        trees[-1].links += own.links
    return trees


def _add(tree: Tree, link: LinkDescription, offset: Pose, parent: str | None,
         joint: JointDescription | None, pose_parent: Pose) -> None:
    """Append the link and the welded links for its other surfaces."""
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
    if a.surface.fdir1 != NO_DIRECTION and a.pose.orientation != b.pose.orientation:
        return False  # a link in the engine has one direction of friction
    return a.surface == b.surface and a.laser_retro == b.laser_retro and not planes
