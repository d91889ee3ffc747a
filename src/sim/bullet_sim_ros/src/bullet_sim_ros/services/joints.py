"""Get a joint's position and rate; set its limits, damping and motor."""

from gazebo_msgs.msg import ODEJointProperties
from gazebo_msgs.srv import GetJointProperties, SetJointProperties

from bullet_sim.joint import Joint
from bullet_sim_ros import convert, names
from bullet_sim_ros.services.answers import ServiceError, done, service
from bullet_sim_ros.services.lookup import find_joint
from bullet_sim_ros.simulation import Simulation

USED = ("damping", "hiStop", "loStop", "fmax", "vel")  # of gazebo_msgs/ODEJointProperties
NOT_NEGATIVE = ("erp", "cfm", "stop_erp", "stop_cfm", "fudge_factor", "fmax")


@service(names.GET_JOINT_PROPERTIES, GetJointProperties)
def get_joint_properties(simulation: Simulation, request, response) -> None:
    """Position and rate; as in getJointProperties, type is REVOLUTE and damping is not filled in.

    ServiceError without such a joint.
    """
    _, _, joint = find_joint(simulation.world, request.joint_name,
                             "GetJointProperties: joint not found")
    response.type = response.REVOLUTE
    response.position = [joint.position if joint else 0.0]
    response.rate = [joint.velocity if joint else 0.0]
    done(response, "GetJointProperties: got properties")


@service(names.SET_JOINT_PROPERTIES, SetJointProperties)
def set_joint_properties(simulation: Simulation, request, response) -> None:
    """Empty arrays change nothing; in others the first number counts, as joints have one axis.

    ServiceError if there is no such joint, or a number is impossible.
    """
    _, _, joint = find_joint(simulation.world, request.joint_name,
                             "SetJointProperties: joint not found")
    config = request.ode_joint_config
    _check(config)
    values = {field: getattr(config, field)[0] for field in USED if getattr(config, field)}
    if joint is not None:
        _change(joint, values)
    done(response, "SetJointProperties: properties set")


def _check(config: ODEJointProperties) -> None:
    """ServiceError if any number is impossible, including those that have no effect here."""
    for field in config.__slots__:
        for value in getattr(config, field):
            if not abs(value) <= convert.LARGEST:
                raise ServiceError(f"SetJointProperties: {field} is {value:g}; numbers must be "
                                   f"finite and not beyond {convert.LARGEST:g}")
            if value < 0 and field in NOT_NEGATIVE:
                raise ServiceError(f"SetJointProperties: {field} is {value:g}, which cannot be "
                                   "negative")


def _change(joint: Joint, values: dict[str, float]) -> None:
    now = joint.description
    lower, upper = values.get("loStop", now.lower), values.get("hiStop", now.upper)
    damping = values.get("damping", now.damping)
    if (lower, upper, damping) != (now.lower, now.upper, now.damping):
        joint.change(lower, upper, damping)
    if "fmax" in values or "vel" in values:
        rate, effort = joint.motor
        joint.drive_velocity(values.get("vel", rate), values.get("fmax", effort))
