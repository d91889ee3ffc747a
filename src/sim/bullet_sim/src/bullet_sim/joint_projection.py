"""Putting a link that joints hold to the world: it goes as far as its own joint lets it.

In Gazebo such a link stands anywhere for one step; then its joints pull it back to what they allow.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from bullet_sim.physics.body import Body
from bullet_sim.pose import Pose, rotate
from bullet_sim.twist import Twist, shifted_twist, twist_difference

if TYPE_CHECKING:
    from bullet_sim.link import Link


def put_in_joint(link: Link, body: Body, pose: Pose, twist: Twist) -> None:
    """Give the joint that carries `link` the position and rate that come nearest to these.

    `pose` and `twist` (of the link's origin) are in the world. What hangs on the link goes with it;
    a link that is fixed to the world, or hangs on a ball, stays.
    """
    carrier = body.moving_carrier(link.name)
    if carrier is None:
        return
    joint, axis = carrier.joint, carrier.joint.axis
    frame = body.engine_frame(body.index(carrier.name))
    wanted = pose * link.pose.inverse() * frame
    moved = frame.inverse() * wanted
    parent_pose, parent_twist = link.model.link_states().get(
        body.described_parent(carrier), (Pose(), Twist()))
    own = twist_difference(
        twist, shifted_twist(parent_twist, parent_pose.position, pose.position))
    if joint.type == "prismatic":
        step, motion = _dot(moved.position, axis), own.linear
    else:
        x, y, z, w = moved.orientation
        step = math.remainder(2.0 * math.atan2(_dot((x, y, z), axis), w), 2.0 * math.pi)
        motion = own.angular
    position = body.joint_state(joint.name)[0] + step
    if joint.type != "continuous" and joint.lower <= joint.upper:
        position = max(joint.lower, min(joint.upper, position))
    link.model.reset_axis(joint.name, position, _dot(rotate(frame.orientation, axis), motion))


def _dot(a, b) -> float:
    return sum(x * y for x, y in zip(a, b, strict=True))
