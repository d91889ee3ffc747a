"""libgazebo_ros_imu.so: sensor_msgs/Imu of a link, gravity left out as upstream does."""

from __future__ import annotations

import dataclasses

from sensor_msgs.msg import Imu as ImuMsg
from std_srvs.srv import Empty, EmptyResponse

from bullet_sim.errors import UnknownName
from bullet_sim.link import Link
from bullet_sim.pose import conjugate, multiply, quaternion_from_rpy, rotate
from bullet_sim.sensors.imu import ImuReading
from bullet_sim.sensors.link_motion import LinkMotion, LinkMotionReading
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin


@plugin("libgazebo_ros_imu.so")
class ImuPlugin:
    """Rates and accelerations are in the link's axes (upstream turns them the wrong way round).

    `xyzOffset` moves nothing in upstream either. No tf_prefix.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        namespace = p.namespace(missing="/", empty="/")
        link = _find_link(context, p.required("bodyName"))
        self._world = context.world
        self._imu = LinkMotion(context.world, link)
        self._frame = names.frame("", p.text("frameName", link.name))
        self._offset = quaternion_from_rpy(*p.vector("rpyOffset"))
        self._noise = p.deviation("gaussianNoise")
        self._random_name = f"{link.scoped_name}::{context.description.name}"
        service = names.join(namespace, p.text("serviceName", "/default_imu"))
        context.serve(service, Empty, lambda _request: EmptyResponse())
        topic = p.topic("/default_imu")
        if topic:
            self._readings = context.advertise(names.join(namespace, topic), ImuMsg, queue_size=1)
            context.every(p.number("updateRate", 0.0), self._measure,
                          self._readings.get_num_connections, whole_steps=True)
            context.on_reset(self._imu.restart)

    def _measure(self) -> None:
        reading = self._with_noise(self._in_link_axes(self._imu.sample()))
        self._readings.publish(convert.imu_to_msg(reading, self._frame, self._noise ** 2))

    def _in_link_axes(self, reading: LinkMotionReading) -> ImuReading:
        back = conjugate(reading.orientation)
        return ImuReading(
            reading.time,
            multiply(self._offset, reading.orientation),
            rotate(back, reading.world_angular_velocity),
            rotate(back, reading.world_acceleration),
        )

    def _with_noise(self, reading: ImuReading) -> ImuReading:
        if not self._noise:
            return reading
        noise = self._world.random(self._random_name).normal(0.0, self._noise, 6)
        return dataclasses.replace(
            reading,
            angular_velocity=tuple(reading.angular_velocity + noise[:3]),
            linear_acceleration=tuple(reading.linear_acceleration + noise[3:]),
        )


def _find_link(context: PluginContext, name: str) -> Link:
    """A link of the model, else of any model in the world, as upstream looks it up."""
    try:
        return context.model.link(name)
    except UnknownName as here:
        try:
            return context.world.link(name)
        except UnknownName:
            raise here from None
