"""One or two cameras of a sensor that take their pictures together, at a rate or when told to."""

from __future__ import annotations

import math

from std_msgs.msg import Empty

from bullet_sim_ros.cameras.camera_publisher import CameraPublisher
from bullet_sim_ros.cameras.topics import offer_rate
from bullet_sim_ros.plugin_host.context import PluginContext

DEFAULT_RATE = 30.0  # Hz, where neither sensor nor plugin names one (Gazebo: as fast as it can)


class CameraGroup:
    """Who listens to images of one of the cameras has all drawn, as upstream counts subscribers.

    For camera_info alone nothing is drawn (upstream draws).
    """

    def __init__(self, context: PluginContext, cameras: list[CameraPublisher]):
        self._context = context
        self._cameras = cameras
        self._told = False

    def capture_at_rate(self) -> None:
        """At the sensor's rate, thinned to the plugin's, while somebody listens."""
        context, thinned_hz = self._context, self._cameras[0].settings.rate_hz
        context.every(
            pictures_rate(context.sensor.update_rate, thinned_hz), self._take, self._wanted
        )
        for camera in self._cameras:
            offer_rate(context, camera.settings, lambda rate_hz: context.change_rate(
                pictures_rate(rate_hz, thinned_hz)))

    def capture_on_trigger(self) -> None:
        """At the step after a message on a trigger topic, if somebody listens then.

        Several messages before the picture are one. Rates have no effect.
        """
        for camera in self._cameras:
            topic = camera.settings.topic("triggerTopicName", "image_trigger")
            self._context.subscribe(topic, Empty, lambda _message: self._tell, queue_size=1)
            offer_rate(self._context, camera.settings, lambda _rate_hz: None)
        self._context.every(0.0, self._look_once, lambda: self._told)

    def _tell(self) -> None:
        self._told = True

    def _look_once(self) -> None:
        self._told = False
        if self._wanted():
            self._take()

    def _wanted(self) -> bool:
        return any(camera.topics.wanted() for camera in self._cameras)

    def _take(self) -> None:
        pictures = any(camera.topics.pictures_wanted() for camera in self._cameras)
        if pictures:
            self._context.expect_answer()
        states = [camera.capture() for camera in self._cameras]

        def send() -> None:
            for camera, state in zip(self._cameras, states, strict=True):
                camera.send(state, pictures)

        self._context.draw(send)


def pictures_rate(sensor_hz: float, plugin_hz: float) -> float:
    """The sensor's `<update_rate>`, thinned to the plugin's `<updateRate>`; 0: there is none.

    As upstream has it, only whole pictures can be left out: 30 Hz thinned to 20 is 15.
    """
    if sensor_hz > 0 and plugin_hz > 0:
        return sensor_hz / max(1, math.ceil(sensor_hz / plugin_hz - 1e-9))
    return max(sensor_hz, plugin_hz) or DEFAULT_RATE
