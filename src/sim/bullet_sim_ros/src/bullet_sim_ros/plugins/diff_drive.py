"""libgazebo_ros_diff_drive.so: cmd_vel in; odometry, tf and wheel joint states out."""

from __future__ import annotations

import logging
from collections.abc import Callable

from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState

from bullet_sim.drives.diff_drive import DiffDrive, DiffDriveParameters, turns_backwards
from bullet_sim.joint import Joint
from bullet_sim.sensors.joint_states import sample_joints
from bullet_sim.sensors.odometry import OdometryReading, WheelOdometry
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.logged_parameters import LoggedParameters
from bullet_sim_ros.plugin_host.odometry_source import OdometrySource
from bullet_sim_ros.plugin_host.registry import plugin

log = logging.getLogger("bullet_sim.plugins")


@plugin("libgazebo_ros_diff_drive.so")
class DiffDrivePlugin:
    """Publishes first, then moves the wheels, as upstream does; there is no command time-out."""

    def __init__(self, context: PluginContext):
        self._context = context
        namespace = context.parameters.namespace(
            missing=context.model.name, empty=context.model.name
        )
        p = LoggedParameters(context.parameters, "DiffDrive", namespace)
        self._joints = self._wheels(p.text("leftJoint", "left_joint"),
                                    p.text("rightJoint", "right_joint"))
        geometry = DiffDriveParameters(
            p.number("wheelSeparation", 0.34), p.number("wheelDiameter", 0.15),
            p.number("wheelAcceleration", 0.0), p.number("wheelTorque", 5.0),
        )
        driven = self._as_driven(p.label, geometry)
        self._drive = DiffDrive(*driven, geometry)
        self._odometry_source = OdometrySource(context, p, driven, WheelOdometry(
            geometry.wheel_separation, geometry.wheel_diameter))
        self._updated = context.world.time
        self._publish_tf = p.flag("publishTf", True)
        self._publish_odom_tf = p.flag("publishOdomTF", True)
        self._publish_wheel_tf = p.flag("publishWheelTF", False)
        if self._publish_tf and (self._publish_odom_tf or self._publish_wheel_tf):
            context.services.announce_transforms()
        prefix = params.tf_prefix(namespace)
        self._odom_frame = names.frame(prefix, p.text("odometryFrame", "odom"))
        self._base_frame = names.frame(prefix, p.text("robotBaseFrame", "base_footprint"))
        self._prefix = prefix
        self._label = p.label
        self._open_topics(namespace, p.text("commandTopic", "cmd_vel"),
                          p.text("odometryTopic", "odom"), p.flag("publishWheelJointState", False))
        context.every(p.number("updateRate", 100.0), self._update)
        context.on_reset(self._restart)

    def _wheels(self, left: str, right: str) -> tuple[Joint, Joint]:
        return self._context.model.joint(left), self._context.model.joint(right)

    def _as_driven(self, label: str, geometry: DiffDriveParameters) -> tuple[Joint, Joint]:
        """The wheels as left and right of the law: swapped for files from before Melodic.

        Indigo to Lunar swapped them unless <legacyMode> was false, so files of that time call the
        right wheel left. Noetic, which does not read the tag, turns such robots the wrong way.
        """
        left, right = self._joints
        links = self._context.model.links
        if not self._context.parameters.flag("legacyMode", True) or not turns_backwards(
                *((joint, links[joint.description.child].pose) for joint in self._joints),
                geometry):
            return left, right
        log.warning("%s: <leftJoint> %s is the right wheel, seen where it drives to: taken as "
                    "written for Indigo to Lunar, whose <legacyMode> swapped the two; to turn as "
                    "told by Melodic and Noetic say <legacyMode>false</legacyMode>",
                    label, left.name)
        return right, left

    def _open_topics(self, namespace: str, command: str, odometry: str, joints: bool) -> None:
        context = self._context
        log.info("%s: Try to subscribe to %s", self._label, command)
        self._odometry = context.advertise(names.join(namespace, odometry), Odometry, queue_size=10)
        self._states = context.advertise(
            names.join(namespace, "joint_states"), JointState, queue_size=1000,
        ) if joints else None
        context.subscribe(names.join(namespace, command), Twist, self._take_command, queue_size=1,
                          tcp_nodelay=True)
        log.info("%s: Subscribe to %s", self._label, command)
        log.info("%s: Advertise odom on %s", self._label, odometry)

    def _take_command(self, msg: Twist) -> Callable[[], None] | None:
        if self._context.refuses("command", msg):
            return None
        return lambda: self._drive.command(msg.linear.x, msg.angular.z)

    def _update(self) -> None:
        world = self._context.world
        if self._states:
            reading = sample_joints(world, self._joints)
            self._states.publish(convert.joints_to_msg(reading, velocities=False))
        if self._publish_tf and self._heard():
            self._publish(self._odometry_source.sample())
        self._drive.update(world.time - self._updated)
        self._updated = world.time

    def _heard(self) -> bool:
        services = self._context.services
        return bool(self._odometry.get_num_connections()) or services.transforms_wanted()

    def _publish(self, reading: OdometryReading) -> None:
        """Upstream's publishTf switches the odometry topic as well as the transforms."""
        self._odometry.publish(
            convert.odometry_to_msg(reading, self._odom_frame, self._base_frame))
        transforms = []
        if self._publish_odom_tf:
            transforms.append(convert.transform_to_msg(reading.pose, reading.time,
                                                       self._odom_frame, self._base_frame))
        if self._publish_wheel_tf:
            transforms += [self._wheel_transform(joint, reading.time) for joint in self._joints]
        if transforms:
            self._context.services.send_transforms(transforms)

    def _wheel_transform(self, joint: Joint, time: float):
        """The wheel seen from the model, and told as if seen from its parent link: upstream's."""
        model = self._context.model
        parent, child = joint.description.parent, joint.description.child
        pose = model.pose.inverse() * model.links[child].pose
        return convert.transform_to_msg(pose, time, names.frame(self._prefix, parent),
                                        names.frame(self._prefix, child))

    def _restart(self) -> None:
        self._drive.stop()
        self._odometry_source.restart()
        self._updated = self._context.world.time
