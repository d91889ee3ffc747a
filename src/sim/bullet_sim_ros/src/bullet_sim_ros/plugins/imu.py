"""libgazebo_ros_imu.so: sensor_msgs/Imu of a link, gravity left out as upstream does."""

from __future__ import annotations

import dataclasses

from sensor_msgs.msg import Imu as ImuMsg
from std_srvs.srv import Empty, EmptyResponse

from bullet_sim.pose import conjugate, multiply, quaternion_from_rpy, rotate
from bullet_sim.schedule import Schedule
from bullet_sim.sensors.imu import Imu, ImuReading
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugins.host import Host
from bullet_sim_ros.plugins.parameters import PluginError
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
        self._random = host.world.random(self._random_name)
        self._schedule = Schedule(p.number("updateRate", 0.0), host.world.timestep)
        self._schedule.restart(host.world.tick)
        topic = names.join(namespace, p.text("topicName", "/default_imu"))
        service = names.join(namespace, p.text("serviceName", "/default_imu"))
        self._readings = host.advertise(topic, ImuMsg, queue_size=1)
        host.serve(service, Empty, lambda _request: EmptyResponse())

    def update(self) -> None:
        """Measure when due and asked for."""
        if not self._schedule.due(self._world.tick) or not self._readings.get_num_connections():
            return
        reading = self._in_link_axes(self._imu.sample())
        self._readings.publish(convert.imu_to_msg(reading, self._frame, self._noise ** 2))

    def _in_link_axes(self, reading: ImuReading) -> ImuReading:
        back = conjugate(reading.orientation)
        return dataclasses.replace(
            reading,
            orientation=multiply(self._offset, reading.orientation),
            angular_velocity=self._noisy(rotate(back, reading.angular_velocity)),
            linear_acceleration=self._noisy(rotate(back, reading.linear_acceleration)),
        )

    def _noisy(self, vector):
        if not self._noise:
            return vector
        return tuple(vector + self._random.normal(0.0, self._noise, 3))

    def reset(self) -> None:
        """Forget the last velocity and draw the noise from the start."""
        self._imu.restart()
        self._random = self._world.random(self._random_name)
        self._schedule.restart(self._world.tick)
