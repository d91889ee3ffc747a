"""Entities by the names that requests use."""

from typing import Any

from geometry_msgs.msg import Pose as PoseMsg
from geometry_msgs.msg import Twist as TwistMsg

from bullet_sim import nested
from bullet_sim.description import JointDescription
from bullet_sim.errors import UnknownName
from bullet_sim.joint import Joint
from bullet_sim.link import Link
from bullet_sim.model import Model
from bullet_sim.nested import NestedModel, find_nested_model
from bullet_sim.pose import Pose
from bullet_sim.twist import Twist, twist_difference, twist_in
from bullet_sim.world import World
from bullet_sim_ros import convert
from bullet_sim_ros.services.answers import ServiceError

LINK_UNKNOWN = "link not found, did you forget to scope the link by model name?"


def find_model(world: World, name: str, missing: str) -> Model:
    """The model of that name, not a nested one; ServiceError(`missing`) if there is none.

    Only services that read accept nested models: see `find_part`.
    """
    part = find_part(world, name, missing)
    if part.name:
        raise ServiceError(missing)
    return part.model


def find_part(world: World, name: str, missing: str) -> NestedModel:
    """A model, or one nested in a model, by name; ServiceError(`missing`) if there is none."""
    part = find_nested_model(world.models.values(), name)
    if part is None:
        raise ServiceError(missing)
    return part


def find_link(world: World, name: str, missing: str) -> Link:
    """A link by `model::link`, or by a name that is unique; ServiceError(`missing`) if none is.

    A link that was lumped into another one by a fixed joint is not found.
    """
    try:
        link = world.link(name)
    except UnknownName:
        raise ServiceError(missing) from None
    if name not in (link.scoped_name, link.name):
        raise ServiceError(missing)
    return link


def find_frame(world: World, name: str, missing: str) -> tuple[Pose, Twist]:
    """Pose and twist of a reference frame; ServiceError(`missing`) if there is none."""
    try:
        return nested.find_frame(world.models, name)
    except UnknownName:
        raise ServiceError(missing) from None


def seen_from(world: World, name: str, pose: Pose, twist: Twist,
              missing: str) -> tuple[PoseMsg, TwistMsg]:
    """A pose and a twist in the axes of a reference frame; ServiceError(`missing`) without it."""
    frame, frame_twist = find_frame(world, name, missing)
    return (convert.pose_to_msg(frame.inverse() * pose),
            convert.twist_to_msg(twist_in(frame, twist_difference(twist, frame_twist))))


def check_sane(what: str, *values: Any) -> None:
    """ServiceError if a number in these messages, sequences or numbers is not finite, or huge."""
    if not convert.is_sane(*values):
        raise ServiceError(f"{what} must be finite and not beyond {convert.LARGEST:g}")


def find_joint(world: World, name: str, missing: str) -> tuple[Model, JointDescription,
                                                                Joint | None]:
    """The first joint of that name, unscoped or `model::joint`; its Joint is None if it is fixed.

    ServiceError(`missing`) if there is none.
    """
    for model in world.models.values():
        for description in model.description.joints:
            if name in (description.name, f"{model.name}::{description.name}"):
                return model, description, model.joints.get(description.name)
    raise ServiceError(missing)
