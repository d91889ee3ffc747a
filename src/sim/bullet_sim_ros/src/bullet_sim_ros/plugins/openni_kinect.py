"""libgazebo_ros_openni_kinect.so: colour, depth and points of one depth sensor."""

from __future__ import annotations

import math

import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, Image, PointCloud2

from bullet_sim.schedule import Schedule
from bullet_sim.sensors.camera import Camera, CameraReading
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugins.camera import DEFAULT_RATE, CameraSettings
from bullet_sim_ros.plugins.host import Host
from bullet_sim_ros.plugins.registry import plugin


@plugin("libgazebo_ros_openni_kinect.so")
class OpenniKinectPlugin:
    """Depth and points are made only for those who subscribe to them."""

    def __init__(self, host: Host):
        p = host.parameters
        self._world = host.world
        self._camera = Camera(host.world, host.link, host.sensor, host.shared.renderer())
        self._settings = settings = CameraSettings(host, self._camera.description)
        self._near = p.number("pointCloudCutoff", 0.4)
        self._far = p.number("pointCloudCutoffMax", 5.0)
        self._millimetres = p.flag("useDepth16UC1Format", False)
        rate_hz = settings.sensor_rate_hz or settings.plugin_rate_hz or DEFAULT_RATE
        self._schedule = Schedule(rate_hz, host.world.timestep)
        self._schedule.restart(host.world.tick)

        def advertise(tag: str, default: str, kind: type) -> rospy.Publisher:
            topic = names.join(settings.namespace, p.text(tag, default))
            return host.advertise(topic, kind, queue_size=1)

        self._images = host.advertise(settings.image_topic, Image, queue_size=2, latch=True)
        self._infos = host.advertise(settings.info_topic, CameraInfo, queue_size=2)
        self._depths = advertise("depthImageTopicName", "depth/image_raw", Image)
        self._depth_infos = advertise("depthImageCameraInfoTopicName", "depth/camera_info",
                                      CameraInfo)
        self._points = advertise("pointCloudTopicName", "points", PointCloud2)

    def update(self) -> None:
        """Take a picture when due; the depth image's camera_info alone does not wake the sensor."""
        if not self._schedule.due(self._world.tick):
            return
        colour = self._images.get_num_connections() or self._infos.get_num_connections()
        depth, points = self._depths.get_num_connections(), self._points.get_num_connections()
        if not (colour or depth or points):
            return
        reading = self._camera.sample(depth=bool(depth or points))
        if colour or points:
            self._images.publish(self._settings.image(reading))
        self._publish_infos(reading.time)
        if reading.depth is not None:
            self._publish_depth(reading, bool(depth), bool(points))

    def _publish_infos(self, time: float) -> None:
        for publisher in (self._infos, self._depth_infos):
            if publisher.get_num_connections():
                publisher.publish(self._settings.info(time))

    def _publish_depth(self, reading: CameraReading, depth: bool, points: bool) -> None:
        outside = (reading.depth < self._near) | (reading.depth > self._far)
        metres = np.where(outside, np.float32(math.nan), reading.depth)
        frame = self._settings.frame
        if depth:
            self._depths.publish(
                convert.depth_to_msg(metres, reading.time, frame, self._millimetres))
        if points:
            focal_px = self._camera.view().focal_length_px
            self._points.publish(
                convert.points_to_msg(metres, reading.rgb, focal_px, reading.time, frame))

    def reset(self) -> None:
        """Count the rate and draw the noise from the start."""
        self._camera.restart()
        self._schedule.restart(self._world.tick)
