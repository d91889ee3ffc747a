"""The `compressed` transport of images: what image_transport's plugin of that name sends."""

import cv2
import numpy as np
import rospy
from sensor_msgs.msg import CompressedImage

from bullet_sim_ros import convert, names, params
from bullet_sim_ros.cameras.encodings import encode
from bullet_sim_ros.plugin_host import PluginContext
from bullet_sim_ros.reconfigure_server import Value, offer_values

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
        """Send a picture, (h, w, 3) uint8 RGB, as the image topic's `encoding` is compressed."""
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
        """At once, and later in a ROS thread."""
        if values["format"] not in FORMATS:
            rospy.logwarn("%s/format is %r; there are %s; %s is used", self._topic,
                          values["format"], " and ".join(FORMATS), FORMATS[0])
            values = {**values, "format": FORMATS[0]}
        self._settings = values


def compressed_to_msg(rgb: np.ndarray, encoding: str, time: float, frame: str, *,
                      format: str = FORMATS[0], jpeg_quality: int = JPEG_QUALITY,
                      png_level: int = PNG_LEVEL) -> CompressedImage:
    """sensor_msgs/CompressedImage; its format names what was compressed, how, and as what.

    Colours are compressed as BGR, grey and mosaics as they are; JPEG has 8 bits a channel.
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
