"""libgazebo_ros_force.so: the last Wrench that came acts on a link at every step."""

from __future__ import annotations

from collections.abc import Callable

from geometry_msgs.msg import Wrench

from bullet_sim_ros import names
from bullet_sim_ros.plugin_host.context import Host
from bullet_sim_ros.plugin_host.registry import plugin

NONE = (0.0, 0.0, 0.0)


@plugin("libgazebo_ros_force.so")
class ForcePlugin:
    """World axes, at the centre of mass; for ever, until another one comes."""

    def __init__(self, host: Host):
        p = host.parameters
        self._host = host
        self._link = host.model.link(p.required("bodyName"))
        self._force = self._torque = NONE  # N, N m
        topic = names.join(p.namespace(missing="/", empty="/"), p.required("topicName"))
        host.subscribe(topic, Wrench, self._take, queue_size=1)
        host.each_step(self._push)

    def _take(self, msg: Wrench) -> Callable[[], None] | None:
        if self._host.refuses("wrench", msg.force, msg.torque):
            return None
        return lambda: self._set(msg)

    def _set(self, msg: Wrench) -> None:
        self._force = (msg.force.x, msg.force.y, msg.force.z)
        self._torque = (msg.torque.x, msg.torque.y, msg.torque.z)
        self._push()

    def _push(self) -> None:
        if any(self._force) or any(self._torque):
            self._link.apply_force(self._force, self._torque)
