"""libgazebo_ros_skid_steer_drive.so: cmd_vel in; four wheels, odometry and tf out."""

from geometry_msgs.msg import Twist

from bullet_sim.drives.diff_drive import DiffDrive, DiffDriveParameters
from bullet_sim.sensors.odometry import true_odometry
from bullet_sim_ros import convert
from bullet_sim_ros.plugin_host import PluginContext, open_odometry, plugin, subscribe_commands


@plugin("libgazebo_ros_skid_steer_drive.so")
class SkidSteerDrivePlugin:
    """There is no time-out; a reset of the simulation stops the robot.

    gazebo_ros_skid_steer_drive.cpp has neither a time-out nor a Reset: the robot drives on.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._context = context
        namespace = p.namespace(missing="/", empty="/")
        left, right = (
            [context.model.joint(p.text(f"{side}{place}Joint", f"{side}_{place.lower()}_joint"))
             for place in ("Front", "Rear")] for side in ("left", "right"))
        parameters = DiffDriveParameters(
            p.number("wheelSeparation", 0.4), p.number("wheelDiameter", 0.15),
            wheel_torque=p.number("torque", 5.0))
        self._axles = [DiffDrive(*wheels, parameters) for wheels in zip(left, right, strict=True)]
        covariance = convert.planar_covariance(
            p.number("covariance_x", 1e-4), p.number("covariance_y", 1e-4),
            p.number("covariance_yaw", 1e-2))
        self._output = open_odometry(
            context, namespace, transform=p.flag("broadcastTF", False), flat=True,
            pose_covariance=covariance, twist_covariance=covariance)
        subscribe_commands(context, namespace, p.text("commandTopic", "cmd_vel"), self._command)
        context.every(p.number("updateRate", 100.0), self._update)
        context.on_reset(self._stop)

    def _command(self, msg: Twist) -> None:
        for axle in self._axles:
            axle.command(msg.linear.x, msg.angular.z)

    def _stop(self) -> None:
        for axle in self._axles:
            axle.stop()

    def _update(self) -> None:
        if self._output.wanted():
            self._output.publish(true_odometry(self._context.world, self._context.model))
        for axle in self._axles:
            axle.update(0.0)  # s; they follow the command at once
