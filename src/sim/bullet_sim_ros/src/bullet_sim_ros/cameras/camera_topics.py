"""One camera's tags and topics: image, compressed image, CameraInfo, depth and points."""

import copy
import logging
import math
import time
from concurrent.futures import Future
from typing import NamedTuple

import cv2
import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, PointCloud2
from sensor_msgs.srv import SetCameraInfo, SetCameraInfoResponse

from bullet_sim.description import CameraDescription
from bullet_sim.sensors.camera import Camera, CameraReading, CaptureState
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.array_messages import LastMessage
from bullet_sim_ros.cameras.encodings import ENCODINGS, UNKNOWN_FORMAT, encode
from bullet_sim_ros.plugin_host import PluginContext
from bullet_sim_ros.reconfigure_server import Value, offer_values

log = logging.getLogger("bullet_sim.plugins")

TRIALS = 3
LONGEST_TRIAL = 0.2  # s, wall clock: a slow renderer is timed only once
FARTHEST = float(np.finfo(np.float32).max)  # m; beyond (infinity): nothing there

_DISTORTION = ("K1", "K2", "T1", "T2", "K3")  # the order of CameraInfo's D
_SAME_FOCAL_PX = 1e-3
_SAME_DISTORTION = 1e-6  # many files write 1e-8 for none


class Wanted(NamedTuple):
    """Which messages of a camera are to be published: what has subscribers when it captures."""

    image: bool
    compressed: bool
    info: bool
    depth: bool = False
    depth_info: bool = False
    points: bool = False

    @property
    def pictures(self) -> bool:
        """Whether the camera has to be rendered."""
        return self.image or self.compressed or self.depth or self.points

    @property
    def captures(self) -> bool:
        """Whether the sensor works at all: subscribers to depth/camera_info alone do not count."""
        return self.pictures or self.info


class CameraSettings:
    """The tags of a `<plugin>` about one camera.

    `suffix` is added to the namespace of a camera that is one of a pair, `baseline` (m) is its
    distance from the other; without it `<hackBaseline>` counts. `<CxPrime>` has no effect, as in
    gazebo_ros_camera_utils.cpp, Init.
    """

    def __init__(self, context: PluginContext, description: CameraDescription, suffix: str = "",
                 baseline: float | None = None):
        p = context.parameters
        self._context = context
        self._description = description
        self.camera_name = p.text("cameraName") + suffix
        self.namespace = names.join(p.namespace(missing="/", empty=context.model.name),
                                    self.camera_name)
        self.frame = names.frame(params.tf_prefix(self.namespace), p.text("frameName"))
        self.image_topic = self.topic("imageTopicName", "image_raw")
        self.info_topic = self.topic("cameraInfoTopicName", "camera_info")
        self.rate_hz = p.number("updateRate", 0.0)
        self.encoding = self._encoding()
        self.info = convert.camera_info_to_msg(
            description, 0.0, self.frame, centre_x=p.number("Cx", 0.0),
            centre_y=p.number("Cy", 0.0), focal_length=self._focal_length_px(),
            baseline=p.number("hackBaseline", 0.0) if baseline is None else baseline,
            distortion=self._distortion())

    def topic(self, tag: str, default: str) -> str:
        """The topic that a tag names, in the camera's namespace."""
        return names.join(self.namespace, self._context.parameters.text(tag, default))

    def _encoding(self) -> str:
        format = self._description.format
        if format not in ENCODINGS:
            log.error("%s: Unsupported Gazebo ImageFormat %s; there are %s; %s is used",
                      self._context.describe(), format, ", ".join(ENCODINGS), UNKNOWN_FORMAT)
        return ENCODINGS.get(format, UNKNOWN_FORMAT)

    def _focal_length_px(self) -> float:
        """`<focalLength>` as written; 0 stands for that of the rendered image."""
        written = self._context.parameters.number("focalLength", 0.0)
        camera = self._description
        drawn = camera.width / (2 * math.tan(camera.horizontal_fov / 2))
        if written and abs(written - drawn) > _SAME_FOCAL_PX:
            log.warning(
                "%s: <focalLength> is %g, but pictures of %d px with a <horizontal_fov> of %g rad "
                "have %g; only camera_info has the former: leave the tag out", self._context.
                describe(), written, camera.width, camera.horizontal_fov, drawn)
        return written

    def _distortion(self) -> tuple[float, ...]:
        p, drawn = self._context.parameters, self._description.distortion
        if p.flag("autoDistortion", False):
            return drawn
        written = tuple(p.number(f"distortion{tag}", 0.0) for tag in _DISTORTION)
        if max(abs(a - b) for a, b in zip(written, drawn, strict=True)) > _SAME_DISTORTION:
            log.warning(
                "%s: camera_info says D = %s by <distortionK1> and the like, but the picture is "
                "drawn by the <distortion> of the sensor's <camera>, %s; "
                "<autoDistortion>true</autoDistortion> makes them agree", self._context.describe(),
                list(written), list(drawn))
        return written


