"""Force and torque in a joint, for a force-torque sensor."""

from bullet_sim.physics.assembly import PhysicsLink
from bullet_sim.physics.body import Body
from bullet_sim.pose import Vector3, conjugate, multiply, rotate
from bullet_sim.twist import add, cross, negative


def joint_reaction(body: Body, link: PhysicsLink) -> tuple[Vector3, Vector3]:
    """The load of the joint that carries `link`: force (N) and torque (N m) about its anchor.

    As Gazebo's ODEJoint::GetForceTorque (physics/ode/ODEJoint.cc): of the joint's child on the
    joint, in the child link's frame, including the motor's effort; a weight hanging below is a
    downward force. The effort of a limit that is pressed against is missing along the
    axis. Zero until the step after the first call, unless the joint asked for feedback.
    """
    index = body.links.index[link.name]
    body.joints.enable_feedback(index)
    effort, row = body.joints.effort_and_load(index)
    # In the engine: of the parent on the child, about its centre of mass, in its principal axes.
    com = body.links.com_in_link(index)
    force = rotate(com.orientation, row[:3])
    torque = rotate(com.orientation, row[3:])
    joint = link.carrier
    moves = link.joint is not None
    if moves:
        along = tuple(effort * part for part in link.joint.axis)
        if link.joint.type == "prismatic":
            force = add(force, along)
        else:  # a ball joint's effort is 0
            torque = add(torque, along)
    anchor = (0.0, 0.0, 0.0) if moves or joint is None else joint.pose.position
    arm = tuple(c - a for c, a in zip(com.position, anchor, strict=True))
    torque = add(torque, cross(arm, force))
    if not link.turned:
        out = link.offset.orientation
        return negative(rotate(out, force)), negative(rotate(out, torque))
    # The engine's child is the described parent: the wrench on the described child is its negative.
    parent = next(other for other in body.tree.links if other.name == link.parent)
    here, there = (body.links.frame(each.name) for each in (link, parent))
    turn = multiply(conjugate(there.orientation), here.orientation)
    out = multiply(parent.offset.orientation, turn)
    return rotate(out, force), rotate(out, torque)
