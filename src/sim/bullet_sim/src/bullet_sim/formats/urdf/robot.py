"""Reads a URDF robot by the rules of sdformat's parser_urdf.cc.

That includes `<gazebo>` tags, lumping, and dropping links without mass.
"""

import copy
import logging
from dataclasses import replace
from functools import partial
from xml.etree.ElementTree import Element

from bullet_sim.description import JointDescription, LinkDescription, ModelDescription
from bullet_sim.errors import FormatError
from bullet_sim.formats.mistakes import all_that_can
from bullet_sim.formats.sdf.frames import MODEL, Frames, add_model_frames
from bullet_sim.formats.sdf.joint import read_joint, read_limit, unit_axis
from bullet_sim.formats.sdf.link import read_link
from bullet_sim.formats.sdf.model import without_twins
from bullet_sim.formats.sdf.sensor import read_plugins
from bullet_sim.formats.source import Source
from bullet_sim.formats.urdf.extensions import Extensions, extend_link, value_of
from bullet_sim.formats.urdf.link import read_urdf_link
from bullet_sim.formats.urdf.lumping import Body, follow_lumping, lump
from bullet_sim.formats.urdf.tree import WORLD, UrdfJoint, UrdfTree, read_origin, read_tree
from bullet_sim.formats.xml_values import not_negative, numbers, or_default
from bullet_sim.pose import Pose, Vector3

KEEP_FIXED_JOINT = ("preserveFixedJoint", "disableFixedJointLumping")


def read_robot(robot: Element, source: Source) -> ModelDescription:
    """A `<robot>` as converted to SDF. FormatError as from `read_tree`."""
    tree = read_tree(robot)
    extensions = Extensions(robot)
    _warn_of_unknown_references(tree, extensions, source)

    def is_lumped(joint: UrdfJoint | None) -> bool:
        if joint is None or joint.type != "fixed" or joint.parent == WORLD:
            return False
        return not any(extensions.says(joint.name, tag) for tag in KEEP_FIXED_JOINT)

    bodies = {
        name: _read_body(tree, name, extensions, is_lumped(tree.inward.get(name)), source)
        for name in tree.depth_first(tree.root) if name != WORLD
    }
    bodies = lump(tree, bodies, is_lumped)
    survivor = {
        member: (name, pose) for name, body in bodies.items()
        for member, pose in body.members.items()
    }
    poses = tree.poses()
    kept = _with_mass(tree, bodies, survivor, source)
    links = [bodies[name].as_link(poses[name]) for name in kept]
    lumped = {
        member: place for member, place in survivor.items()
        if place[0] in kept and member != place[0]
    }
    joints = [
        read_urdf_joint(joint, survivor.get(joint.parent, (WORLD,))[0], extensions)
        for name in kept if (joint := tree.inward.get(name)) is not None
        and joint.type not in ("floating", "planar")  # CreateJoint makes none of these
    ]
    return _with_robot_level(robot, tree, extensions, links, joints, lumped, source)


def _read_body(
    tree: UrdfTree, name: str, extensions: Extensions, lumped: bool, source: Source
) -> Body:
    sdf, inertial, _ = read_urdf_link(tree.links[name])
    extend_link(sdf, extensions.of(name), lumped)
    link = read_link(sdf, source, f"robot {tree.name!r}")
    return Body.of(link, inertial)


def _with_mass(
    tree: UrdfTree, bodies: dict[str, Body], survivor: dict[str, tuple[str, Pose]], source: Source
) -> list[str]:
    """Links to keep, in order: one without mass is dropped with all links below it."""
    kept: list[str] = []
    for name in tree.depth_first(tree.root):
        if name not in bodies:
            continue
        joint = tree.inward.get(name)
        parent = survivor.get(joint.parent, (WORLD,))[0] if joint else WORLD
        if parent != WORLD and parent not in kept:
            continue
        if bodies[name].inertial is None:
            below = [link for link in tree.depth_first(name) if link != name]
            source.warn_once(
                f"robot {tree.name!r}: link {name!r} has no <inertial> or no mass and is left out"
                + (f", with {', '.join(below)} below it" if below else "")
            )
            continue
        kept.append(name)
    if not kept:
        raise read_urdf_link(tree.links[tree.root])[-1] or FormatError(
            f"robot {tree.name!r}: no link is left, as the root has no mass; "
            f"give link {tree.root!r} an <inertial>")
    return kept


