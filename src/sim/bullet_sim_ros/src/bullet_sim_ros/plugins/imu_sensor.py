"""libgazebo_ros_imu_sensor.so: sensor_msgs/Imu of an IMU sensor, gravity included."""

import numpy as np
from sensor_msgs.msg import Imu as ImuMsg

from bullet_sim.pose import multiply, quaternion_from_rpy
from bullet_sim.sensors.imu import ImuSensor
from bullet_sim_ros import convert
from bullet_sim_ros.plugin_host import PluginContext, SensorPlugin, no_tf_prefix, plugin


@plugin("libgazebo_ros_imu_sensor.so")
class ImuSensorPlugin(SensorPlugin):
    """`gaussianNoise` disturbs the quaternion's components, too. No tf_prefix; no `xyzOffset`."""

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._imu = ImuSensor(context.world, context.link, context.sensor,
                              p.flag("initialOrientationAsReference", False))
        self._offset = quaternion_from_rpy(*p.vector("rpyOffset"))
        super().__init__(context, ImuMsg, p.text("topicName", "imu_data"), p.required("frameName"),
                         namespace=p.namespace(missing=f"/{context.model.name}", empty="/"),
                         tf_prefix=no_tf_prefix, noise=f"{context.sensor_name} plugin")
        self.publish_readings(p.number("updateRateHZ", 1.0))
        context.on_reset(self._imu.restart)

    def measure(self) -> ImuMsg:
        """The sensor's reading now."""
        reading = self._imu.sample()
        values = self.disturbed(np.concatenate([
            multiply(self._offset, reading.orientation), reading.angular_velocity,
            reading.linear_acceleration])).tolist()
        return convert.imu_to_msg(values[:4], values[4:7], values[7:], self.noise ** 2)
