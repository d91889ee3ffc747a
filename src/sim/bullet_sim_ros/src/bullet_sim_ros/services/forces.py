"""Wrenches on links and efforts on joints, for a while or until they are cleared."""

from gazebo_msgs.srv import ApplyBodyWrench, ApplyJointEffort, BodyRequest, JointRequest

from bullet_sim.forces import Effort, Span, Wrench
from bullet_sim.pose import IDENTITY, Vector3, rotate
from bullet_sim.twist import cross
from bullet_sim.world import World
from bullet_sim_ros import convert, names
from bullet_sim_ros.services.answers import ServiceError, done, offer
from bullet_sim_ros.services.lookup import find_frame, find_joint, find_link
from bullet_sim_ros.simulation import Simulation


def offer_force_services(simulation: Simulation) -> None:
    """apply_body_wrench, apply_joint_effort, clear_body_wrenches, clear_joint_forces."""
    world, mailbox = simulation.world, simulation.mailbox
    offer(mailbox, names.APPLY_BODY_WRENCH, ApplyBodyWrench,
          lambda request, response: apply_body_wrench(world, request, response))
    offer(mailbox, names.APPLY_JOINT_EFFORT, ApplyJointEffort,
          lambda request, response: apply_joint_effort(world, request, response))
    offer(mailbox, names.CLEAR_BODY_WRENCHES, BodyRequest,
          lambda request, _response: clear_body_wrenches(world, request.body_name))
    offer(mailbox, names.CLEAR_JOINT_FORCES, JointRequest,
          lambda request, _response: clear_joint_forces(world, request.joint_name))


def apply_body_wrench(world: World, request, response) -> None:
    """Force and torque on a link's centre of mass; ServiceError if request or link are wrong.

    A reference frame turns them into the axes of the body, and the result is then taken along the
    axes of the world, as upstream does: with the body itself as frame nothing is turned.
    """
    link = find_link(world, request.body_name, "ApplyBodyWrench: body does not exist")
    if not convert.is_sane(request.wrench.force, request.wrench.torque, request.reference_point):
        raise ServiceError(f"ApplyBodyWrench: wrench and reference_point must be finite and not "
                           f"beyond {convert.LARGEST:g}")
    frame, _ = find_frame(world, request.reference_frame,
                          "ApplyBodyWrench: reference_frame not found")
    force, torque = _triple(request.wrench.force), _triple(request.wrench.torque)
    torque = _sum(torque, cross(_triple(request.reference_point), force))
    if frame is not IDENTITY:
        pose = link.pose.inverse() * frame
        force, torque = rotate(pose.orientation, force), rotate(pose.orientation, torque)
        torque = _sum(torque, cross(pose.position, force))
    world.forces.wrenches.append(Wrench(link, force, torque, _span(world, request)))
    done(response, "")


def apply_joint_effort(world: World, request, response) -> None:
    """Effort on a joint; a fixed one takes it without moving. ServiceError if there is none."""
    model, _, joint = find_joint(world, request.joint_name, "ApplyJointEffort: joint not found")
    if not abs(request.effort) <= convert.LARGEST:
        raise ServiceError(
            f"ApplyJointEffort: effort must be finite and not beyond {convert.LARGEST:g}")
    if joint is not None:
        world.forces.efforts.append(Effort(model, joint, request.effort, _span(world, request)))
    done(response, "ApplyJointEffort: effort set")


def clear_body_wrenches(world: World, body: str) -> None:
    """Those of the link with exactly this scoped name; none is no error."""
    world.forces.drop(lambda job: isinstance(job, Wrench) and job.link.scoped_name == body)


def clear_joint_forces(world: World, joint: str) -> None:
    """Those of all joints with this unscoped name; none is no error."""
    world.forces.drop(lambda job: isinstance(job, Effort) and job.joint.name == joint)


def _span(world: World, request) -> Span:
    """A start in the past is now."""
    return Span(max(request.start_time.to_sec(), world.time), request.duration.to_sec())


def _triple(msg) -> Vector3:
    return (msg.x, msg.y, msg.z)


def _sum(a: Vector3, b: Vector3) -> Vector3:
    return tuple(x + y for x, y in zip(a, b, strict=True))
