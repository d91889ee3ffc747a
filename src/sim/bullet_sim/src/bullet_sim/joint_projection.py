"""Placing a link that joints hold to the world: it moves as far as its own joint allows.

In Gazebo such a link keeps any pose for one step; then its joints pull it back.
"""

import math

from bullet_sim.link import Link
from bullet_sim.pose import Pose, rotate
from bullet_sim.twist import Twist, dot, shifted_twist, twist_difference


def project_to_joint(link: Link, pose: Pose, twist: Twist) -> tuple[str, float, float] | None:
    """Name, position and rate (rad or m) of the joint that carries `link`, nearest to these.

    `pose` and `twist` (of the link's origin) are in the world. None of a link that is fixed to the
    world or hangs on a ball joint.
    """
    body = link.body
    carrier = body.moving_carrier(link.name)
    if carrier is None:
        return None
    joint, axis = carrier.joint, carrier.joint.axis
    frame = body.engine_frame(body.index[carrier.name])
    wanted = pose * link.pose.inverse() * frame
    moved = frame.inverse() * wanted
    parent_pose, parent_twist = link.model.link_states().get(
        body.described_parent(carrier), (Pose(), Twist()))
    own = twist_difference(
        twist, shifted_twist(parent_twist, parent_pose.position, pose.position))
    if joint.type == "prismatic":
        step, motion = dot(moved.position, axis), own.linear
    else:
        x, y, z, w = moved.orientation
        step = math.remainder(2.0 * math.atan2(dot((x, y, z), axis), w), 2.0 * math.pi)
        motion = own.angular
    position = body.joint_state(joint.name)[0] + step
    if joint.type != "continuous" and joint.lower <= joint.upper:
        position = max(joint.lower, min(joint.upper, position))
    return joint.name, position, dot(rotate(frame.orientation, axis), motion)
