"""The topics and services of one camera."""

from __future__ import annotations

import copy
import logging
from collections.abc import Callable

from sensor_msgs.msg import CameraInfo, Image
from sensor_msgs.srv import SetCameraInfo, SetCameraInfoResponse
from std_msgs.msg import Header

from bullet_sim.sensors.camera import CameraReading
from bullet_sim_ros import convert, names
from bullet_sim_ros.cameras.compressed import CompressedTopic
from bullet_sim_ros.cameras.settings import CameraSettings
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.reconfigure_server import Value, offer_values

log = logging.getLogger("bullet_sim.plugins")

SLOWEST, FASTEST, FIRST_RATE = 1.0, 50.0, 2.0  # Hz; upstream's imager_rate


class CameraTopics:
    """Image, its compressed twin, CameraInfo and set_camera_info.

    What set_camera_info sets holds as long as the camera; it is not written to a file.
    """

    def __init__(self, context: PluginContext, settings: CameraSettings):
        self.settings = settings
        self._profiler = context.world.profiler
        self._info = settings.info()
        self._images = context.advertise(settings.image_topic, Image, queue_size=2, latch=True)
        self._compressed = CompressedTopic(context, settings.image_topic, latch=True)
        self._infos = context.advertise(settings.info_topic, CameraInfo, queue_size=2)
        context.serve(names.join(settings.namespace, "set_camera_info"), SetCameraInfo,
                      self._set_info)

    def pictures_wanted(self) -> bool:
        """Whether anybody listens to images."""
        return bool(self._images.get_num_connections()) or self._compressed.wanted()

    def wanted(self) -> bool:
        """Whether anybody listens to images or camera_info."""
        return self.pictures_wanted() or bool(self._infos.get_num_connections())

    def publish(self, reading: CameraReading) -> None:
        """Send a picture on the image topic, and compressed if somebody wants that."""
        settings = self.settings
        with self._profiler.measure("send"):
            self._images.publish(convert.image_to_msg(
                reading.rgb, reading.time, settings.frame, settings.encoding, self._profiler))
        if self._compressed.wanted():
            with self._profiler.measure("compress"):
                self._compressed.publish(reading.rgb, settings.encoding, reading.time,
                                         settings.frame)

    def publish_info(self, time: float) -> None:
        """Send what belongs to a picture of that time (s) to those who listen."""
        if self._infos.get_num_connections():
            self._infos.publish(self.info(time))

    def info(self, time: float) -> CameraInfo:
        """The calibration with a stamp."""
        info = copy.copy(self._info)
        info.header = Header(stamp=convert.stamp(time), frame_id=self.settings.frame)
        return info

    def _set_info(self, request) -> SetCameraInfoResponse:
        """In a ROS thread."""
        self._info = request.camera_info
        return SetCameraInfoResponse(success=True)


def offer_rate(
    context: PluginContext, settings: CameraSettings, change: Callable[[float], None]
) -> None:
    """dynamic_reconfigure's `imager_rate` (Hz); `change` is called in the loop's thread.

    It begins as 2 whatever the sensor's rate is, and counts from the first change on, as upstream.
    """
    if not settings.camera_name:
        log.warning("%s: without a <cameraName> there is no dynamic_reconfigure for %s",
                    context.describe(), settings.image_topic)
        return
    begun: list[bool] = []

    def changed(values: dict[str, float]) -> None:
        """In a ROS thread; at once for the first time."""
        if begun:
            context.services.mailbox.post(lambda: change(values["imager_rate"]))
        begun.append(True)

    rate = Value(FIRST_RATE, SLOWEST, FASTEST, "Rate of the sensor, Hz")
    offer_values(context, settings.namespace, {"imager_rate": rate}, changed)
