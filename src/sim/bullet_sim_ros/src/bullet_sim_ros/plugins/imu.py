"""libgazebo_ros_imu.so: sensor_msgs/Imu of a link, gravity left out as upstream does."""

from __future__ import annotations

import dataclasses

from sensor_msgs.msg import Imu as ImuMsg
from std_srvs.srv import Empty, EmptyResponse

from bullet_sim.pose import conjugate, multiply, quaternion_from_rpy, rotate
from bullet_sim.sensors.imu import Imu, ImuReading
from bullet_sim_ros import convert, names
from bullet_sim_ros.errors import PluginError
from bullet_sim_ros.plugins.host import Host
from bullet_sim_ros.plugins.registry import plugin


@plugin("libgazebo_ros_imu.so")
class ImuPlugin:
    """Rates and accelerations are in the link's axes (upstream turns them the wrong way round)."""

    def __init__(self, host: Host):
        p = host.parameters
        namespace = p.namespace(missing="/", empty="/")
        link = host.model.link(p.required("bodyName"))
        self._world = host.world
        self._imu = Imu(host.world, link)
        self._frame = names.frame("", p.text("frameName", link.name))
        self._offset = quaternion_from_rpy(*p.vector("rpyOffset"))
        self._noise = p.number("gaussianNoise", 0.0)
        if self._noise < 0:
            raise PluginError(f"<gaussianNoise> is {self._noise}, and a deviation is not negative")
        self._random_name = f"{link.scoped_name}::{host.description.name}"
        topic = names.join(namespace, p.text("topicName", "/default_imu"))
        service = names.join(namespace, p.text("serviceName", "/default_imu"))
        self._readings = host.advertise(topic, ImuMsg, queue_size=1)
        host.serve(service, Empty, lambda _request: EmptyResponse())
        host.every(p.number("updateRate", 0.0), self._measure, self._readings.get_num_connections)
        host.on_reset(self._imu.restart)

    def _measure(self) -> None:
        reading = self._with_noise(self._in_link_axes(self._imu.sample()))
        self._readings.publish(convert.imu_to_msg(reading, self._frame, self._noise ** 2))

    def _in_link_axes(self, reading: ImuReading) -> ImuReading:
        back = conjugate(reading.orientation)
        return dataclasses.replace(
            reading,
            orientation=multiply(self._offset, reading.orientation),
            angular_velocity=rotate(back, reading.angular_velocity),
            linear_acceleration=rotate(back, reading.linear_acceleration),
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
