"""four_wheel_steering_controller: four wheels, each driven and each steered."""

import logging
import math
from collections.abc import Callable

from roslib.message import get_message_class

from bullet_sim.control.controllers.four_wheel_steering_controller import (
    FourWheelGeometry,
    FourWheelSteering,
)
from bullet_sim_ros import convert
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.mobile_base import MobileBaseController, read_options
from bullet_sim_ros.control.registry import controller
from bullet_sim_ros.errors import PluginError

log = logging.getLogger("bullet_sim.control")
MESSAGE = "four_wheel_steering_msgs/FourWheelSteering"


@controller("four_wheel_steering_controller/FourWheelSteeringController")
class FourWheelSteeringController(MobileBaseController):
    """cmd_vel, and cmd_four_wheel_steering where that message's package is there."""

    def __init__(self, context: ControllerContext):
        wheels = _pair(context, "front_wheel") + _pair(context, "rear_wheel")
        steering = _pair(context, "front_steering") + _pair(context, "rear_steering")
        self._drive = FourWheelSteering([context.claim("velocity", name) for name in wheels],
                                        [context.claim("position", name) for name in steering],
                                        _geometry(context, wheels, steering),
                                        read_options(context.parameters))
        super().__init__(context, self._drive)
        message = get_message_class(MESSAGE)
        if message is None:
            log.warning("%s: no package has %s, so cmd_four_wheel_steering is not there; cmd_vel "
                        "is", context.describe(), MESSAGE)
        else:
            self.subscribe("cmd_four_wheel_steering", message, self._take_axles)

    def _take_axles(self, msg) -> Callable[[], None] | None:
        command = msg.speed, msg.front_steering_angle, msg.rear_steering_angle
        if not all(abs(value) <= convert.LARGEST for value in command):
            self.refuse(f"not finite, or beyond {convert.LARGEST:g},")
            return None
        return lambda: self._drive.command_axles(self.context.world_time(), *command)


def _pair(context: ControllerContext, parameter: str) -> list[str]:
    """The left and the right joint of an axle."""
    names = context.parameters.texts(parameter)
    if len(names) != 2:
        raise PluginError(
            f"parameter {context.parameters.where(parameter)} has {len(names)} joints; "
            "an axle has two, left and right"
        )
    return names


def _geometry(
    context: ControllerContext, wheels: list[str], steering: list[str]
) -> FourWheelGeometry:
    """Parameters, else the URDF."""
    p, robot = context.parameters, context.robot

    def length(parameter: str, first: str, second: str) -> float:
        return p.number(parameter) if p.has(parameter) else math.dist(
            robot.pose(first).position, robot.pose(second).position)

    radius = p.number("wheel_radius") if p.has("wheel_radius") else robot.wheel_radius(wheels[0])
    return FourWheelGeometry(length("track", steering[0], steering[1]),
                             length("wheel_base", wheels[0], wheels[2]), radius)
