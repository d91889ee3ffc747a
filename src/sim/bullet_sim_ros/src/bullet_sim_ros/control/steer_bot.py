"""`steer_bot_hardware_gazebo/...`: the joints that a virtual wheel and a virtual steering move."""

from bullet_sim.control.steer_bot import SteerBotGeometry, SteerBotHardware
from bullet_sim.formats.urdf.facts import RobotFacts
from bullet_sim.model import Model
from bullet_sim_ros import names
from bullet_sim_ros.control.controller_parameters import ControllerParameters
from bullet_sim_ros.control.joint_parameters import read_joint_limits
from bullet_sim_ros.control.mobile_base import read_distance

NAMESPACE = "steer_bot_hardware_gazebo"


def open_steer_bot(model: Model, namespace: str, robot: RobotFacts) -> SteerBotHardware:
    """Reads the parameters of steer_bot_hardware_gazebo.cpp, initSim, or lengths from the URDF.

    PluginError if a parameter is missing or of the wrong type; SimulationError if a joint does not
    exist.
    """
    p = ControllerParameters(names.join(namespace, NAMESPACE))
    wheels, steers = (p.pair(name, "there must be two, the right and the left one")
                      for name in ("virtual_rear_wheels", "virtual_front_steers"))
    geometry = SteerBotGeometry(
        read_distance(p, robot, "wheel_separation_w", steers[0], steers[1], axis=1),
        read_distance(p, robot, "wheel_separation_h", wheels[0], steers[0], axis=0),
        p.flag("enable_ackermann_link", True))
    return SteerBotHardware(
        model, p.text("rear_wheel"), p.text("front_steer"), wheels, steers, geometry,
        read_joint_limits(namespace, robot, [*wheels, *steers]))
