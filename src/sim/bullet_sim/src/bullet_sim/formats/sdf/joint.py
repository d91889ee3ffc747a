"""Reads SDF joints, converting old files' model-frame axes to the joint frame."""

import math
from functools import partial
from xml.etree.ElementTree import Element

import bullet_sim.formats.xml_values as xml
from bullet_sim.description import JointAxis, JointDescription
from bullet_sim.errors import FormatError
from bullet_sim.formats.mistakes import instead
from bullet_sim.formats.sdf.frames import MODEL, Frames, end_of
from bullet_sim.formats.source import Source
from bullet_sim.pose import Vector3, conjugate, multiply, rotate

TYPES = (
    "revolute", "revolute2", "prismatic", "ball", "universal", "screw", "gearbox", "fixed",
    "continuous",
)
AXES = ("axis", "axis2")
UPWARD = (0.0, 0.0, 1.0)  # the axis of a joint without `<axis>`
LIMITS = ("lower", "upper", "effort", "velocity")
UNLIMITED = JointDescription("", "", "", "")
AXES_IN_JOINT_FRAME = (1, 5)  # SDF version since which an axis is given in the joint frame


def read_joint(
    element: Element, source: Source, model: str, frames: Frames, links: set[str]
) -> JointDescription:
    """A joint between two of `links`, or between one and the world.

    FormatError for an unknown type or link.
    """
    name = element.get("name", "")
    where = f"{model}, joint {name!r}"
    kind = element.get("type", "")
    if kind not in TYPES:
        raise FormatError(f"{where}: unknown type {kind!r}; there are: {', '.join(TYPES)}")
    parent = _end(element, "parent", links | {"world"}, where)
    child = _end(element, "child", links | {"world"}, where)
    if parent == child:
        raise FormatError(f"{where}: parent and child are both {parent!r}; name two links")
    axis, axis2 = (
        Element(tag) if element.find(tag) is None else element.find(tag) for tag in AXES
    )
    return JointDescription(
        name=name,
        type=kind,
        parent=parent,
        child=child,
        pose=frames.in_model(child).inverse() * frames.joint_in_model(name),
        axis=_direction(axis, name, source, frames, f"{where} <axis>"),
        provide_feedback=xml.flag(element, "physics/provide_feedback", False)
        or xml.flag(element, "physics/ode/provide_feedback", False),
        **_axis_numbers(axis, f"{where} <axis>"),
        axis2=JointAxis(
            axis=_direction(axis2, name, source, frames, f"{where} <axis2>"),
            **_axis_numbers(axis2, f"{where} <axis2>"),
        ),
        thread_pitch=_not_zero(element, "thread_pitch", where),
        gearbox_ratio=_not_zero(element, "gearbox_ratio", where),
        gearbox_reference_body=xml.child_text(element, "gearbox_reference_body"),
    )


def _not_zero(element: Element, tag: str, where: str) -> float:
    value = xml.number(element, tag, 1.0, where)
    if value == 0.0:
        instead(FormatError(f"{where} <{tag}>: 0 is not possible"), "1")
        return 1.0
    return value


def _end(element: Element, role: str, known: set[str], where: str) -> str:
    end = end_of(element, role)
    if end not in known:
        names = ", ".join(sorted(known))
        raise FormatError(f"{where}: no {role} link named {end!r}; there are: {names}")
    return end


def _axis_numbers(axis: Element, where: str) -> dict[str, float]:
    limits = {
        key: xml.or_default(partial(read_limit, text, key, f"{where} <limit/{key}>"),
                            getattr(UNLIMITED, key))
        for key in LIMITS if (text := xml.child_text(axis, f"limit/{key}"))
    }
    losses = xml.fields(xml.amount, axis, "damping friction", UNLIMITED, where, "dynamics/")
    springs = xml.fields(xml.number, axis, "spring_reference spring_stiffness", UNLIMITED, where,
                         "dynamics/")
    return limits | losses | springs


def read_limit(text: str, key: str, where: str) -> float:
    """One number of a joint's limits; infinity is allowed here and means no limit.

    FormatError if it is not a number.
    """
    if text.strip().lower() in (("-inf",) if key == "lower" else ("inf", "+inf")):
        return getattr(UNLIMITED, key)
    return xml.numbers(text, 1, where)[0]


def _direction(
    axis: Element, joint: str, source: Source, frames: Frames, where: str
) -> Vector3:
    """Unit axis in the joint frame."""
    unit = unit_axis(xml.vector(axis, "xyz", UPWARD, where), UPWARD, f"{where} <xyz>")
    given_in = _axis_frame(axis, source)
    if not given_in:
        return unit
    joint_in_model = frames.joint_in_model(joint).orientation
    frame_in_model = frames.in_model(given_in).orientation
    return rotate(multiply(conjugate(joint_in_model), frame_in_model), unit)


def unit_axis(written: Vector3, usual: Vector3, where: str) -> Vector3:
    """An axis of length 1; `usual`, with an error line, if it has no direction."""
    length = math.hypot(*written)
    if length == 0.0:
        instead(FormatError(f"{where}: the axis {xml.shown(written)} has no direction"),
                xml.shown(usual))
        return usual
    return tuple(part / length for part in written)


def _axis_frame(axis: Element, source: Source) -> str:
    """The frame in which an axis is given; empty for the joint's own."""
    expressed_in = axis.find("xyz")
    if expressed_in is not None and expressed_in.get("expressed_in"):
        return expressed_in.get("expressed_in", "")
    old = source.version < AXES_IN_JOINT_FRAME
    return MODEL if xml.flag(axis, "use_parent_model_frame", old) else ""
