"""libgazebo_ros_camera.so: images and their CameraInfo while somebody listens."""

from __future__ import annotations

import logging
import time

import rospy
from sensor_msgs.msg import CameraInfo, Image

from bullet_sim.description import CameraDescription
from bullet_sim.sensors.camera import Camera, CameraReading, Exposure
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugins.host import Host
from bullet_sim_ros.plugins.parameters import PluginParameters
from bullet_sim_ros.plugins.registry import plugin

log = logging.getLogger("bullet_sim.plugins")

DEFAULT_RATE = 30.0  # Hz, where neither sensor nor plugin names one (Gazebo: as fast as it can)
LONGEST_TRIAL = 0.2  # s, wall: a slow renderer is tried once


class CameraSettings:
    """The tags that all cameras share, and the messages made from them."""

    def __init__(self, host: Host, description: CameraDescription):
        p: PluginParameters = host.parameters
        self._description = description
        self._stages = host.world.stages
        self.namespace = names.join(p.namespace(missing="/", empty=host.model.name),
                                    p.text("cameraName"))
        self.frame = names.frame(params.tf_prefix(self.namespace), p.text("frameName"))
        self.image_topic = names.join(self.namespace, p.text("imageTopicName", "image_raw"))
        self.info_topic = names.join(self.namespace, p.text("cameraInfoTopicName", "camera_info"))
        self.sensor_rate_hz = host.sensor.update_rate
        self.plugin_rate_hz = p.number("updateRate", 0.0)
        self.encoding = convert.ENCODINGS.get(description.format)
        if self.encoding is None:
            log.error("model %s: sensor %s: image format %s is not supported; there are %s; rgb8 "
                      "is used", host.model.name, host.sensor.name, description.format,
                      ", ".join(convert.ENCODINGS))
            self.encoding = "rgb8"
        self._intrinsics = {
            "centre_x": p.number("Cx", 0.0),
            "centre_y": p.number("Cy", 0.0),
            "focal_length": p.number("focalLength", 0.0),
            "baseline": p.number("hackBaseline", 0.0),
            "distortion": tuple(
                p.number(f"distortion{tag}", 0.0) for tag in ("K1", "K2", "T1", "T2", "K3")),
        }

    def publish(self, publisher: rospy.Publisher, reading: CameraReading) -> None:
        """Send the picture."""
        with self._stages.measure("send"):
            publisher.publish(convert.image_to_msg(
                reading.rgb, reading.time, self.frame, self.encoding, self._stages))

    def info(self, time: float) -> CameraInfo:
        """What belongs to a picture taken at `time`."""
        return convert.camera_info_to_msg(self._description, time, self.frame, **self._intrinsics)


def tell_frame_time(host: Host, camera: Camera, topic: str) -> None:
    """Log what a picture of this camera costs to draw; by the drawing thread, before the first."""
    exposure = camera.expose()

    def measure() -> None:
        camera.develop(exposure)  # the first one also loads what there is to see
        took = []
        while len(took) < 3 and sum(took) < LONGEST_TRIAL:
            start = time.perf_counter()
            camera.develop(exposure)
            took.append(time.perf_counter() - start)
        view = exposure.view
        line = f"camera {topic} ({view.width}x{view.height}): {min(took) * 1e3:.1f} ms a frame"
        host.shared.mailbox.leave(lambda: rospy.loginfo("%s", line))

    host.shared.drawing.submit(measure)


@plugin("libgazebo_ros_camera.so")
class CameraPlugin:
    """Draws only while image or camera_info has a subscriber."""

    def __init__(self, host: Host):
        self._host = host
        self._camera = Camera(host.world, host.link, host.sensor, host.shared.drawing.renderer())
        self._settings = settings = CameraSettings(host, self._camera.description)
        rates = [rate for rate in (settings.sensor_rate_hz, settings.plugin_rate_hz) if rate > 0]
        self._images = host.advertise(settings.image_topic, Image, queue_size=2, latch=True)
        self._infos = host.advertise(settings.info_topic, CameraInfo, queue_size=2)
        host.every(min(rates, default=DEFAULT_RATE), self._take, self._wanted)
        tell_frame_time(host, self._camera, settings.image_topic)

    def _wanted(self) -> bool:
        return bool(self._images.get_num_connections() or self._infos.get_num_connections())

    def _take(self) -> None:
        if self._images.get_num_connections():
            self._host.expect_answer()
        exposure = self._camera.expose()
        self._host.draw(lambda: self._send(exposure))

    def _send(self, exposure: Exposure) -> None:
        """In the drawing thread."""
        if self._images.get_num_connections():
            self._settings.publish(self._images, self._camera.develop(exposure))
        if self._infos.get_num_connections():
            self._infos.publish(self._settings.info(exposure.time))
