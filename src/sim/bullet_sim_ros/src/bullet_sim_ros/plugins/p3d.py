"""libgazebo_ros_p3d.so: nav_msgs/Odometry of a link's true pose and twist."""

from nav_msgs.msg import Odometry

from bullet_sim.pose import Pose, quaternion_from_rpy
from bullet_sim.sensors.odometry import GroundTruth
from bullet_sim_ros import convert
from bullet_sim_ros.plugin_host import PluginContext, SensorPlugin, plugin

INERTIAL = ("world", "/world", "map", "/map")


@plugin("libgazebo_ros_p3d.so")
class P3dPlugin(SensorPlugin):
    """With another link as frame, the twist is the true one relative to that link.

    The offsets are in the link's axes, so that those of a lumped link are right in any pose.
    gazebo_ros_p3d.cpp, UpdateChild, rotates that twist the wrong way, and adds the offsets in the
    world's axes.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        link = context.model.link(p.required("bodyName"))
        topic, frame = p.required("topicName"), p.text("frameName", "world")
        reference = None if frame in INERTIAL else context.model.link(frame)
        offset = Pose(p.vector("xyzOffset"), quaternion_from_rpy(*p.vector("rpyOffset")))
        self._truth = GroundTruth(context.world, link, offset, reference)
        self._child = link.name
        super().__init__(context, Odometry, topic, frame,
                         noise=f"{link.scoped_name}::{context.description.name}")
        self.publish_at(p.number("updateRate", 0.0))

    def measure(self) -> Odometry:
        """Pose and twist now."""
        reading = self._truth.sample()
        msg = Odometry(child_frame_id=self._child)
        msg.pose.pose = convert.pose_to_msg(reading.pose)
        msg.twist.twist = convert.twist_to_msg(reading.twist)
        if self.noise:
            self._disturb(msg)
        return msg

    def _disturb(self, msg: Odometry) -> None:
        noise = self.random().normal(0.0, self.noise, 6).tolist()
        linear, angular = msg.twist.twist.linear, msg.twist.twist.angular
        for vector, values in ((linear, noise[:3]), (angular, noise[3:])):
            vector.x, vector.y, vector.z = (
                value + more for value, more in zip((vector.x, vector.y, vector.z), values,
                                                    strict=True))
        msg.pose.covariance = msg.twist.covariance = convert.diagonal([self.noise ** 2] * 6)
