"""libgazebo_ros_camera.so: images and their CameraInfo while somebody listens."""

from __future__ import annotations

import logging

from sensor_msgs.msg import CameraInfo, Image

from bullet_sim.description import CameraDescription
from bullet_sim.schedule import Schedule
from bullet_sim.sensors.camera import Camera, CameraReading
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugins.host import Host
from bullet_sim_ros.plugins.parameters import PluginParameters
from bullet_sim_ros.plugins.registry import plugin

log = logging.getLogger("bullet_sim.plugins")

DEFAULT_RATE = 30.0  # Hz, where neither sensor nor plugin names one (Gazebo: as fast as it can)


class CameraSettings:
    """The tags that all cameras share, and the messages made from them."""

    def __init__(self, host: Host, description: CameraDescription):
        p: PluginParameters = host.parameters
        self._description = description
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

    def image(self, reading: CameraReading) -> Image:
        """The picture as a message."""
        return convert.image_to_msg(reading.rgb, reading.time, self.frame, self.encoding)

    def info(self, time: float) -> CameraInfo:
        """What belongs to a picture taken at `time`."""
        return convert.camera_info_to_msg(self._description, time, self.frame, **self._intrinsics)


@plugin("libgazebo_ros_camera.so")
class CameraPlugin:
    """Draws only while image or camera_info has a subscriber."""

    def __init__(self, host: Host):
        self._world = host.world
        self._camera = Camera(host.world, host.link, host.sensor, host.shared.renderer())
        self._settings = CameraSettings(host, self._camera.description)
        settings = self._settings
        rates = [rate for rate in (settings.sensor_rate_hz, settings.plugin_rate_hz) if rate > 0]
        self._schedule = Schedule(min(rates, default=DEFAULT_RATE), host.world.timestep)
        self._schedule.restart(host.world.tick)
        self._images = host.advertise(settings.image_topic, Image, queue_size=2, latch=True)
        self._infos = host.advertise(settings.info_topic, CameraInfo, queue_size=2)

    def update(self) -> None:
        """Take a picture when due and asked for."""
        if not self._schedule.due(self._world.tick):
            return
        images, infos = self._images.get_num_connections(), self._infos.get_num_connections()
        if not images and not infos:
            return
        self._images.publish(self._settings.image(self._camera.sample()))
        if infos:
            self._infos.publish(self._settings.info(self._world.time))

    def reset(self) -> None:
        """Count the rate and draw the noise from the start."""
        self._camera.restart()
        self._schedule.restart(self._world.tick)
