"""libgazebo_ros_openni_kinect.so: colour, depth and points of one depth sensor."""

from __future__ import annotations

import math

import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, Image, PointCloud2

from bullet_sim.sensors.camera import CameraReading, Exposure
from bullet_sim_ros import convert
from bullet_sim_ros.cameras.camera_group import pictures_rate
from bullet_sim_ros.cameras.camera_publisher import Eye
from bullet_sim_ros.cameras.topics import offer_rate
from bullet_sim_ros.plugin_host.context import Host
from bullet_sim_ros.plugin_host.registry import plugin

FAR = 5.0  # m, where <pointCloudCutoffMax> is absent
LARGEST = float(np.finfo(np.float32).max)  # m; beyond is nothing at all


@plugin("libgazebo_ros_openni_kinect.so")
class OpenniKinectPlugin:
    """Depth and points are made only for those who subscribe to them.

    Points have the colours of what they are on, whatever the image's format (upstream swaps red and
    blue of rgb8 images).
    """

    has_far_cutoff = True  # whether <pointCloudCutoffMax> counts

    def __init__(self, host: Host):
        p = host.parameters
        self._host = host
        self._eye = eye = Eye(host)
        self._near = p.number("pointCloudCutoff", 0.4)
        self._millimetres = p.flag("useDepth16UC1Format", False)
        self._far = p.number("pointCloudCutoffMax", FAR) if self.has_far_cutoff else LARGEST

        def advertise(tag: str, default: str, kind: type) -> rospy.Publisher:
            return host.advertise(eye.settings.topic(tag, default), kind, queue_size=1)

        self._depths = advertise("depthImageTopicName", "depth/image_raw", Image)
        self._depth_infos = advertise("depthImageCameraInfoTopicName", "depth/camera_info",
                                      CameraInfo)
        self._points = advertise("pointCloudTopicName", "points", PointCloud2)
        self._info_time = -math.inf  # s, of the last pair of infos
        # Without a rate of the sensor the plugin's is taken (upstream: as fast as it can).
        rate_hz = host.sensor.update_rate or eye.settings.rate_hz
        host.every(pictures_rate(rate_hz, 0.0), self._take, self._wanted)
        offer_rate(host, eye.settings, host.change_rate)
        host.on_reset(self._restart)

    def _restart(self) -> None:
        self._info_time = -math.inf

    def _pictures_wanted(self) -> bool:
        return self._eye.topics.pictures_wanted() or any(
            publisher.get_num_connections() for publisher in (self._depths, self._points))

    def _wanted(self) -> bool:
        """The depth image's camera_info alone does not wake the sensor."""
        return self._pictures_wanted() or self._eye.topics.wanted()

    def _take(self) -> None:
        if self._pictures_wanted():
            self._host.expect_answer()
        exposure = self._eye.expose()
        self._host.draw(lambda: self._send(exposure))

    def _send(self, exposure: Exposure) -> None:
        """In the drawing thread."""
        depth = bool(self._depths.get_num_connections())
        points = bool(self._points.get_num_connections())
        if self._pictures_wanted():
            reading = self._eye.develop(exposure, depth or points)
            self._eye.topics.publish(reading)
            if reading.depth is not None:
                with self._host.world.stages.measure("depth and points"):
                    self._publish_depth(reading, exposure.view.focal_length_px, depth, points)
        self._publish_infos(exposure.time)

    def _publish_infos(self, time: float) -> None:
        """At no more than `<updateRate>`, which thins nothing else here."""
        rate_hz = self._eye.settings.rate_hz
        if rate_hz > 0 and time - self._info_time < 1 / rate_hz - self._host.world.timestep:
            return
        self._info_time = time
        self._eye.topics.publish_info(time)
        if self._depth_infos.get_num_connections():
            self._depth_infos.publish(self._eye.topics.info(time))

    def _publish_depth(self, reading: CameraReading, focal_px: float, depth: bool,
                       points: bool) -> None:
        inside = (reading.depth >= self._near) & (reading.depth <= min(self._far, LARGEST))
        metres = np.where(inside, reading.depth, np.float32(math.nan))
        frame = self._eye.settings.frame
        if depth:
            self._depths.publish(
                convert.depth_to_msg(metres, reading.time, frame, self._millimetres))
        if points:
            self._points.publish(
                convert.points_to_msg(metres, reading.rgb, focal_px, reading.time, frame))
