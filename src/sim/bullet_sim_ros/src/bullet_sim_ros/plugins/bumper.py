"""libgazebo_ros_bumper.so: gazebo_msgs/ContactsState of a contact sensor."""

from __future__ import annotations

from gazebo_msgs.msg import ContactsState, ContactState
from geometry_msgs.msg import Vector3, Wrench

from bullet_sim.sensors.contact import ContactSensor, TouchingPair
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin


@plugin("libgazebo_ros_bumper.so")
class BumperPlugin:
    """In world axes, whatever `frameName` says; empty `states` while nothing touches.

    The sensor's own collision always comes first (upstream's order is the engine's).
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._world = context.world
        self._sensor = ContactSensor(context.world, context.link, context.sensor)
        namespace = p.namespace(missing="/", empty="/")
        self._frame = names.frame(params.own_tf_prefix(namespace), p.text("frameName", "world"))
        topic = names.join(namespace, p.text("bumperTopicName", "bumper_states"))
        self._contacts = context.advertise(topic, ContactsState, queue_size=1)
        context.every(context.sensor.update_rate, self._measure, self._contacts.get_num_connections)

    def _measure(self) -> None:
        pairs = self._sensor.sample()
        msg = ContactsState(states=[
            self._state(pair, index, len(pairs)) for index, pair in enumerate(pairs)])
        msg.header.stamp, msg.header.frame_id = convert.stamp(self._world.time), self._frame
        self._contacts.publish(msg)

    def _state(self, pair: TouchingPair, index: int, count: int) -> ContactState:
        state = ContactState(collision1_name=pair.own, collision2_name=pair.other)
        state.info = (f"Debug:  i:({index}/{count})     my geom:{pair.own}   "
                      f"other geom:{pair.other}         time:{self._world.time:.9f}\n")
        state.wrenches = [_wrench(force, torque)
                          for force, torque in zip(pair.forces, pair.torques, strict=True)]
        state.total_wrench = _wrench(_sum(pair.forces), _sum(pair.torques))
        state.contact_positions = [Vector3(*position) for position in pair.positions]
        state.contact_normals = [Vector3(*normal) for normal in pair.normals]
        state.depths = list(pair.depths)
        return state


def _wrench(force, torque) -> Wrench:
    return Wrench(Vector3(*force), Vector3(*torque))


def _sum(vectors: list) -> list[float]:
    return [sum(parts) for parts in zip(*vectors, strict=True)]
