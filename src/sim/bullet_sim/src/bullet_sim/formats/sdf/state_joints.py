"""Positions of a saved model's joints, computed from the poses that its links were saved with."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from bullet_sim.description import JointDescription, ModelDescription
from bullet_sim.pose import IDENTITY, Pose

TURNING = ("revolute", "continuous")
NOTHING = 1e-9  # rad or m


def with_saved_joints(model: ModelDescription, saved: Mapping[str, Pose]) -> ModelDescription:
    """The model with `start` of its joints of one axis; `saved` are link poses in the world.

    The links' own poses stay as they were written: with these every joint is at zero.
    """
    written = {link.name: model.pose * link.pose for link in model.links}
    now = {**written, **{name: pose for name, pose in saved.items() if name in written}}
    return replace(model, joints=tuple(
        replace(joint, start=_position(joint, written, now)) for joint in model.joints))


def _position(joint: JointDescription, written: Mapping[str, Pose],
              now: Mapping[str, Pose]) -> float:
    """Angle (rad) or travel (m) between the written and the present pose of the child."""
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
