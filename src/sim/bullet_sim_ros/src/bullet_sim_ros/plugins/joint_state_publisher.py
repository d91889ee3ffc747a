"""libgazebo_ros_joint_state_publisher.so: joint_states of a list of joints."""

from __future__ import annotations

import logging

from sensor_msgs.msg import JointState

from bullet_sim.sensors.joint_states import sample_joints
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugins.host import Host
from bullet_sim_ros.plugins.registry import plugin

log = logging.getLogger("bullet_sim.plugins")


@plugin("libgazebo_ros_joint_state_publisher.so")
class JointStatePublisherPlugin:
    """A name that is no joint is left out with an error line (upstream crashes on it)."""

    def __init__(self, host: Host):
        p = host.parameters
        self._world = host.world
        namespace = p.namespace(missing=host.model.name, empty=host.model.name)
        wanted = [name.strip() for name in p.text("jointName").split(",") if name.strip()]
        self._joints = [host.model.joints[name] for name in wanted if name in host.model.joints]
        for name in wanted:
            if name not in host.model.joints:
                log.error("model %s: joint_state_publisher: no joint named %r; there are: %s",
                          host.model.name, name, ", ".join(host.model.joints))
        self._states = host.advertise(names.join(namespace, "joint_states"), JointState,
                                      queue_size=1000)
        host.every(p.number("updateRate", 100.0), self._publish, self._states.get_num_connections)

    def _publish(self) -> None:
        self._states.publish(convert.joints_to_msg(sample_joints(self._world, self._joints)))