def _with_robot_level(
    robot: Element,
    tree: UrdfTree,
    extensions: Extensions,
    links: list[LinkDescription],
    joints: list[JointDescription],
    lumped: dict[str, tuple[str, Pose]],
    source: Source,
) -> ModelDescription:
    """The model with the `<gazebo>` elements without reference; other tags are SDF as written."""
    extra = Element("model")
    extra.extend(extensions.of(""))
    where = f"robot {tree.name!r}"
    frames = Frames(source, tree.name)
    for link in links:
        frames.add(link.name, MODEL, link.pose)
    add_model_frames(frames, extra, where)
    links += all_that_can(read_link, without_twins(extra, "link", where), source, where, frames)
    names = {link.name for link in links}
    joints += all_that_can(
        read_joint, [_with_survivors(joint, lumped) for joint in extra.findall("joint")],
        source, where, frames, names)
    return ModelDescription(
        name=tree.name,
        pose=read_origin(robot, where),
        static=extensions.says("", "static"),
        self_collide=extensions.says("", "self_collide"),
        links=tuple(links),
        joints=tuple(joints),
        plugins=tuple(follow_lumping(plugin, lumped) for plugin in read_plugins(extra)),
        lumped=lumped,
    )


def _with_survivors(joint: Element, lumped: dict[str, tuple[str, Pose]]) -> Element:
    """Replace the ends of an SDF joint that were lumped by the survivors.

    Its pose stays, as in sdformat's parser_urdf.cc, ReduceSDFExtensionJointFrameReplace.
    """
    joint = copy.deepcopy(joint)
    for role in ("parent", "child"):
        end = joint.find(role)
        name = "" if end is None else (end.text or "").strip()
        if name in lumped:
            end.text = lumped[name][0]
    return joint


def _warn_of_unknown_references(tree: UrdfTree, extensions: Extensions, source: Source) -> None:
    joints = {joint.name for joint in tree.inward.values()}
    for name in extensions.references():
        if name not in tree.links and name not in joints:
            source.warn_once(f"<gazebo reference={name!r}> has no effect: robot {tree.name!r} has "
                             "no link or joint of that name")


logger = logging.getLogger(__name__)

FORWARD = (1.0, 0.0, 0.0)  # the axis of a joint without `<axis>`
NONE = (0.0,)
SPRINGS = {"springReference": "spring_reference", "springStiffness": "spring_stiffness"}


def read_urdf_joint(joint: UrdfJoint, parent: str, extensions: Extensions) -> JointDescription:
    """A joint below `parent`, the link into which its written parent was lumped.

    FormatError for invalid numbers.
    """
    where = f"joint {joint.name!r}"
    described = JointDescription(
        name=joint.name, type=joint.type, parent=parent, child=joint.child,
        provide_feedback=extensions.says(joint.name, "provideFeedback"))
    if joint.type != "fixed":
        return replace(
            described, axis=_axis(joint.element, where), **_limits(joint, where),
            **_dynamics(joint.element, where), **_springs(joint.name, extensions))
    if (extensions.says(joint.name, "preserveFixedJoint")  # this one wins
            or not extensions.says(joint.name, "disableFixedJointLumping")):
        return described
    return replace(described, type="revolute", lower=0.0, upper=0.0)  # cannot turn


def _axis(element: Element, where: str) -> Vector3:
    axis = element.find("axis")
    text = "1 0 0" if axis is None else axis.get("xyz", "1 0 0")
    where = f"{where} <axis xyz>"
    return unit_axis(numbers(text, 3, where), FORWARD, where)


def _limits(joint: UrdfJoint, where: str) -> dict[str, float]:
    limit = joint.element.find("limit")
    if limit is None:
        if joint.type == "continuous":
            return {}
        raise FormatError(f"{where} is {joint.type} but has no <limit>")
    result = {}
    for key in ("effort", "velocity"):
        if limit.get(key) is None:
            raise FormatError(f"{where} <limit {key}> is missing")
        result[key] = read_limit(limit.get(key, ""), key, f"{where} <limit {key}>")
    if joint.type == "continuous":
        return result
    lower, upper = (
        read_limit(limit.get(key, "0"), key, f"{where} <limit {key}>") for key in ("lower", "upper")
    )
    if lower > upper:
        logger.warning("%s: lower limit %g is above upper limit %g; switching the two",
                       where, lower, upper)
        lower, upper = upper, lower
    return result | {"lower": lower, "upper": upper}


def _dynamics(element: Element, where: str) -> dict[str, float]:
    dynamics = element.find("dynamics")
    if dynamics is None:
        return {}
    result = {}
    for key in ("damping", "friction"):
        place = f"{where} <dynamics {key}>"
        written = numbers(dynamics.get(key, "0"), 1, place)
        result[key], = or_default(partial(not_negative, written, place), NONE)
    return result


def _springs(name: str, extensions: Extensions) -> dict[str, float]:
    found = {}
    for tag in extensions.of(name):
        if tag.tag in SPRINGS:
            where = f"<gazebo reference={name!r}> <{tag.tag}>"
            found[SPRINGS[tag.tag]], = or_default(
                partial(numbers, value_of(tag), 1, where), NONE)
    return found
