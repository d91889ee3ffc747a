"""Bases moved by force: hector's force_based_move and three libraries derived from it."""

import math
from dataclasses import dataclass
from pathlib import PurePosixPath

from geometry_msgs.msg import Twist

from bullet_sim.drives.force_based_move import ForceDrive, ForceGains
from bullet_sim_ros import convert
from bullet_sim_ros.plugin_host import PluginContext, open_odometry, plugin, subscribe_commands

VARIANCE = 1e-3  # m^2
YAW_VARIANCES = (0.01, 100.0)  # rad^2: going straight, and turning
STRAIGHT = 1e-4  # rad/s


@dataclass(frozen=True)
class Family:
    """What differs between the libraries: their defaults, and the tag of a time-out if any."""

    gains: ForceGains = ForceGains()
    transform: bool = True
    timeout_tag: str = ""
    timeout: float = math.inf  # s


FAMILIES = {
    "libhector_gazebo_ros_force_based_move.so": Family(),
    "libwpr_plugin.so": Family(ForceGains(40000.0, 30000.0, 500.0)),
    "libridgeback_ros_force_based_move.so": Family(
        ForceGains(100000.0, 100000.0, 10000.0), False, "cmdVelTimeOut", 0.25),
    "librobotnik_force_based_move.so": Family(timeout_tag="commandWatchdog", timeout=2.0),
}


@plugin("libhector_gazebo_ros_force_based_move.so", "libwpr_plugin.so",
        "libridgeback_ros_force_based_move.so", "librobotnik_force_based_move.so")
class ForceBasedMovePlugin:
    """Odometry starts at zero where the model is spawned, and does not account for collisions."""

    def __init__(self, context: PluginContext):
        p = context.parameters
        family = FAMILIES[PurePosixPath(context.description.filename).name]
        namespace = p.namespace(missing="/", empty="/")
        gains = ForceGains(p.number("x_velocity_p_gain", family.gains.forward),
                           p.number("y_velocity_p_gain", family.gains.leftward),
                           p.number("yaw_velocity_p_gain", family.gains.yaw))
        timeout = (p.bound(family.timeout_tag, family.timeout) if family.timeout_tag
                   else family.timeout)
        link = context.model.link(p.text("robotBaseFrame", "base_footprint"))
        self._drive = ForceDrive(context.world, link, gains, timeout)
        self._output = open_odometry(
            context, namespace, transform=p.flag("publishOdometryTf", family.transform))
        subscribe_commands(context, namespace, p.text("commandTopic", "cmd_vel"), self._command)
        context.each_step(self._drive.update)
        rate_hz = p.number("odometryRate", 20.0)
        if rate_hz > 0:
            context.every(rate_hz, self._publish, self._output.wanted)
        context.on_reset(self._drive.reset)

    def _command(self, msg: Twist) -> None:
        self._drive.command(msg.linear.x, msg.linear.y, msg.angular.z)

    def _publish(self) -> None:
        reading = self._drive.odometry()
        yaw = YAW_VARIANCES[abs(reading.yaw_rate) >= STRAIGHT]
        covariance = convert.planar_covariance(VARIANCE, VARIANCE, yaw)
        self._output.pose_covariance = self._output.twist_covariance = covariance
        self._output.publish(reading)
