"""What the drives publish about where they are: a topic and a transform."""

from __future__ import annotations

from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry

from bullet_sim.sensors.odometry import OdometryReading
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugin_host.context import PluginContext


class OdometryOutput:
    """Odometry of a plugin; the topic's height may be left at 0 while the transform has it."""

    def __init__(
        self,
        context: PluginContext,
        namespace: str,
        base_frame: str = "base_footprint",
        *,
        transform: bool = True,
        flat: bool = False,
        variances: tuple[float, float, float] = convert.DRIVE_VARIANCES,
        twist_variances: tuple[float, float, float] | None = None,
    ):
        p = context.parameters
        self.prefix = params.tf_prefix(namespace)
        self._services = context.services
        self._odom_frame = names.frame(self.prefix, p.text("odometryFrame", "odom"))
        self._base_frame = names.frame(self.prefix, p.text("robotBaseFrame", base_frame))
        self._transform, self._flat = transform, flat
        self.variances, self.twist_variances = variances, twist_variances
        self._topic = context.advertise(names.join(namespace, p.text("odometryTopic", "odom")),
                                        Odometry, queue_size=1)
        if transform:
            context.services.announce_transforms()

    def wanted(self) -> bool:
        """Whether anybody listens."""
        return bool(self._topic.get_num_connections()) or self._services.transforms_wanted()

    def publish(self, reading: OdometryReading, others: tuple[TransformStamped, ...] = ()) -> None:
        """Send topic and transform, and other transforms with it."""
        msg = convert.odometry_to_msg(reading, self._odom_frame, self._base_frame, self.variances)
        if self._flat:
            msg.pose.pose.position.z = 0.0
        if self.twist_variances:
            msg.twist.covariance = convert.planar_covariance(*self.twist_variances)
        self._topic.publish(msg)
        transforms = list(others)
        if self._transform:
            transforms.append(convert.transform_to_msg(
                reading.pose, reading.time, self._odom_frame, self._base_frame))
        if transforms:
            self._services.send_transforms(transforms)
