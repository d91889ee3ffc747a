"""One or two cameras of a sensor that take their pictures together, at a rate or when told to."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from std_msgs.msg import Empty

from bullet_sim_ros.cameras.camera_publisher import Eye
from bullet_sim_ros.cameras.topics import offer_rate

if TYPE_CHECKING:
    from bullet_sim_ros.plugin_host.context import Host

DEFAULT_RATE = 30.0  # Hz, where neither sensor nor plugin names one (Gazebo: as fast as it can)


class Eyes:
    """Who listens to images of one of the cameras has all drawn, as upstream counts subscribers.

    For camera_info alone nothing is drawn (upstream draws).
    """

    def __init__(self, host: Host, eyes: list[Eye]):
        self._host = host
        self._eyes = eyes
        self._told = False

    def look_at_rate(self) -> None:
        """At the sensor's rate, thinned to the plugin's, while somebody listens."""
        host, thinned_hz = self._host, self._eyes[0].settings.rate_hz
        host.every(pictures_rate(host.sensor.update_rate, thinned_hz), self._take, self._wanted)
        for eye in self._eyes:
            offer_rate(host, eye.settings, lambda rate_hz: host.change_rate(
                pictures_rate(rate_hz, thinned_hz)))

    def look_when_told(self) -> None:
        """At the step after a message on a trigger topic, if somebody listens then.

        Several messages before the picture are one. Rates have no effect.
        """
        for eye in self._eyes:
            topic = eye.settings.topic("triggerTopicName", "image_trigger")
            self._host.subscribe(topic, Empty, lambda _message: self._tell, queue_size=1)
            offer_rate(self._host, eye.settings, lambda _rate_hz: None)
        self._host.every(0.0, self._look_once, lambda: self._told)

    def _tell(self) -> None:
        self._told = True

    def _look_once(self) -> None:
        self._told = False
        if self._wanted():
            self._take()

    def _wanted(self) -> bool:
        return any(eye.topics.wanted() for eye in self._eyes)

    def _take(self) -> None:
        pictures = any(eye.topics.pictures_wanted() for eye in self._eyes)
        if pictures:
            self._host.expect_answer()
        exposures = [eye.expose() for eye in self._eyes]

        def send() -> None:
            for eye, exposure in zip(self._eyes, exposures, strict=True):
                eye.send(exposure, pictures)

        self._host.draw(send)


def pictures_rate(sensor_hz: float, plugin_hz: float) -> float:
    """The sensor's `<update_rate>`, thinned to the plugin's `<updateRate>`; 0: there is none.

    As upstream has it, only whole pictures can be left out: 30 Hz thinned to 20 is 15.
    """
    if sensor_hz > 0 and plugin_hz > 0:
        return sensor_hz / max(1, math.ceil(sensor_hz / plugin_hz - 1e-9))
    return max(sensor_hz, plugin_hz) or DEFAULT_RATE
