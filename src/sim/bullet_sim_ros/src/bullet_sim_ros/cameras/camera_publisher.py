"""One camera of a sensor: renders and publishes what has subscribers."""

import copy
import time

import cv2
import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, CompressedImage, Image
from sensor_msgs.srv import SetCameraInfo, SetCameraInfoResponse

from bullet_sim.sensors.camera import Camera, CameraReading, CaptureState
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.cameras.encodings import encode
from bullet_sim_ros.cameras.settings import CameraSettings
from bullet_sim_ros.plugin_host import PluginContext
from bullet_sim_ros.reconfigure_server import Value, offer_values

TRIALS = 3
LONGEST_TRIAL = 0.2  # s, wall clock: a slow renderer is timed only once


class CameraPublisher:
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
        self._compressed = CompressedTopic(context, settings.image_topic, latch=True)
        self._infos = context.advertise(settings.info_topic, CameraInfo, queue_size=2)
        context.serve(names.join(settings.namespace, "set_camera_info"), SetCameraInfo,
                      self._set_info)
        _log_frame_time(context, self.camera, settings.image_topic)

    def pictures_wanted(self) -> bool:
        """Whether anybody listens to images."""
        return bool(self._images.get_num_connections()) or self._compressed.wanted()

    def wanted(self) -> bool:
        """Whether anybody listens to images or camera_info."""
        return self.pictures_wanted() or bool(self._infos.get_num_connections())

    def publish(self, state: CaptureState, picture: bool) -> None:
        """An image if `picture` is set, CameraInfo if subscribed to; in the drawing thread."""
        if picture:
            self.publish_picture(self.camera.render(state))
        self.publish_info(state.time)

    def publish_picture(self, reading: CameraReading) -> None:
        """Publish an image, and its compressed form if that has subscribers."""
        settings = self.settings
        with self._profiler.measure("send"):
            self._images.publish(convert.image_to_msg(
                reading.rgb, reading.time, settings.frame, settings.encoding))
        if self._compressed.wanted():
            with self._profiler.measure("compress"):
                self._compressed.publish(reading.rgb, settings.encoding, reading.time,
                                         settings.frame)

    def publish_info(self, time: float) -> None:
        """Publish the CameraInfo of an image of that time (s), if it has subscribers."""
        if self._infos.get_num_connections():
            self._infos.publish(self.info(time))

    def info(self, time: float) -> CameraInfo:
        """The calibration, stamped with a time (s)."""
        info = copy.copy(self._info)
        info.header = copy.copy(info.header)
        return convert.stamped(info, time, self.settings.frame)

    def _set_info(self, request) -> SetCameraInfoResponse:
        """In a ROS thread."""
        self._info = request.camera_info
        return SetCameraInfoResponse(success=True)


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
            camera.render(state)
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
        self._publisher = context.advertise(self._topic, CompressedImage, queue_size=2, latch=latch)
        self._settings: dict = {}
        values = {
            "format": Value(self._parameter("format", FORMATS[0]), "", "", "jpeg or png"),
            "jpeg_quality": Value(self._parameter("jpeg_quality", JPEG_QUALITY), 1, 100,
                                  "JPEG quality, percent"),
            "png_level": Value(self._parameter("png_level", PNG_LEVEL), 1, 9, "PNG effort"),
        }
        offer_values(context, self._topic, values, self._change)

    def wanted(self) -> bool:
        """Whether anybody listens."""
        return bool(self._publisher.get_num_connections())

    def publish(self, rgb: np.ndarray, encoding: str, time: float, frame: str) -> None:
        """Publish an image, (h, w, 3) uint8 RGB; `encoding` is that of the image topic."""
        self._publisher.publish(compressed_to_msg(rgb, encoding, time, frame, **self._settings))

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
