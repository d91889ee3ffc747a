"""libgazebo_ros_joint_state_publisher.so: joint_states of a list of joints."""

import logging

from sensor_msgs.msg import JointState

from bullet_sim.errors import SimulationError
from bullet_sim.joint import Joint, PassiveJoint
from bullet_sim.sensors.joint_states import sample_joints
from bullet_sim_ros import convert
from bullet_sim_ros.plugin_host import PluginContext, SensorPlugin, no_tf_prefix, plugin

log = logging.getLogger("bullet_sim.plugins")


@plugin("libgazebo_ros_joint_state_publisher.so")
class JointStatePublisherPlugin(SensorPlugin):
    """A name that is not a joint is skipped with an error line; it makes Gazebo crash.

    Without `jointName` the messages are empty (gazebo_ros_joint_state_publisher.cpp).
    """

    def __init__(self, context: PluginContext):
        p, model = context.parameters, context.model.name
        super().__init__(context, JointState, "joint_states", "", tf_prefix=no_tf_prefix,
                         namespace=p.namespace(missing=model, empty=model), queue_size=1000)
        names = p.text("jointName").replace(" ", "").split(",")
        self._joints: list[Joint | PassiveJoint] = []
        for name in filter(None, map(str.strip, names)):
            try:
                self._joints.append(context.model.joint(name))
            except SimulationError as error:
                log.error("%s: %s", context.describe(), error)
        self.publish_at(p.number("updateRate", 100.0), whole_steps=False)

    def measure(self) -> JointState:
        """Positions and rates now."""
        return convert.joints_to_msg(sample_joints(self.world, self._joints))
