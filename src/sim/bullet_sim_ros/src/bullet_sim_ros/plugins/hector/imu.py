"""libhector_gazebo_ros_imu.so: sensor_msgs/Imu with gravity, and the errors of a cheap IMU."""

import math

import numpy as np
from hector_gazebo_plugins.srv import SetBias, SetBiasResponse
from sensor_msgs.msg import Imu as ImuMsg
from std_srvs.srv import Empty, EmptyResponse

from bullet_sim.pose import conjugate, multiply, quaternion_from_rpy, rotate
from bullet_sim.sensors.error_model import ErrorModel, attitude_error
from bullet_sim.sensors.imu import LinkMotion
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugin_host import PluginContext, plugin
from bullet_sim_ros.plugins.hector import common


@plugin("libhector_gazebo_ros_imu.so")
class HectorImuPlugin(common.HectorSensor):
    """Measures in the link's axes; the accelerometer's bias tilts the orientation, yaw's turns it.

    `heading...` tags of older releases mean the same as `yaw...`. `randomEngineSeed` is not used.
    """

    def __init__(self, context: PluginContext):
        p, link = context.parameters, common.find_link(context)
        self._imu = LinkMotion(context.world, link)
        super().__init__(context, ImuMsg, "imu", link.name)
        self._offset = quaternion_from_rpy(*p.vector("rpyOffset"))
        self._accel = self.add_error("accel", 3, "accel")
        self._rate = self.add_error("rate", 3, "rate")
        self._yaw = self.add_error("yaw", 1, "heading", "yaw")
        self._set_common_noise(p.deviation("gaussianNoise"))
        if self.topic:
            self._biases = self.advertise(
                ImuMsg, p.topic(f"{self.topic}/bias", "biasTopicName"), queue_size=10)
            for name, error in (("accel", self._accel), ("rate", self._rate), ("yaw", self._yaw)):
                self.offer(error, name)
            self._serve(context, names.join(self.namespace, self.topic))
            self.begin(0.0)
            context.on_reset(self._imu.restart)

    def _set_common_noise(self, noise: float) -> None:
        """`gaussianNoise` replaces the noise of accelerometer and gyroscope."""
        if noise:
            for error in (self._accel, self._rate):
                error.parameters = common.with_noise(error.parameters, noise)

    def _serve(self, context: PluginContext, topic: str) -> None:
        """Offer services: calibration clears the gyroscope's drift, the others set a bias."""
        def setter(error: ErrorModel):
            def set_bias(request: SetBias._request_class) -> SetBiasResponse:
                bias = np.array(convert.triple(request.bias))
                context.host.mailbox.call(lambda: error.set_drift(bias))
                return SetBiasResponse()
            return set_bias

        def calibrate(_request) -> EmptyResponse:
            context.host.mailbox.call(lambda: self._rate.set_drift(np.zeros(3)))
            return EmptyResponse()

        calibration = context.parameters.topic(f"{topic}/calibrate", "serviceName")
        if calibration:
            context.serve(names.join(self.namespace, calibration), Empty, calibrate)
        context.serve(f"{topic}/set_accel_bias", SetBias, setter(self._accel))
        context.serve(f"{topic}/set_rate_bias", SetBias, setter(self._rate))

    def measure(self) -> ImuMsg:
        """The reading now; publishes the biases, too."""
        reading, elapsed = self._imu.sample(), self.elapsed()
        gravity = np.array(self.world.description.gravity)
        orientation = multiply(self._offset, reading.orientation)
        felt = rotate(conjugate(orientation), reading.world_acceleration - gravity)
        body_rate = rotate(conjugate(reading.orientation), reading.world_angular_velocity)
        acceleration = self._accel.apply(np.array(felt), elapsed)
        rate = self._rate.apply(np.array(rotate(conjugate(self._offset), body_rate)), elapsed)
        self._yaw.update(elapsed)
        strength = math.hypot(*gravity)
        error = attitude_error(np.array(rotate(reading.orientation, self._accel.bias)),
                               float(self._yaw.bias[0]), strength)
        msg = convert.imu_to_msg(multiply(error, orientation), rate.tolist(),
                                 acceleration.tolist())
        self._fill_covariances(msg, strength)
        if self._biases:
            self._biases.publish(self.stamped(convert.imu_to_msg(
                error, self._rate.bias.tolist(), self._accel.bias.tolist())))
        return msg

    def _fill_covariances(self, msg: ImuMsg, gravity: float) -> None:
        rates, accelerations, (yaw,) = (
            [value ** 2 for value in error.parameters.gaussian_noise]
            for error in (self._rate, self._accel, self._yaw))
        level = [value / gravity ** 2 if gravity else -1.0 for value in accelerations[:2]]
        msg.orientation_covariance = convert.diagonal((*level, yaw))
        msg.angular_velocity_covariance = convert.diagonal(rates)
        msg.linear_acceleration_covariance = convert.diagonal(accelerations)
