"""libgazebo_ros_imu_sensor.so: sensor_msgs/Imu of an IMU sensor, gravity included."""

from __future__ import annotations

import numpy as np
from sensor_msgs.msg import Imu as ImuMsg

from bullet_sim.pose import multiply, quaternion_from_rpy
from bullet_sim.sensors.imu import ImuReading, ImuSensor
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin


@plugin("libgazebo_ros_imu_sensor.so")
class ImuSensorPlugin:
    """`gaussianNoise` disturbs the quaternion's components, too. No tf_prefix; no `xyzOffset`."""

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._world = context.world
        self._imu = ImuSensor(context.world, context.link, context.sensor,
                              p.flag("initialOrientationAsReference", False))
        self._frame = names.frame("", p.required("frameName"))
        self._offset = quaternion_from_rpy(*p.vector("rpyOffset"))
        self._noise = p.deviation("gaussianNoise")
        self._random_name = f"{context.link.scoped_name}::{context.sensor.name} plugin"
        namespace = p.namespace(missing=f"/{context.model.name}", empty="/")
        topic = names.join(namespace, p.text("topicName", "imu_data"))
        self._readings = context.advertise(topic, ImuMsg, queue_size=1)
        context.every_reading(p.number("updateRateHZ", 1.0), self._measure,
                              self._readings.get_num_connections)
        context.on_reset(self._imu.restart)

    def _measure(self) -> None:
        reading = self._imu.sample()
        values = np.concatenate([multiply(self._offset, reading.orientation),
                                 reading.angular_velocity, reading.linear_acceleration])
        if self._noise:
            values = values + self._world.random(self._random_name).normal(0.0, self._noise, 10)
        values = values.tolist()
        self._readings.publish(convert.imu_to_msg(
            ImuReading(reading.time, values[:4], values[4:7], values[7:]),
            self._frame, self._noise ** 2))
