"""Bodies with joints that tests of drives and mechanisms are made of."""

from bullet_sim.description import (
    Box,
    Collision,
    Inertial,
    JointDescription,
    LinkDescription,
    ModelDescription,
    Surface,
)
from bullet_sim.pose import IDENTITY, Pose, Vector3

INERTIA = (0.01, 0.0, 0.0, 0.01, 0.0, 0.01)  # kg m^2


def part(name: str, pose: Pose = IDENTITY, size: Vector3 | None = None,
         surface: Surface = Surface(), com: Vector3 = (0.0, 0.0, 0.0)) -> LinkDescription:
    """A link of 1 kg; a box of that size, or without one nothing to touch."""
    collisions = () if size is None else (Collision("c", Box(size), surface=surface),)
    return LinkDescription(name, pose, Inertial(1.0, Pose(com), INERTIA), collisions=collisions)


def body(name: str, size: Vector3 | None = None, static: bool = False,
         **options) -> ModelDescription:
    """A model of one part, `l`."""
    return ModelDescription(name, static=static, links=(part("l", size=size, **options),))


def rig(*joints: JointDescription, links: tuple[LinkDescription, ...] = (),
        name: str = "rig", free: bool = False) -> ModelDescription:
    """Parts on a base `base`, which is fixed to the world or free; a part for each child."""
    given = {link.name for link in links} | {"base"}
    children = tuple(part(joint.child) for joint in joints if joint.child not in given)
    base = () if any(link.name == "base" for link in links) else (part("base"),)
    foot = () if free else (JointDescription("foot", "fixed", "world", "base"),)
    return ModelDescription(name, links=(*base, *links, *children), joints=(*foot, *joints))


def hinge(name: str, axis: Vector3 = (0.0, 0.0, 1.0), **options) -> JointDescription:
    """A joint that turns the part `NAME_link` of a rig on its base."""
    return JointDescription(name, "revolute", "base", f"{name}_link", axis=axis, **options)


def slider(name: str, axis: Vector3, parent: str = "base", **options) -> JointDescription:
    """A joint that slides the part `NAME_link` of a rig."""
    return JointDescription(name, "prismatic", parent, f"{name}_link", axis=axis, **options)
