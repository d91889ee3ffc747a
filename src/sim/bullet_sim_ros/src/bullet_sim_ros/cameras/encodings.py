"""Pixels in the encodings of sensor_msgs/Image: from RGB, and back."""

import cv2
import numpy as np
from sensor_msgs.msg import Image

ENCODINGS = {  # SDF <format>: encoding of sensor_msgs/Image
    "R8G8B8": "rgb8", "RGB_INT8": "rgb8", "B8G8R8": "bgr8", "BGR_INT8": "bgr8",
    "L8": "mono8", "L_INT8": "mono8", "L16": "mono16", "L_INT16": "mono16",
    "R16G16B16": "rgb16", "RGB_INT16": "rgb16",
    "BAYER_RGGB8": "bayer_rggb8", "BAYER_BGGR8": "bayer_bggr8",
    "BAYER_GBRG8": "bayer_gbrg8", "BAYER_GRBG8": "bayer_grbg8",
}
UNKNOWN_FORMAT = "bgr8"  # gazebo_ros_camera_utils.cpp, Init, for a <format> it does not know
_DEEPER = 257  # 8 to 16 bits: 255 becomes 65535
_TO_RGB = {
    "rgb8": None, "8UC3": cv2.COLOR_BGR2RGB, "bgr8": cv2.COLOR_BGR2RGB,
    "rgba8": cv2.COLOR_RGBA2RGB, "bgra8": cv2.COLOR_BGRA2RGB, "8UC4": cv2.COLOR_BGRA2RGB,
    "mono8": cv2.COLOR_GRAY2RGB, "8UC1": cv2.COLOR_GRAY2RGB,
    # OpenCV names a mosaic by the second row's second and third pixels.
    "bayer_rggb8": cv2.COLOR_BayerBG2RGB, "bayer_bggr8": cv2.COLOR_BayerRG2RGB,
    "bayer_gbrg8": cv2.COLOR_BayerGR2RGB, "bayer_grbg8": cv2.COLOR_BayerGB2RGB,
}
_DEEP = {"mono16": "mono8", "16UC1": "mono8", "rgb16": "rgb8", "bgr16": "bgr8"}
_CHANNELS = {"rgb": 3, "bgr": 3, "8UC3": 3, "rgba": 4, "bgra": 4, "8UC4": 4}


def encode(rgb: np.ndarray, encoding: str) -> np.ndarray:
    """Convert (h, w, 3) uint8 RGB to one of ENCODINGS: (h, w) or (h, w, 3), uint8 or uint16."""
    if encoding == "bgr8":
        return cv2.cvtColor(rgb, cv2.COLOR_RGB2BGR)
    if encoding in ("mono8", "mono16"):  # ITU-R BT.601 luma
        grey = cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY)
        return grey if encoding == "mono8" else grey.astype(np.uint16) * _DEEPER
    if encoding == "rgb16":
        return rgb.astype(np.uint16) * _DEEPER
    if encoding.startswith("bayer_"):
        return _mosaic(rgb, encoding[len("bayer_"):-1])
    return rgb


def _mosaic(rgb: np.ndarray, pattern: str) -> np.ndarray:
    """A Bayer mosaic, (h, w); `pattern` names the colours of its first 2 x 2 pixels, as rggb."""
    mosaic = np.empty(rgb.shape[:2], np.uint8)
    for index, colour in enumerate(pattern):
        place = np.s_[index // 2::2, index % 2::2]
        mosaic[place] = rgb[..., "rgb".index(colour)][place]
    return mosaic


def decode(msg: Image) -> np.ndarray:
    """(h, w, 3) uint8 RGB of an Image; ValueError if it cannot be read.

    CvBridge is not used: Debian 12's skews images with padded rows, refuses 8UC1, 8UC3 and 8UC4,
    and checks no size.
    """
    shallow = _DEEP.get(msg.encoding, msg.encoding)
    if shallow not in _TO_RGB:
        known = ", ".join([*_TO_RGB, *_DEEP])
        raise ValueError(f"encoding {msg.encoding!r} cannot be shown; there are: {known}")
    channels = _CHANNELS.get(shallow, _CHANNELS.get(shallow.rstrip("8"), 1))
    depth = np.dtype((">u2" if msg.is_bigendian else "<u2") if msg.encoding in _DEEP else "u1")
    row = msg.width * channels * depth.itemsize
    if not msg.width or not msg.height or msg.step < row or len(msg.data) < msg.step * msg.height:
        raise ValueError(f"{len(msg.data)} bytes, {msg.step} a row, are not an image of "
                         f"{msg.width}x{msg.height} px with {row} bytes a row")
    rows = np.frombuffer(msg.data, np.uint8, msg.step * msg.height).reshape(msg.height, msg.step)
    pixels = np.ascontiguousarray(rows[:, :row]).view(depth)
    if depth.itemsize == 2:
        pixels = (pixels >> 8).astype(np.uint8)
    pixels = pixels.reshape(msg.height, msg.width, channels)
    code = _TO_RGB[shallow]
    return pixels if code is None else cv2.cvtColor(pixels, code)
