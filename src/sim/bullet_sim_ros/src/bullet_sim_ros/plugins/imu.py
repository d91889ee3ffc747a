"""libgazebo_ros_imu.so, of a link and without gravity, and libgazebo_ros_imu_sensor.so, with it."""

import numpy as np
from sensor_msgs.msg import Imu as ImuMsg
from std_srvs.srv import Empty, EmptyResponse

from bullet_sim.errors import UnknownName
from bullet_sim.link import Link
from bullet_sim.pose import conjugate, multiply, quaternion_from_rpy, rotate
from bullet_sim.sensors.imu import ImuSensor, LinkMotion
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugin_host import PluginContext, SensorPlugin, no_tf_prefix, plugin


@plugin("libgazebo_ros_imu.so")
class ImuPlugin(SensorPlugin):
    """Rates and accelerations are in the link's axes; UpdateChild rotates them the wrong way.

    `xyzOffset` has no effect, as in UpdateChild. No tf_prefix.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        link = _find_link(context, p.required("bodyName"))
        self._imu = LinkMotion(context.world, link)
        self._offset = quaternion_from_rpy(*p.vector("rpyOffset"))
        super().__init__(context, ImuMsg, p.topic("/default_imu"), p.text("frameName", link.name),
                         tf_prefix=no_tf_prefix,
                         noise=f"{link.scoped_name}::{context.description.name}")
        service = names.join(self.namespace, p.text("serviceName", "/default_imu"))
        context.serve(service, Empty, lambda _request: EmptyResponse())
        self.publish_at(p.number("updateRate", 0.0))
        context.on_reset(self._imu.restart)

    def measure(self) -> ImuMsg:
        """The link's orientation, angular velocity and acceleration now."""
        reading = self._imu.sample()
        back = conjugate(reading.orientation)
        values = self.disturbed(np.concatenate([
            rotate(back, reading.world_angular_velocity),
            rotate(back, reading.world_acceleration)])).tolist()
        return convert.imu_to_msg(multiply(self._offset, reading.orientation), values[:3],
                                  values[3:], self.noise ** 2)


def _find_link(context: PluginContext, name: str) -> Link:
    """A link of the model, else of any model in the world (gazebo_ros_imu.cpp, LoadThread)."""
    try:
        return context.model.link(name)
    except UnknownName as here:
        try:
            return context.world.link(name)
        except UnknownName:
            raise here from None


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
