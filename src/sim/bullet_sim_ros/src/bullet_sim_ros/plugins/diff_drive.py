"""libgazebo_ros_diff_drive.so: cmd_vel in; odometry, tf and wheel joint states out."""

import logging

from geometry_msgs.msg import Twist
from sensor_msgs.msg import JointState

from bullet_sim.drives.diff_drive import (
    DiffDrive,
    DiffDriveParameters,
    driven_wheels,
    wheels_from_tags,
)
from bullet_sim.plugin_tags import LoggedParameters
from bullet_sim.sensors.joint_states import sample_joints
from bullet_sim.sensors.odometry import WheelOdometry
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugin_host import PluginContext, open_odometry, plugin, subscribe_commands
from bullet_sim_ros.plugin_host.drive_topics import OdometrySource, wheel_transform

log = logging.getLogger("bullet_sim.plugins")


@plugin("libgazebo_ros_diff_drive.so")
class DiffDrivePlugin:
    """Publishes first, then moves the wheels, as gazebo_ros_diff_drive.cpp, UpdateChild, does.

    `commandTimeout` is an addition: the original has no time-out.
    """

    def __init__(self, context: PluginContext):
        self._context = context
        name = context.model.name
        namespace = context.parameters.namespace(missing=name, empty=name)
        p = LoggedParameters(context.parameters, "DiffDrive", namespace)
        self._joints = wheels_from_tags(context.model, p)
        geometry = DiffDriveParameters.from_tags(p)
        driven = driven_wheels(context.model, self._joints, geometry, context.parameters, p.label)
        self._drive = DiffDrive(*driven, geometry)
        self._odometry_source = OdometrySource(context, p, driven, WheelOdometry(
            geometry.wheel_separation, geometry.wheel_diameter))
        self._updated = self._commanded = context.world.time
        # s; 0: never. A missing tag is not logged: the original has no such tag.
        self._timeout = context.parameters.number("commandTimeout", 0.0)
        self._publish_tf = p.flag("publishTf", True)
        odom_tf = p.flag("publishOdomTF", True)
        self._publish_wheel_tf = p.flag("publishWheelTF", False)
        if self._publish_tf and self._publish_wheel_tf:
            context.host.announce_transforms()
        self._prefix = params.tf_prefix(namespace)
        topic = p.text("commandTopic", "cmd_vel")
        log.info("%s: Try to subscribe to %s", p.label, topic)
        subscribe_commands(context, namespace, topic, self._command)
        log.info("%s: Subscribe to %s", p.label, topic)
        self._output = open_odometry(context, namespace, tags=p, queue_size=10,
                                     transform=self._publish_tf and odom_tf)
        log.info("%s: Advertise odom on %s", p.label,
                 context.parameters.text("odometryTopic", "odom"))
        self._states = context.advertise(
            names.join(namespace, "joint_states"), JointState, queue_size=1000,
        ) if p.flag("publishWheelJointState", False) else None
        context.every(p.number("updateRate", 100.0), self._update)
        context.on_reset(self._restart)

    def _command(self, msg: Twist) -> None:
        self._commanded = self._context.world.time
        self._drive.command(msg.linear.x, msg.angular.z)

    def _update(self) -> None:
        """publishTf switches the odometry topic as well as the transforms, as in UpdateChild."""
        world = self._context.world
        if self._states:
            reading = sample_joints(world, self._joints)
            self._states.publish(convert.joints_to_msg(reading, velocities=False))
        if self._publish_tf and self._output.wanted():
            reading, model = self._odometry_source.sample(), self._context.model
            wheels = self._joints if self._publish_wheel_tf else ()
            self._output.publish(reading, [
                wheel_transform(model, joint, reading.time, self._prefix, joint.description.child)
                for joint in wheels])
        if 0 < self._timeout < world.time - self._commanded:
            self._drive.command(0.0, 0.0)
        self._drive.update(world.time - self._updated)
        self._updated = world.time

    def _restart(self) -> None:
        self._drive.stop()
        self._odometry_source.restart()
        self._updated = self._commanded = self._context.world.time
