"""Wrenches on links and efforts on joints, for a while or until they are cleared."""

from gazebo_msgs.srv import ApplyBodyWrench, ApplyJointEffort, BodyRequest, JointRequest

from bullet_sim.pose import IDENTITY, rotate
from bullet_sim.timed_forces import Effort, Span, Wrench
from bullet_sim.twist import add, cross
from bullet_sim.world import World
from bullet_sim_ros import convert, names
from bullet_sim_ros.services.answers import done, service
from bullet_sim_ros.services.lookup import check_sane, find_frame, find_joint, find_link
from bullet_sim_ros.simulation import Simulation


@service(names.APPLY_BODY_WRENCH, ApplyBodyWrench)
def apply_body_wrench(simulation: Simulation, request, response) -> None:
    """Force and torque on a link's centre of mass; ServiceError if request or link are wrong.

    They are transformed from the reference frame into the body's axes, and the result is applied
    in the world's axes (applyBodyWrench): with the body itself as frame nothing is rotated.
    """
    world = simulation.world
    link = find_link(world, request.body_name, "ApplyBodyWrench: body does not exist")
    check_sane("ApplyBodyWrench: wrench and reference_point", request.wrench,
               request.reference_point)
    frame, _ = find_frame(world, request.reference_frame,
                          "ApplyBodyWrench: reference_frame not found")
    force, torque = map(convert.triple, (request.wrench.force, request.wrench.torque))
    torque = add(torque, cross(convert.triple(request.reference_point), force))
    if frame is not IDENTITY:
        pose = link.pose.inverse() * frame
        force, torque = rotate(pose.orientation, force), rotate(pose.orientation, torque)
        torque = add(torque, cross(pose.position, force))
    world.forces.wrenches.append(Wrench(link, force, torque, _span(world, request)))
    done(response, "")


@service(names.APPLY_JOINT_EFFORT, ApplyJointEffort)
def apply_joint_effort(simulation: Simulation, request, response) -> None:
    """Effort on a joint, without effect on a fixed one. ServiceError if there is no such joint."""
    world = simulation.world
    model, _, joint = find_joint(world, request.joint_name, "ApplyJointEffort: joint not found")
    check_sane("ApplyJointEffort: effort", request.effort)
    if joint is not None:
        world.forces.efforts.append(Effort(model, joint, request.effort, _span(world, request)))
    done(response, "ApplyJointEffort: effort set")


@service(names.CLEAR_BODY_WRENCHES, BodyRequest)
def clear_body_wrenches(simulation: Simulation, request, _response) -> None:
    """Clear wrenches on the link with exactly this scoped name; if there are none, no error."""
    simulation.world.forces.drop(lambda job: isinstance(job, Wrench)
                                 and job.link.scoped_name == request.body_name)


@service(names.CLEAR_JOINT_FORCES, JointRequest)
def clear_joint_forces(simulation: Simulation, request, _response) -> None:
    """Clear efforts on all joints with this unscoped name; if there are none, no error."""
    simulation.world.forces.drop(lambda job: isinstance(job, Effort)
                                 and job.joint.name == request.joint_name)


def _span(world: World, request) -> Span:
    """When the force acts; a start in the past means now."""
    return Span(max(request.start_time.to_sec(), world.time), request.duration.to_sec())
