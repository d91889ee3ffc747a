"""ackermann_steering_controller: one driven rear wheel and one steered front wheel."""

import math

from bullet_sim.control.controllers.ackermann_steering_controller import (
    AckermannGeometry,
    AckermannSteering,
)
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.mobile_base import MobileBaseController, read_options
from bullet_sim_ros.control.registry import controller


@controller("ackermann_steering_controller/AckermannSteeringController",
            "steer_drive_controller/SteerDriveController")
class AckermannSteeringController(MobileBaseController):
    """angular.z of cmd_vel is the steering joint's angle, as upstream has it.

    steer_drive_controller is what upstream called it before; its parameters are the same.
    """

    def __init__(self, context: ControllerContext):
        p = context.parameters
        rear = p.text("rear_wheel", "rear_wheel_joint")
        front = p.text("front_steer", "front_steer_joint")
        super().__init__(context, AckermannSteering(
            context.claim("velocity", rear), context.claim("position", front),
            _geometry(context, rear, front), read_options(p)))


def _geometry(context: ControllerContext, rear: str, front: str) -> AckermannGeometry:
    """Parameters, else the URDF; times the multipliers."""
    p, robot = context.parameters, context.robot
    wheelbase = p.number("wheel_separation_h") if p.has("wheel_separation_h") else math.dist(
        robot.pose(rear).position, robot.pose(front).position)
    radius = p.number("wheel_radius") if p.has("wheel_radius") else robot.wheel_radius(rear)
    return AckermannGeometry(wheelbase * p.number("wheel_separation_h_multiplier", 1.0),
                             radius * p.number("wheel_radius_multiplier", 1.0),
                             p.number("steer_pos_multiplier", 1.0))
