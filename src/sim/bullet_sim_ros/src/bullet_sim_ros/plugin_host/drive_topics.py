"""What drives share: commands from a topic; odometry and transforms out, and their source."""

from collections.abc import Callable, Sequence

from geometry_msgs.msg import TransformStamped, Twist
from nav_msgs.msg import Odometry

from bullet_sim.joint import Joint
from bullet_sim.model import Model
from bullet_sim.plugin_tags import LoggedParameters, PluginParameters
from bullet_sim.sensors.odometry import OdometryReading, WheelOdometry, true_odometry
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugin_host.context import PluginContext


def subscribe_commands(context: PluginContext, namespace: str, topic: str,
                       command: Callable[[Twist], None], queue_size: int = 1) -> None:
    """Subscribe, and call `command(message)` in the loop; refuses messages with bad numbers."""
    def take(message: Twist) -> Callable[[], None] | None:
        return None if context.refuses("command", message) else lambda: command(message)

    context.subscribe(names.join(namespace, topic), Twist, take, queue_size=queue_size,
                      tcp_nodelay=True)


class OdometrySource:
    """The true pose (`world`), or the rotation of a left and a right wheel (`encoder`)."""

    def __init__(self, context: PluginContext, p: LoggedParameters, wheels: Sequence[Joint],
                 encoders: WheelOdometry):
        self._world, self._model = context.world, context.model
        self._left, self._right = wheels
        self._encoders = encoders
        self._true = p.choice("odometrySource", ("world", "encoder")) == "world"
        if not self._true:
            context.each_step(self._count)

    def sample(self) -> OdometryReading:
        """Pose and twist now."""
        if self._true:
            return true_odometry(self._world, self._model)
        return self._encoders.sample()

    def restart(self) -> None:
        """Set the encoders to zero."""
        self._encoders.restart(self._world.time)

    def _count(self) -> None:
        self._encoders.update(self._world.time, self._left.velocity, self._right.velocity)


class OdometryOutput:
    """nav_msgs/Odometry and the transform of the same pose, published to subscribers.

    `flat`: z is 0 on the topic, but not in the transform. Covariances are 6x6, row by row.
    """

    def __init__(self, context: PluginContext, topic: str, odom_frame: str, base_frame: str, *,
                 transform: bool = True, flat: bool = False,
                 pose_covariance: Sequence[float] = convert.DRIVE_COVARIANCE,
                 twist_covariance: Sequence[float] | None = None, queue_size: int = 1):
        self._host = context.host
        self._odom_frame, self._base_frame, self._flat = odom_frame, base_frame, flat
        self.pose_covariance, self.twist_covariance = pose_covariance, twist_covariance
        self._topic = context.advertise(topic, Odometry, queue_size=queue_size)
        self.set_transform(transform)

    def set_transform(self, wanted: bool) -> None:
        """Set whether the transform is sent."""
        self._transform = wanted
        if wanted:
            self._host.announce_transforms()

    def wanted(self) -> bool:
        """Whether anybody listens."""
        return bool(self._topic.get_num_connections()) or self._host.transforms_wanted()

    def publish(self, reading: OdometryReading, others: Sequence[TransformStamped] = ()) -> None:
        """Publish on the topic, and send the transform together with `others`."""
        if self._topic.get_num_connections():
            self._topic.publish(self._message(reading))
        transforms = [*others]
        if self._transform:
            transforms.insert(0, convert.transform_to_msg(
                reading.pose, reading.time, self._odom_frame, self._base_frame))
        if transforms and self._host.transforms_wanted():
            self._host.send_transforms(transforms)

    def _message(self, reading: OdometryReading) -> Odometry:
        msg = convert.odometry_to_msg(reading, self._odom_frame, self._base_frame)
        msg.pose.covariance = self.pose_covariance
        if self.twist_covariance is not None:
            msg.twist.covariance = self.twist_covariance
        if self._flat:
            msg.pose.pose.position.z = 0.0
        return msg


def open_odometry(context: PluginContext, namespace: str, base_frame: str = "base_footprint",
                  tags: LoggedParameters | PluginParameters | None = None,
                  **options) -> OdometryOutput:
    """Open the output of `<odometryTopic>`, `<odometryFrame>` and `<robotBaseFrame>`.

    `options` are those of OdometryOutput.
    """
    p, prefix = tags or context.parameters, params.tf_prefix(namespace)
    return OdometryOutput(
        context, names.join(namespace, p.text("odometryTopic", "odom")),
        names.frame(prefix, p.text("odometryFrame", "odom")),
        names.frame(prefix, p.text("robotBaseFrame", base_frame)), **options)


def wheel_transform(model: Model, joint: Joint, time: float, prefix: str,
                    frame: str) -> TransformStamped:
    """The wheel's pose in the model, with the joint's parent link as header frame.

    So it is in gazebo_ros_diff_drive.cpp, publishWheelTF.
    """
    pose = model.pose.inverse() * model.links[joint.description.child].pose
    return convert.transform_to_msg(pose, time, names.frame(prefix, joint.description.parent),
                                    names.frame(prefix, frame))
