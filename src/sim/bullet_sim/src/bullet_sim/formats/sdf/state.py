"""Applies the `<state>` of a saved world: its poses replace those written in the models."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from xml.etree.ElementTree import Element

import bullet_sim.formats.xml_values as xml
from bullet_sim.description import (
    JointDescription,
    LightDescription,
    ModelDescription,
    WorldDescription,
)
from bullet_sim.errors import FormatError
from bullet_sim.formats.mistakes import instead
from bullet_sim.formats.sdf.shapes import scaled_model
from bullet_sim.pose import IDENTITY, Pose

UNSCALED = (1.0, 1.0, 1.0)
TURNING = ("revolute", "continuous")
NOTHING = 1e-9  # rad or m
LATEST = 4e9  # s; ROS counts to 2**32


def apply_state(world: WorldDescription, state: Element) -> WorldDescription:
    """The world as it was saved; names that do not exist (any more) are ignored.

    Values that would be a FormatError keep their defaults, with an error line.
    """
    deleted = {(name.text or "").strip() for name in state.findall("deletions/name")}
    models = {model.get("name", ""): model for model in state.findall("model")}
    lights = {light.get("name", ""): light for light in state.findall("light")}
    return replace(
        world,
        sim_time=_sim_time(state, world.sim_time),
        models=tuple(
            _moved_model(model, models[model.name]) if model.name in models else model
            for model in world.models
            if model.name not in deleted
        ),
        lights=tuple(
            _moved_light(light, lights[light.name]) if light.name in lights else light
            for light in world.lights
            if light.name not in deleted
        ),
    )


def _sim_time(state: Element, default: float) -> float:
    """Seconds and nanoseconds, as two words."""
    text = xml.child_text(state, "sim_time")
    if not text:
        return default
    where = "<state> <sim_time>"
    count = 1 if len(text.split()) == 1 else 2

    def read() -> float:
        seconds, nanoseconds = (*xml.not_negative(xml.numbers(text, count, where), where), 0.0)[:2]
        time = seconds + nanoseconds * 1e-9
        if time > LATEST:
            raise FormatError(f"{where}: {time:g} s is more than ROS can count; "
                              f"at most {LATEST:g}")
        return time

    return xml.or_default(read, default)


def _moved_light(light: LightDescription, state: Element) -> LightDescription:
    return replace(light, pose=xml.pose(state, f"<state> of light {light.name!r}", light.pose))


def _moved_model(model: ModelDescription, state: Element) -> ModelDescription:
    where = f"<state> of model {model.name!r}"
    model = replace(model, pose=xml.pose(state, where, model.pose))
    scale = xml.vector(state, "scale", UNSCALED, where)
    if min(scale) <= 0.0:
        instead(FormatError(f"{where} <scale>: {min(scale):g} leaves nothing"), xml.shown(UNSCALED))
        scale = UNSCALED
    model = scaled_model(model, scale)
    saved = dict(_link_poses(state, "", where))
    if model.joints and not model.static:
        return _with_saved_joints(model, saved)
    to_model = model.pose.inverse()  # link poses are saved in the world frame
    return replace(
        model,
        links=tuple(
            replace(link, pose=to_model * saved[link.name]) if link.name in saved else link
            for link in model.links
        ),
    )


def _link_poses(state: Element, scope: str, where: str) -> Iterator[tuple[str, Pose]]:
    for link in state.findall("link"):
        if xml.child_text(link, "pose"):
            name = link.get("name", "")
            yield scope + name, xml.pose(link, f"{where}, link {name!r}")
    for nested in state.findall("model"):
        yield from _link_poses(nested, f"{scope}{nested.get('name', '')}::", where)


def _with_saved_joints(model: ModelDescription, saved: Mapping[str, Pose]) -> ModelDescription:
    """The model with `start` of its single-axis joints; `saved` are link poses in the world.

    The links' own poses stay as written: with these every joint is at zero.
    """
    written = {link.name: model.pose * link.pose for link in model.links}
    now = {name: saved.get(name, pose) for name, pose in written.items()}
    return replace(model, joints=tuple(
        replace(joint, start=_position(joint, written, now)) for joint in model.joints))


def _position(joint: JointDescription, written: Mapping[str, Pose],
              now: Mapping[str, Pose]) -> float:
    """Angle (rad) or travel (m) between the written and the saved pose of the child."""
    length = math.hypot(*joint.axis)
    known = joint.child in now and joint.parent in ("world", *now)
    if joint.type not in (*TURNING, "prismatic") or not known or length == 0.0:
        return 0.0
    before, after = (poses.get(joint.parent, IDENTITY).inverse() * poses[joint.child] * joint.pose
                     for poses in (written, now))
    moved = before.inverse() * after
    x, y, z, w = moved.orientation
    parts = (x, y, z) if joint.type in TURNING else moved.position
    along = sum(a * b for a, b in zip(joint.axis, parts, strict=True)) / length
    if joint.type in TURNING:
        along = math.remainder(2.0 * math.atan2(along, w), math.tau)
    position = min(max(along, joint.lower), joint.upper)
    return position if abs(position) > NOTHING else 0.0
