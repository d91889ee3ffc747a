"""Reads URDF joints that move, or are kept although fixed, with their `<gazebo>` tags."""

import logging
from dataclasses import replace
from functools import partial
from xml.etree.ElementTree import Element

from bullet_sim.description import JointDescription
from bullet_sim.errors import FormatError
from bullet_sim.formats.sdf.joint import read_limit, unit_axis
from bullet_sim.formats.urdf.extensions import Extensions, value_of
from bullet_sim.formats.urdf.tree import UrdfJoint
from bullet_sim.formats.xml_values import not_negative, numbers, or_default
from bullet_sim.pose import Vector3

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
