"""ackermann_steering_controller: one driven rear wheel and one steered front wheel."""

from bullet_sim.control.controllers.ackermann_steering_controller import (
    AckermannGeometry,
    AckermannSteering,
)
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.mobile_base import (
    MobileBaseController,
    read_distance,
    read_options,
    read_wheel_radius,
)
from bullet_sim_ros.control.registry import controller


@controller("ackermann_steering_controller/AckermannSteeringController",
            "steer_drive_controller/SteerDriveController")
class AckermannSteeringController(MobileBaseController):
    """angular.z of cmd_vel is the steering joint's angle, rad.

    So it is in ackermann_steering_controller.cpp, AckermannSteeringController::update.
    steer_drive_controller is the older name in ros_controllers, with the same parameters.
    """

    def __init__(self, context: ControllerContext):
        p = context.parameters
        rear = p.text("rear_wheel", "rear_wheel_joint")
        front = p.text("front_steer", "front_steer_joint")
        super().__init__(context, AckermannSteering(
            context.claim("velocity", rear), context.claim("position", front),
            _geometry(context, rear, front), read_options(p)))


def _geometry(context: ControllerContext, rear: str, front: str) -> AckermannGeometry:
    """From parameters, else from the URDF; times the multipliers."""
    p, robot = context.parameters, context.robot
    wheelbase = read_distance(p, robot, "wheel_separation_h", rear, front)
    radius = read_wheel_radius(p, robot, rear)
    return AckermannGeometry(wheelbase * p.number("wheel_separation_h_multiplier", 1.0),
                             radius * p.number("wheel_radius_multiplier", 1.0),
                             p.number("steer_pos_multiplier", 1.0))
