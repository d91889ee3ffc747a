"""libhector_gazebo_ros_imu.so: sensor_msgs/Imu with gravity, and the errors of a cheap IMU."""

from __future__ import annotations

import math

import numpy as np
from geometry_msgs.msg import Quaternion, Vector3
from hector_gazebo_plugins.srv import SetBias, SetBiasResponse
from sensor_msgs.msg import Imu as ImuMsg
from std_srvs.srv import Empty, EmptyResponse

from bullet_sim.pose import conjugate, multiply, quaternion_from_rpy, rotate
from bullet_sim.sensors.error_model import attitude_error
from bullet_sim.sensors.link_motion import LinkMotion
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin
from bullet_sim_ros.plugins.hector import common


@plugin("libhector_gazebo_ros_imu.so")
class HectorImuPlugin:
    """In the link's axes; the accelerometer's bias tilts the orientation, yaw's turns it.

    `heading...` tags, of older releases, mean what `yaw...` mean. `randomEngineSeed` is not needed.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._world = context.world
        link = common.find_link(context)
        self._imu = LinkMotion(context.world, link)
        self._frame = names.frame("", p.text("frameId", link.name))
        self._offset = quaternion_from_rpy(*p.vector("rpyOffset"))
        self._accel = common.HectorError(context, "accel", 3, "accel")
        self._rate = common.HectorError(context, "rate", 3, "rate")
        self._yaw = common.HectorError(context, "yaw", 1, "heading", "yaw")
        self._set_common_noise(p.deviation("gaussianNoise"))
        self._stopwatch = common.Stopwatch(context)
        topic = common.topic_of(context, "imu")
        self._readings = self._biases = None
        if topic:
            self._readings = context.advertise(topic, ImuMsg, queue_size=10)
            bias = common.topic_of(context, f"{topic}/bias", "biasTopicName")
            if bias:
                self._biases = context.advertise(bias, ImuMsg, queue_size=10)
            for name, error in (("accel", self._accel), ("rate", self._rate), ("yaw", self._yaw)):
                error.offer(f"{topic}/{name}")
            self._serve(context, topic)
            context.every(common.update_rate(p, 0.0), self._measure, self._wanted)
            context.on_reset(self._imu.restart)

    def _set_common_noise(self, noise: float) -> None:
        """`gaussianNoise` replaces those of accelerometer and gyroscope."""
        if noise:
            for error in (self._accel, self._rate):
                error.parameters = common.with_noise(error.parameters, noise)

    def _serve(self, context: PluginContext, topic: str) -> None:
        """Calibration forgets the gyroscope's drift; the others set a bias."""
        def setter(error: common.HectorError):
            def set_bias(request: SetBias._request_class) -> SetBiasResponse:
                bias = np.array([request.bias.x, request.bias.y, request.bias.z])
                context.services.mailbox.call(lambda: error.set_drift(bias))
                return SetBiasResponse()
            return set_bias

        def calibrate(_request) -> EmptyResponse:
            context.services.mailbox.call(lambda: self._rate.set_drift(np.zeros(3)))
            return EmptyResponse()

        calibration = common.topic_of(context, f"{topic}/calibrate", "serviceName")
        if calibration:
            context.serve(calibration, Empty, calibrate)
        context.serve(f"{topic}/set_accel_bias", SetBias, setter(self._accel))
        context.serve(f"{topic}/set_rate_bias", SetBias, setter(self._rate))

    def _wanted(self) -> bool:
        """A drift goes on whether or not anybody listens."""
        return (any(error.drifts for error in (self._accel, self._rate, self._yaw))
                or self._heard(self._readings) or self._heard(self._biases))

    @staticmethod
    def _heard(publisher) -> bool:
        return publisher is not None and bool(publisher.get_num_connections())

    def _measure(self) -> None:
        reading, elapsed = self._imu.sample(), self._stopwatch.lap()
        gravity = np.array(self._world.description.gravity)
        orientation = multiply(self._offset, reading.orientation)
        felt = rotate(conjugate(orientation), reading.world_acceleration - gravity)
        body_rate = rotate(conjugate(reading.orientation), reading.world_angular_velocity)
        acceleration = self._accel.apply(np.array(felt), elapsed)
        rate = self._rate.apply(np.array(rotate(conjugate(self._offset), body_rate)), elapsed)
        self._yaw.update(elapsed)
        strength = math.hypot(*gravity)
        error = attitude_error(np.array(rotate(reading.orientation, self._accel.bias)),
                               float(self._yaw.bias[0]), strength)
        msg = _message(multiply(error, orientation), rate, acceleration)
        msg.header.stamp, msg.header.frame_id = convert.stamp(reading.time), self._frame
        self._fill_covariances(msg, strength)
        if self._heard(self._readings):
            self._readings.publish(msg)
        if self._heard(self._biases):
            bias = _message(error, self._rate.bias, self._accel.bias)
            bias.header = msg.header
            self._biases.publish(bias)

    def _fill_covariances(self, msg: ImuMsg, gravity: float) -> None:
        rates, accelerations, (yaw,) = (
            [value ** 2 for value in error.parameters.gaussian_noise]
            for error in (self._rate, self._accel, self._yaw))
        level = [value / gravity ** 2 if gravity else -1.0 for value in accelerations[:2]]
        msg.orientation_covariance = _diagonal(*level, yaw)
        msg.angular_velocity_covariance = _diagonal(*rates)
        msg.linear_acceleration_covariance = _diagonal(*accelerations)


def _diagonal(x: float, y: float, z: float) -> list[float]:
    return [x, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, z]


def _message(orientation, rate: np.ndarray, acceleration: np.ndarray) -> ImuMsg:
    msg = ImuMsg(orientation=Quaternion(*orientation))
    msg.angular_velocity = Vector3(*rate.tolist())
    msg.linear_acceleration = Vector3(*acceleration.tolist())
    return msg
