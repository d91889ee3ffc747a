"""four_wheel_steering_controller: four wheels, each driven and each steered."""

import logging
from collections.abc import Callable

from roslib.message import get_message_class

from bullet_sim.control.controllers.four_wheel_steering_controller import (
    FourWheelGeometry,
    FourWheelSteering,
)
from bullet_sim_ros import convert
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.mobile_base import (
    MobileBaseController,
    read_distance,
    read_options,
    read_wheel_radius,
)
from bullet_sim_ros.control.registry import controller

log = logging.getLogger("bullet_sim.control")
MESSAGE = "four_wheel_steering_msgs/FourWheelSteering"


@controller("four_wheel_steering_controller/FourWheelSteeringController")
class FourWheelSteeringController(MobileBaseController):
    """Takes cmd_vel, and cmd_four_wheel_steering if its message's package is installed."""

    def __init__(self, context: ControllerContext):
        wheels, steering = (
            [name for axle in ("front", "rear") for name in context.parameters.pair(
                f"{axle}_{kind}", "an axle has two, left and right")]
            for kind in ("wheel", "steering"))
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
        if not convert.is_sane(command):
            self.refuse(f"not finite, or beyond {convert.LARGEST:g},")
            return None
        return lambda: self._drive.command_axles(self.context.world_time(), *command)


def _geometry(
    context: ControllerContext, wheels: list[str], steering: list[str]
) -> FourWheelGeometry:
    """From parameters, else from the URDF."""
    p, robot = context.parameters, context.robot
    return FourWheelGeometry(read_distance(p, robot, "track", steering[0], steering[1]),
                             read_distance(p, robot, "wheel_base", wheels[0], wheels[2]),
                             read_wheel_radius(p, robot, wheels[0]))
