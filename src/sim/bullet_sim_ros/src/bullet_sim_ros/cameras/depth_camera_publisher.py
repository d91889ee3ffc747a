"""A depth camera's topics: those of a camera, a depth image with CameraInfo, and points."""

import math
from concurrent.futures import Future

import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, Image, PointCloud2

from bullet_sim.sensors.camera import CameraReading, CaptureState
from bullet_sim_ros import convert
from bullet_sim_ros.cameras.camera_publisher import CameraPublisher
from bullet_sim_ros.plugin_host import PluginContext

FARTHEST = float(np.finfo(np.float32).max)  # m; beyond (infinity): nothing there


class DepthCameraPublisher(CameraPublisher):
    """Depth and points are computed only while they have subscribers.

    Points have the true colours, whatever the image's format; gazebo_ros_openni_kinect.cpp,
    FillPointCloudHelper, swaps red and blue of rgb8 images.
    """

    def __init__(self, context: PluginContext, far: float):
        """`far`, m: anything farther away has no depth."""
        super().__init__(context)
        p = context.parameters
        self._context, self._far = context, min(far, FARTHEST)
        self._near = p.number("pointCloudCutoff", 0.4)
        self._millimetres = p.flag("useDepth16UC1Format", False)

        def advertise(tag: str, default: str, kind: type) -> rospy.Publisher:
            return context.advertise(self.settings.topic(tag, default), kind, queue_size=1)

        self._depths = advertise("depthImageTopicName", "depth/image_raw", Image)
        self._depth_infos = advertise("depthImageCameraInfoTopicName", "depth/camera_info",
                                      CameraInfo)
        self._points = advertise("pointCloudTopicName", "points", PointCloud2)
        self._rest: Future | None = None  # the last image's depth and points
        self._restart()
        context.on_reset(self._restart)

    def _restart(self) -> None:
        self._info_time = -math.inf  # s, of the last pair of infos

    def pictures_wanted(self) -> bool:
        """Whether images or points have subscribers; those of depth/camera_info do not count."""
        return super().pictures_wanted() or any(
            publisher.get_num_connections() for publisher in (self._depths, self._points))

    def publish(self, state: CaptureState, picture: bool) -> None:
        """Images if `picture` is set, and both CameraInfo; in the drawing thread.

        Depth and points are made in the second thread; their exception is raised at the next ones.
        """
        if picture:
            depth = bool(self._depths.get_num_connections())
            points = bool(self._points.get_num_connections())
            reading = self.camera.render(state, depth or points)
            self.publish_picture(reading)
            if reading.depth is not None:
                before, self._rest = self._rest, self._context.host.drawing.hand_on(
                    lambda: self._publish_depth(reading, state.view.focal_length_px, depth, points))
                if before is not None:
                    before.result()  # already done: hand_on has waited for it
        self._publish_infos(state.time)

    def _publish_infos(self, time: float) -> None:
        """Publish both CameraInfo, at `<updateRate>` at most, which thins nothing else here."""
        rate_hz = self.settings.rate_hz
        if rate_hz > 0 and time - self._info_time < 1 / rate_hz - self._context.world.timestep:
            return
        self._info_time = time
        self.publish_info(time)
        if self._depth_infos.get_num_connections():
            self._depth_infos.publish(self.info(time))

    def _publish_depth(self, reading: CameraReading, focal_px: float, depth: bool,
                       points: bool) -> None:
        metres, frame = reading.depth, self.settings.frame
        with self._context.world.profiler.measure("depth and points"):
            convert.remove_outside(metres, self._near, self._far)
            if depth:
                self._depths.publish(
                    convert.depth_to_msg(metres, reading.time, frame, self._millimetres))
            if points:
                self._points.publish(
                    convert.points_to_msg(metres, reading.rgb, focal_px, reading.time, frame))
