"""mecanum_drive_controller: four wheels with rollers, which drive forward, sideways and turn."""

import logging

from geometry_msgs.msg import Twist

from bullet_sim.control.controllers.mecanum_drive_controller import MecanumDrive, MecanumGeometry
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.mobile_base import (
    MobileBaseController,
    read_distance,
    read_limits,
    read_options,
    read_wheel_radius,
)
from bullet_sim_ros.control.registry import controller

log = logging.getLogger("bullet_sim.control")

CORNERS = ("front_left", "back_left", "back_right", "front_right")


@controller("mecanum_drive_controller/MecanumDriveController")
class MecanumDriveController(MobileBaseController):
    """cmd_vel's linear.y is the speed to the left."""

    def __init__(self, context: ControllerContext):
        p = context.parameters
        wheels = [_joint(context, corner) for corner in CORNERS]
        self._drive = MecanumDrive(
            [context.claim("velocity", name) for name in wheels], _geometry(context, wheels),
            read_options(p), read_limits(p, "linear/y"))
        super().__init__(context, self._drive)
        if not all(context.robot.joints_on(name) for name in wheels):
            log.warning("%s: its wheels have no rollers (links on passive joints), so they drive "
                        "forward and turn, but do not go sideways; a base without rollers is moved "
                        "by libgazebo_ros_planar_move.so", context.describe())

    def apply_command(self, msg: Twist) -> None:
        """Pass a checked command to the drive; in the loop."""
        self._drive.command(self.context.world_time(), msg.linear.x, msg.angular.z, msg.linear.y)


def _joint(context: ControllerContext, corner: str) -> str:
    """The joint of a wheel; some forks call it rear, not back."""
    p = context.parameters
    other = f"{corner.replace('back', 'rear')}_wheel_joint"
    return p.text(other) if p.has(other) else p.text(f"{corner}_wheel_joint")


def _geometry(context: ControllerContext, wheels: list[str]) -> MecanumGeometry:
    """From parameters, else the URDF (mecanum_drive_controller.cpp, setWheelParamsFromUrdf)."""
    p, robot = context.parameters, context.robot
    length = read_distance(p, robot, "wheel_separation_x", wheels[0], wheels[1], axis=0)
    width = read_distance(p, robot, "wheel_separation_y", wheels[0], wheels[3], axis=1)
    realigned = p.flag("use_realigned_roller_joints", False)
    touching = (realigned and robot.joints_on(wheels[0])) or wheels
    return MecanumGeometry((length + width) / 2, read_wheel_radius(p, robot, touching[0]))
