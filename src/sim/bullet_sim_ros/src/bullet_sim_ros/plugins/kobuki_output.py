"""What a Kobuki base tells of itself all the time: joints, odometry, gyroscope."""

from __future__ import annotations

import numpy as np
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, JointState

from bullet_sim.drives.kobuki import Kobuki
from bullet_sim.sensors.imu import ImuReading
from bullet_sim.sensors.joint_states import sample_joints
from bullet_sim.sensors.odometry import OdometryReading
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugin_host.context import PluginContext

POSE_VARIANCES = (0.1, 0.1, 1e6, 1e6, 1e6, 0.05)  # m^2 and rad^2
GYRO_VARIANCES = (1e6, 1e6, 0.05)


class KobukiOutput:
    """Frames are odom, base_footprint and base_link, with the tf_prefix."""

    def __init__(
        self, context: PluginContext, kobuki: Kobuki, namespace: str, base: str, transform: bool
    ):
        self._context, self._kobuki, self._transform = context, kobuki, transform
        prefix = params.tf_prefix(namespace)
        self._odom, self._footprint, self._base_link = (
            names.frame(prefix, name) for name in ("odom", "base_footprint", "base_link"))
        self._states = context.advertise(names.join(namespace, "joint_states"), JointState,
                                         queue_size=1)
        self._odometry = context.advertise(names.join(namespace, "odom"), Odometry, queue_size=1)
        self._imu = context.advertise(names.join(base, "sensors/imu_data"), Imu, queue_size=1)
        if transform:
            context.services.announce_transforms()

    def publish(self) -> None:
        """What somebody listens to."""
        reading = self._kobuki.odometry()
        if self._states.get_num_connections():
            msg = convert.joints_to_msg(sample_joints(self._context.world, self._kobuki.wheels))
            msg.header.frame_id, msg.effort = self._base_link, [0.0, 0.0]
            self._states.publish(msg)
        if self._odometry.get_num_connections():
            self._odometry.publish(self._odometry_msg(reading))
        if self._transform and self._context.services.transforms_wanted():
            self._context.services.send_transforms([convert.transform_to_msg(
                reading.pose, reading.time, self._odom, self._footprint)])
        if self._imu.get_num_connections():
            self._imu.publish(self._imu_msg(self._kobuki.imu_reading()))

    def _odometry_msg(self, reading: OdometryReading) -> Odometry:
        msg = convert.odometry_to_msg(reading, self._odom, self._footprint)
        msg.pose.covariance = np.diag(POSE_VARIANCES).ravel().tolist()
        return msg

    def _imu_msg(self, reading: ImuReading) -> Imu:
        msg = convert.imu_to_msg(reading, self._base_link, 0.0)
        covariance = np.diag(GYRO_VARIANCES).ravel().tolist()
        msg.orientation_covariance = msg.angular_velocity_covariance = covariance
        return msg
