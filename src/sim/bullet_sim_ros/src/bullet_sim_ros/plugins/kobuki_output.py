"""What a Kobuki base publishes all the time: joints, odometry, gyroscope."""

from sensor_msgs.msg import Imu, JointState

from bullet_sim.drives.kobuki import Kobuki
from bullet_sim.sensors.imu import ImuReading
from bullet_sim.sensors.joint_states import sample_joints
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugin_host import PluginContext
from bullet_sim_ros.plugin_host.odometry_output import OdometryOutput

POSE_COVARIANCE = convert.diagonal((0.1, 0.1, 1e6, 1e6, 1e6, 0.05))  # m^2 and rad^2
GYRO_COVARIANCE = convert.diagonal((1e6, 1e6, 0.05))


class KobukiOutput:
    """Frames are odom, base_footprint and base_link, with the tf_prefix."""

    def __init__(
        self, context: PluginContext, kobuki: Kobuki, namespace: str, base: str, transform: bool
    ):
        self._context, self._kobuki = context, kobuki
        prefix = params.tf_prefix(namespace)
        odom, footprint, self._base_link = (
            names.frame(prefix, name) for name in ("odom", "base_footprint", "base_link"))
        self._states = context.advertise(names.join(namespace, "joint_states"), JointState,
                                         queue_size=1)
        self._odometry = OdometryOutput(context, names.join(namespace, "odom"), odom, footprint,
                                        transform=transform, pose_covariance=POSE_COVARIANCE)
        self._imu = context.advertise(names.join(base, "sensors/imu_data"), Imu, queue_size=1)

    def publish(self) -> None:
        """What somebody listens to."""
        if self._states.get_num_connections():
            msg = convert.joints_to_msg(sample_joints(self._context.world, self._kobuki.wheels))
            msg.header.frame_id, msg.effort = self._base_link, [0.0, 0.0]
            self._states.publish(msg)
        if self._odometry.wanted():
            self._odometry.publish(self._kobuki.odometry())
        if self._imu.get_num_connections():
            self._imu.publish(self._imu_msg(self._kobuki.imu_reading()))

    def _imu_msg(self, reading: ImuReading) -> Imu:
        msg = convert.imu_to_msg(reading.orientation, reading.angular_velocity,
                                 reading.linear_acceleration)
        msg.orientation_covariance = msg.angular_velocity_covariance = GYRO_COVARIANCE
        return convert.stamped(msg, reading.time, self._base_link)
