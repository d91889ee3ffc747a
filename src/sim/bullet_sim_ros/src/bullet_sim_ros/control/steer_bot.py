"""`steer_bot_hardware_gazebo/...`: the joints that a virtual wheel and a virtual steering move."""

from bullet_sim.control.steer_bot import SteerBotGeometry, SteerBotHardware
from bullet_sim.formats.urdf.facts import RobotFacts
from bullet_sim.model import Model
from bullet_sim_ros import names
from bullet_sim_ros.control.joint_parameters import read_joint_limits
from bullet_sim_ros.control.parameters import ControllerParameters
from bullet_sim_ros.errors import PluginError

NAMESPACE = "steer_bot_hardware_gazebo"


def open_steer_bot(model: Model, namespace: str, robot: RobotFacts) -> SteerBotHardware:
    """Upstream's parameters; lengths that are not set are those of the URDF.

    PluginError if a parameter is missing or of the wrong kind.
    """
    p = ControllerParameters(names.join(namespace, NAMESPACE))
    wheels, steers = _pair(p, "virtual_rear_wheels"), _pair(p, "virtual_front_steers")
    geometry = SteerBotGeometry(
        _length(p, "wheel_separation_w", robot, steers[0], steers[1], axis=1),
        _length(p, "wheel_separation_h", robot, wheels[0], steers[0], axis=0),
        p.flag("enable_ackermann_link", True))
    return SteerBotHardware(
        model, p.text("rear_wheel"), p.text("front_steer"), wheels, steers, geometry,
        read_joint_limits(namespace, robot, [*wheels, *steers]))


def _pair(p: ControllerParameters, name: str) -> list[str]:
    found = p.texts(name)
    if len(found) != 2:
        raise PluginError(f"parameter {p.where(name)} has {len(found)} joints; there must be two, "
                          "the right and the left one")
    return found


def _length(p: ControllerParameters, name: str, robot: RobotFacts, first: str,
            second: str, axis: int) -> float:
    """A parameter, or how far two joints lie apart along x (axis 0) or y (1), m."""
    if p.has(name):
        return p.number(name)
    return abs(robot.pose(first).position[axis] - robot.pose(second).position[axis])