class CameraTopics:
    """Image, its compressed twin, CameraInfo and set_camera_info.

    A calibration set by set_camera_info lasts as long as the camera; it is not written to a file.

    FormatError if the camera or one of its tags is impossible.
    """

    def __init__(self, context: PluginContext, number: int = 0, suffix: str = "",
                 baseline: float | None = None):
        drawing = context.host.drawing
        self.camera = Camera(context.world, context.link, context.sensor, drawing.renderer(),
                             number, context.parameters.flag("borderCrop", True))
        context.on_close(drawing.trim)
        self.settings = settings = CameraSettings(context, self.camera.description, suffix,
                                                  baseline)
        self._profiler = context.world.profiler
        self._info = settings.info
        self._images = context.advertise(settings.image_topic, Image, queue_size=2, latch=True)
        self._last_image: LastMessage[Image] = LastMessage()
        self._compressed = CompressedTopic(context, settings.image_topic, latch=True)
        self._infos = context.advertise(settings.info_topic, CameraInfo, queue_size=2)
        context.serve(names.join(settings.namespace, "set_camera_info"), SetCameraInfo,
                      self._set_info)
        _log_frame_time(context, self.camera, settings.image_topic)

    def subscribed(self) -> Wanted:
        """What has subscribers now."""
        return Wanted(*(bool(topic.get_num_connections()) for topic in (
            self._images, self._compressed.publisher, self._infos)))

    def publish(self, state: CaptureState, wanted: Wanted) -> None:
        """Render what is wanted, and publish it; in the drawing thread."""
        if wanted.image:
            self.publish_picture(self.camera.render(state), wanted)
        if wanted.info:
            self._infos.publish(self.info(state.time))

    def publish_picture(self, reading: CameraReading, wanted: Wanted) -> None:
        """Publish an image, and its compressed form if that is wanted."""
        settings = self.settings
        with self._profiler.measure("send"):
            self._images.publish(self._last_image.of(
                convert.stamp(reading.time), lambda: convert.image_to_msg(
                    reading.rgb, reading.time, settings.frame, settings.encoding), reading.rgb))
        if wanted.compressed:
            with self._profiler.measure("compress"):
                self._compressed.publish(reading.rgb, settings.encoding, reading.time,
                                         settings.frame)

    def info(self, time: float) -> CameraInfo:
        """The calibration, stamped with a time (s)."""
        info = copy.copy(self._info)
        info.header = copy.copy(info.header)
        return convert.stamped(info, time, self.settings.frame)

    def _set_info(self, request) -> SetCameraInfoResponse:
        """In a ROS thread."""
        self._info = request.camera_info
        return SetCameraInfoResponse(success=True)


class DepthCameraTopics(CameraTopics):
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
        self._cut: np.ndarray | None = None  # the last depth whose far and near parts are NaN
        self._last_depth: LastMessage[Image] = LastMessage()
        self._last_points: LastMessage[PointCloud2] = LastMessage()
        self._restart()
        context.on_reset(self._restart)

    def _restart(self) -> None:
        self._info_time = -math.inf  # s, of the last pair of infos

    def subscribed(self) -> Wanted:
        """What has subscribers now."""
        return super().subscribed()._replace(
            depth=bool(self._depths.get_num_connections()),
            depth_info=bool(self._depth_infos.get_num_connections()),
            points=bool(self._points.get_num_connections()))

    def publish(self, state: CaptureState, wanted: Wanted) -> None:
        """Render what is wanted, and publish it; in the drawing thread.

        Depth and points are made in the second thread; their exception is raised at the next ones.
        """
        if wanted.image:
            reading = self.camera.render(state, wanted.depth or wanted.points)
            self.publish_picture(reading, wanted)
            if reading.depth is not None:
                before, self._rest = self._rest, self._context.host.drawing.hand_on(
                    lambda: self._publish_depth(reading, state.view.focal_length_px, wanted))
                if before is not None:
                    before.result()  # already done: hand_on has waited for it
            elif self._rest is not None:
                self._rest.result()
                self._rest = self._cut = None
                self._last_depth.forget()
                self._last_points.forget()
        self._publish_infos(state.time, wanted)

    def _publish_infos(self, time: float, wanted: Wanted) -> None:
        """Publish both CameraInfo, at `<updateRate>` at most, which thins nothing else here."""
        rate_hz = self.settings.rate_hz
        if rate_hz > 0 and time - self._info_time < 1 / rate_hz - self._context.world.timestep:
            return
        self._info_time = time
        if wanted.info:
            self._infos.publish(self.info(time))
        if wanted.depth_info:
            self._depth_infos.publish(self.info(time))

    def _publish_depth(self, reading: CameraReading, focal_px: float, wanted: Wanted) -> None:
        metres, time, frame = reading.depth, reading.time, self.settings.frame
        stamp = convert.stamp(time)
        with self._context.world.profiler.measure("depth and points"):
            if metres is not self._cut:
                convert.remove_outside(metres, self._near, self._far)
                self._cut = metres
            if wanted.depth:
                self._depths.publish(self._last_depth.of(stamp, lambda: convert.depth_to_msg(
                    metres, time, frame, self._millimetres), metres))
            if wanted.points:
                self._points.publish(self._last_points.of(stamp, lambda: convert.points_to_msg(
                    metres, reading.rgb, focal_px, time, frame), metres, reading.rgb))
            else:
                self._last_points.forget()  # 33 MB at 1920x1080


