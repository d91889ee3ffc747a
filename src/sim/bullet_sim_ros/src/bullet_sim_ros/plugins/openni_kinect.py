"""libgazebo_ros_openni_kinect.so: colour, depth and points of one depth sensor."""

from __future__ import annotations

import math

import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, Image, PointCloud2

from bullet_sim.sensors.camera import CameraReading, CaptureState
from bullet_sim_ros import convert
from bullet_sim_ros.cameras.camera_group import pictures_rate
from bullet_sim_ros.cameras.camera_publisher import CameraPublisher
from bullet_sim_ros.cameras.topics import offer_rate
from bullet_sim_ros.plugin_host.context import PluginContext
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

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._context = context
        self._camera = camera = CameraPublisher(context)
        self._near = p.number("pointCloudCutoff", 0.4)
        self._millimetres = p.flag("useDepth16UC1Format", False)
        self._far = p.number("pointCloudCutoffMax", FAR) if self.has_far_cutoff else LARGEST

        def advertise(tag: str, default: str, kind: type) -> rospy.Publisher:
            return context.advertise(camera.settings.topic(tag, default), kind, queue_size=1)

        self._depths = advertise("depthImageTopicName", "depth/image_raw", Image)
        self._depth_infos = advertise("depthImageCameraInfoTopicName", "depth/camera_info",
                                      CameraInfo)
        self._points = advertise("pointCloudTopicName", "points", PointCloud2)
        self._info_time = -math.inf  # s, of the last pair of infos
        # Without a rate of the sensor the plugin's is taken (upstream: as fast as it can).
        rate_hz = context.sensor.update_rate or camera.settings.rate_hz
        context.every(pictures_rate(rate_hz, 0.0), self._take, self._wanted)
        offer_rate(context, camera.settings, context.change_rate)
        context.on_reset(self._restart)

    def _restart(self) -> None:
        self._info_time = -math.inf

    def _pictures_wanted(self) -> bool:
        return self._camera.topics.pictures_wanted() or any(
            publisher.get_num_connections() for publisher in (self._depths, self._points))

    def _wanted(self) -> bool:
        """The depth image's camera_info alone does not wake the sensor."""
        return self._pictures_wanted() or self._camera.topics.wanted()

    def _take(self) -> None:
        if self._pictures_wanted():
            self._context.expect_answer()
        state = self._camera.capture()
        self._context.draw(lambda: self._send(state))

    def _send(self, state: CaptureState) -> None:
        """In the drawing thread."""
        depth = bool(self._depths.get_num_connections())
        points = bool(self._points.get_num_connections())
        if self._pictures_wanted():
            reading = self._camera.render(state, depth or points)
            self._camera.topics.publish(reading)
            if reading.depth is not None:
                with self._context.world.profiler.measure("depth and points"):
                    self._publish_depth(reading, state.view.focal_length_px, depth, points)
        self._publish_infos(state.time)

    def _publish_infos(self, time: float) -> None:
        """At no more than `<updateRate>`, which thins nothing else here."""
        rate_hz = self._camera.settings.rate_hz
        if rate_hz > 0 and time - self._info_time < 1 / rate_hz - self._context.world.timestep:
            return
        self._info_time = time
        self._camera.topics.publish_info(time)
        if self._depth_infos.get_num_connections():
            self._depth_infos.publish(self._camera.topics.info(time))

    def _publish_depth(self, reading: CameraReading, focal_px: float, depth: bool,
                       points: bool) -> None:
        inside = (reading.depth >= self._near) & (reading.depth <= min(self._far, LARGEST))
        metres = np.where(inside, reading.depth, np.float32(math.nan))
        frame = self._camera.settings.frame
        if depth:
            self._depths.publish(
                convert.depth_to_msg(metres, reading.time, frame, self._millimetres))
        if points:
            self._points.publish(
                convert.points_to_msg(metres, reading.rgb, focal_px, reading.time, frame))
