"""libgazebo_ros_openni_kinect.so: colour, depth and points of one depth sensor."""

from __future__ import annotations

import math

import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, Image, PointCloud2

from bullet_sim.sensors.camera import Camera, CameraReading, Exposure
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugins.camera import DEFAULT_RATE, CameraSettings, tell_frame_time
from bullet_sim_ros.plugins.host import Host
from bullet_sim_ros.plugins.registry import plugin


@plugin("libgazebo_ros_openni_kinect.so")
class OpenniKinectPlugin:
    """Depth and points are made only for those who subscribe to them."""

    def __init__(self, host: Host):
        p = host.parameters
        self._host = host
        self._camera = Camera(host.world, host.link, host.sensor, host.shared.drawing.renderer())
        self._settings = settings = CameraSettings(host, self._camera.description)
        self._near = p.number("pointCloudCutoff", 0.4)
        self._far = p.number("pointCloudCutoffMax", 5.0)
        self._millimetres = p.flag("useDepth16UC1Format", False)
        rate_hz = settings.sensor_rate_hz or settings.plugin_rate_hz or DEFAULT_RATE

        def advertise(tag: str, default: str, kind: type) -> rospy.Publisher:
            topic = names.join(settings.namespace, p.text(tag, default))
            return host.advertise(topic, kind, queue_size=1)

        self._images = host.advertise(settings.image_topic, Image, queue_size=2, latch=True)
        self._infos = host.advertise(settings.info_topic, CameraInfo, queue_size=2)
        self._depths = advertise("depthImageTopicName", "depth/image_raw", Image)
        self._depth_infos = advertise("depthImageCameraInfoTopicName", "depth/camera_info",
                                      CameraInfo)
        self._points = advertise("pointCloudTopicName", "points", PointCloud2)
        self._pictures = (self._images, self._depths, self._points)
        self._wakers = (*self._pictures, self._infos)
        host.every(rate_hz, self._take, self._wanted)
        tell_frame_time(host, self._camera, settings.image_topic)

    def _wanted(self) -> bool:
        """The depth image's camera_info alone does not wake the sensor."""
        return any(publisher.get_num_connections() for publisher in self._wakers)

    def _take(self) -> None:
        if any(publisher.get_num_connections() for publisher in self._pictures):
            self._host.expect_answer()
        exposure = self._camera.expose()
        self._host.draw(lambda: self._send(exposure))

    def _send(self, exposure: Exposure) -> None:
        """In the drawing thread."""
        depth = bool(self._depths.get_num_connections())
        points = bool(self._points.get_num_connections())
        reading = self._camera.develop(exposure, depth or points)
        self._settings.publish(self._images, reading)
        self._publish_infos(reading.time)
        if reading.depth is not None:
            focal_px = exposure.view.focal_length_px
            with self._host.world.stages.measure("depth and points"):
                self._publish_depth(reading, focal_px, depth, points)

    def _publish_infos(self, time: float) -> None:
        for publisher in (self._infos, self._depth_infos):
            if publisher.get_num_connections():
                publisher.publish(self._settings.info(time))

    def _publish_depth(self, reading: CameraReading, focal_px: float, depth: bool,
                       points: bool) -> None:
        outside = (reading.depth < self._near) | (reading.depth > self._far)
        metres = np.where(outside, np.float32(math.nan), reading.depth)
        frame = self._settings.frame
        if depth:
            self._depths.publish(
                convert.depth_to_msg(metres, reading.time, frame, self._millimetres))
        if points:
            self._points.publish(
                convert.points_to_msg(metres, reading.rgb, focal_px, reading.time, frame))
