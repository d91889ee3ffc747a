"""libgazebo_ros_joint_state_publisher.so: joint_states of a list of joints."""

from __future__ import annotations

import logging

from sensor_msgs.msg import JointState

from bullet_sim.errors import SimulationError
from bullet_sim.joint import Joint, PassiveJoint
from bullet_sim.sensors.joint_states import sample_joints
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin

log = logging.getLogger("bullet_sim.plugins")


@plugin("libgazebo_ros_joint_state_publisher.so")
class JointStatePublisherPlugin:
    """A name that is no joint is left out with an error line (upstream crashes on it).

    Without `jointName` the messages are empty, as upstream's are.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._world = context.world
        namespace = p.namespace(missing=context.model.name, empty=context.model.name)
        wanted = p.text("jointName").replace(" ", "").split(",")
        found = [_find_joint(context, name.strip()) for name in wanted if name.strip()]
        self._joints = [joint for joint in found if joint is not None]
        self._states = context.advertise(names.join(namespace, "joint_states"), JointState,
                                         queue_size=1000)
        context.every(
            p.number("updateRate", 100.0), self._publish, self._states.get_num_connections
        )

    def _publish(self) -> None:
        self._states.publish(convert.joints_to_msg(sample_joints(self._world, self._joints)))


def _find_joint(context: PluginContext, name: str) -> Joint | PassiveJoint | None:
    try:
        return context.model.joint(name)
    except SimulationError as error:
        log.error("%s: %s", context.describe(), error)
        return None