def _log_frame_time(context: PluginContext, camera: Camera, topic: str) -> None:
    """Log how long this camera takes to render; measured in the drawing thread, before any image.

    A camera that was deleted meanwhile is not rendered.
    """
    state = camera.capture()

    def measure() -> None:
        took: list[float] = []
        while len(took) <= TRIALS and sum(took[1:]) < LONGEST_TRIAL:
            if context.closed:
                return
            start = time.perf_counter()
            camera.render(state, anew=True)
            took.append(time.perf_counter() - start)
        view = state.view
        frame_ms = min(took[1:]) * 1e3  # the first one also loads the scene
        line = f"camera {topic} ({view.width}x{view.height}): {frame_ms:.1f} ms a frame"
        context.host.mailbox.post(lambda: rospy.loginfo("%s", line))

    context.host.drawing.submit(measure)


FORMATS = ("jpeg", "png")
JPEG_QUALITY, PNG_LEVEL = 80, 9  # the plugin's defaults; 1..100 and 1..9


class CompressedTopic:
    """`IMAGE/compressed`, with the parameters and the dynamic_reconfigure server below it."""

    def __init__(self, context: PluginContext, image_topic: str, latch: bool):
        self._topic = names.join(image_topic, "compressed")
        self.publisher = context.advertise(self._topic, CompressedImage, queue_size=2, latch=latch)
        self._last: LastMessage[CompressedImage] = LastMessage()
        self._settings: dict = {}
        values = {
            "format": Value(self._parameter("format", FORMATS[0]), "", "", "jpeg or png"),
            "jpeg_quality": Value(self._parameter("jpeg_quality", JPEG_QUALITY), 1, 100,
                                  "JPEG quality, percent"),
            "png_level": Value(self._parameter("png_level", PNG_LEVEL), 1, 9, "PNG effort"),
        }
        offer_values(context, self._topic, values, self._change)

    def publish(self, rgb: np.ndarray, encoding: str, time: float, frame: str) -> None:
        """Publish an image, (h, w, 3) uint8 RGB; `encoding` is that of the image topic."""
        settings = self._settings
        self.publisher.publish(self._last.of(convert.stamp(time), lambda: compressed_to_msg(
            rgb, encoding, time, frame, **settings), rgb, settings))

    def _parameter(self, name: str, default: str | int) -> str | int:
        name = names.join(self._topic, name)
        value = params.below(name)
        if value is None or type(value) is type(default):
            return default if value is None else value
        rospy.logwarn("parameter %s is %r, which is not like %r; the latter is used", name, value,
                      default)
        return default

    def _change(self, values: dict) -> None:
        """Called once by the constructor, later in a ROS thread."""
        if values["format"] not in FORMATS:
            rospy.logwarn("%s/format is %r; there are %s; %s is used", self._topic,
                          values["format"], " and ".join(FORMATS), FORMATS[0])
            values = {**values, "format": FORMATS[0]}
        self._settings = values


def compressed_to_msg(rgb: np.ndarray, encoding: str, time: float, frame: str, *,
                      format: str = FORMATS[0], jpeg_quality: int = JPEG_QUALITY,
                      png_level: int = PNG_LEVEL) -> CompressedImage:
    """sensor_msgs/CompressedImage; its format gives the source encoding, codec and pixel format.

    Colours are compressed as BGR, grey and Bayer mosaics as they are; JPEG has 8 bits a channel.
    """
    pixels, inside = encode(rgb, encoding), ""
    if pixels.ndim == 3:
        inside = "bgr16" if pixels.dtype == np.uint16 and format == "png" else "bgr8"
        pixels = cv2.cvtColor(rgb, cv2.COLOR_RGB2BGR)
        if inside == "bgr16":
            pixels = encode(pixels, "rgb16")
    elif pixels.dtype == np.uint16 and format == "jpeg":
        pixels = encode(rgb, "mono8")
    options = {"jpeg": [cv2.IMWRITE_JPEG_QUALITY, jpeg_quality],
               "png": [cv2.IMWRITE_PNG_COMPRESSION, png_level]}[format]
    _, data = cv2.imencode({"jpeg": ".jpg", "png": ".png"}[format], pixels, options)
    return convert.stamped(CompressedImage(
        format=f"{encoding}; {format} compressed {inside}", data=data.tobytes()), time, frame)
