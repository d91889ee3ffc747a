"""Limits and gains of joints from parameters, and limits from the URDF."""

from collections.abc import Iterable
from dataclasses import replace

from bullet_sim.control.parameters import ControllerParameters
from bullet_sim.control.pid import PidGains
from bullet_sim.description import JointLimits
from bullet_sim.formats.urdf.facts import RobotFacts

GAINS = "gazebo_ros_control/pid_gains"
LIMITS = "joint_limits"
# what joint_limits_interface reads: kind of limit -> its fields here, and the parameters
KINDS = {"position": (("lower", "min_position"), ("upper", "max_position")),
         "velocity": (("velocity", "max_velocity"),),
         "acceleration": (("acceleration", "max_acceleration"),),
         "effort": (("effort", "max_effort"),)}


def read_joint_limits(parameters: ControllerParameters, robot: RobotFacts,
                      joints: Iterable[str]) -> dict[str, JointLimits]:
    """The URDF's limits, overridden by `joint_limits/<joint>/...`."""
    parameters = parameters.group(LIMITS)
    return {
        joint: _overridden(robot.limits(joint) if robot.has_joint(joint) else JointLimits(),
                           parameters, joint)
        for joint in joints
    }


def _overridden(limits: JointLimits, parameters: ControllerParameters, joint: str) -> JointLimits:
    for kind, pairs in KINDS.items():
        switch = f"{joint}/has_{kind}_limits"
        if not parameters.has(switch):
            continue
        for key, name in pairs:
            value = getattr(JointLimits, key)  # no limit
            if parameters.flag(switch):
                value = parameters.number(f"{joint}/{name}")
            limits = replace(limits, **{key: value})
    return limits


def read_joint_gains(parameters: ControllerParameters,
                     joints: Iterable[str]) -> dict[str, PidGains]:
    """The gains of those joints that have any; the others are driven without a PID."""
    parameters = parameters.group(GAINS)
    return {joint: PidGains.from_parameters(parameters, joint) for joint in joints
            if parameters.has(f"{joint}/p")}
