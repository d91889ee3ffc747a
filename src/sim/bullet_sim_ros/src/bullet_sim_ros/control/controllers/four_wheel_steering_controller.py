"""four_wheel_steering_controller: four wheels, each driven and each steered."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable

from roslib.message import get_message_class

from bullet_sim.control.controllers.four_wheel_steering_controller import (
    FourWheelGeometry,
    FourWheelSteering,
)
from bullet_sim_ros import convert
from bullet_sim_ros.control.controller_host import ControllerHost
from bullet_sim_ros.control.mobile_base import MobileBaseController, read_options
from bullet_sim_ros.control.registry import controller
from bullet_sim_ros.errors import PluginError

log = logging.getLogger("bullet_sim.control")
MESSAGE = "four_wheel_steering_msgs/FourWheelSteering"


@controller("four_wheel_steering_controller/FourWheelSteeringController")
class FourWheelSteeringController(MobileBaseController):
    """cmd_vel, and cmd_four_wheel_steering where that message's package is there."""

    def __init__(self, host: ControllerHost):
        wheels = _pair(host, "front_wheel") + _pair(host, "rear_wheel")
        steering = _pair(host, "front_steering") + _pair(host, "rear_steering")
        self._drive = FourWheelSteering([host.claim("velocity", name) for name in wheels],
                                        [host.claim("position", name) for name in steering],
                                        _geometry(host, wheels, steering),
                                        read_options(host.parameters))
        super().__init__(host, self._drive)
        message = get_message_class(MESSAGE)
        if message is None:
            log.warning("%s: no package has %s, so cmd_four_wheel_steering is not there; cmd_vel "
                        "is", host.describe(), MESSAGE)
        else:
            self.subscribe("cmd_four_wheel_steering", message, self._take_axles)

    def _take_axles(self, msg) -> Callable[[], None] | None:
        command = msg.speed, msg.front_steering_angle, msg.rear_steering_angle
        if not all(abs(value) <= convert.LARGEST for value in command):
            self.refuse(f"not finite, or beyond {convert.LARGEST:g},")
            return None
        return lambda: self._drive.command_axles(self.host.world_time(), *command)


def _pair(host: ControllerHost, parameter: str) -> list[str]:
    """The left and the right joint of an axle."""
    names = host.parameters.texts(parameter)
    if len(names) != 2:
        raise PluginError(f"parameter {host.parameters.where(parameter)} has {len(names)} joints; "
                          "an axle has two, left and right")
    return names


def _geometry(host: ControllerHost, wheels: list[str], steering: list[str]) -> FourWheelGeometry:
    """Parameters, else the URDF."""
    p, robot = host.parameters, host.robot

    def length(parameter: str, first: str, second: str) -> float:
        return p.number(parameter) if p.has(parameter) else math.dist(
            robot.pose(first).position, robot.pose(second).position)

    radius = p.number("wheel_radius") if p.has("wheel_radius") else robot.wheel_radius(wheels[0])
    return FourWheelGeometry(length("track", steering[0], steering[1]),
                             length("wheel_base", wheels[0], wheels[2]), radius)
