"""libgazebo_ros_ft_sensor.so and libgazebo_ros_f3d.so: geometry_msgs/WrenchStamped."""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import Vector3, WrenchStamped

from bullet_sim.sensors.net_force import NetForce
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin


@plugin("libgazebo_ros_ft_sensor.so")
class FtSensorPlugin:
    """The reaction in a joint, in the child link's frame; `provideFeedback` is not needed."""

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._world = context.world
        self._joint = context.model.joint(p.required("jointName"))
        self._noise = p.deviation("gaussianNoise")
        self._name = f"{context.model.name}::{self._joint.name} wrench"
        namespace = p.namespace(missing="/", empty="/")
        self._frame = names.frame(params.own_tf_prefix(namespace), self._joint.description.child)
        topic = names.join(namespace, p.required("topicName"))
        self._joint.reaction()  # from now on it is measured
        self._wrenches = context.advertise(topic, WrenchStamped, queue_size=1)
        context.every(p.number("updateRate", 0.0), self._measure,
                      self._wrenches.get_num_connections, whole_steps=True)

    def _measure(self) -> None:
        values = np.concatenate(self._joint.reaction())
        if self._noise:
            values = values + self._world.random(self._name).normal(0.0, self._noise, 6)
        self._wrenches.publish(_message(values, self._world.time, self._frame))


@plugin("libgazebo_ros_f3d.so")
class F3dPlugin:
    """What moves a link, gravity and contacts included: m a, in world axes. `frameName` is a label.

    It says `world` whatever is written, as upstream intends; the tf_prefix goes before it.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._world = context.world
        self._net = NetForce(context.world, context.model.link(p.required("bodyName")))
        namespace = p.namespace(missing="/", empty="/")
        self._frame = names.frame(params.own_tf_prefix(namespace), "world")
        topic = names.join(namespace, p.required("topicName"))
        self._wrenches = context.advertise(topic, WrenchStamped, queue_size=1)
        context.every(0.0, self._measure, self._wrenches.get_num_connections)
        context.on_reset(self._net.restart)

    def _measure(self) -> None:
        self._wrenches.publish(_message(self._net.sample(), self._world.time, self._frame))


def _message(values: np.ndarray, time: float, frame: str) -> WrenchStamped:
    """From force and torque, (6,)."""
    msg = WrenchStamped()
    msg.header.stamp, msg.header.frame_id = convert.stamp(time), frame
    numbers = values.tolist()
    msg.wrench.force, msg.wrench.torque = Vector3(*numbers[:3]), Vector3(*numbers[3:])
    return msg
