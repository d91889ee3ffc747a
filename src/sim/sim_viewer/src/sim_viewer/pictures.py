"""Image messages as JPEG for the page: scaled down, and in visible colours."""

import cv2
import numpy as np
from cv_bridge import CvBridge, CvBridgeError
from sensor_msgs.msg import CompressedImage, Image

from bullet_sim.meshes.images import JPEG, image_size
from sim_viewer.registry import Refused

QUALITY = 80  # of 100
TALLEST_PX = 2000
_bridge = CvBridge()


def to_jpeg(msg: Image | CompressedImage, width: int) -> bytes:
    """A JPEG file, at most `width` px wide; a JPEG that is small enough is returned as it is.
    Refused says why an image cannot be shown."""
    if hasattr(msg, "format"):
        data = bytes(msg.data)
        if 0 < _jpeg_width(data) <= width:
            return data
        picture = _decode(data, width)
    else:
        picture = visible(msg)
    height_px, width_px = picture.shape[:2]
    shrink = max(width_px / width, height_px / TALLEST_PX)
    if shrink > 1:
        size = (max(1, round(width_px / shrink)), max(1, round(height_px / shrink)))
        picture = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
    return cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])[1].tobytes()


def visible(msg: Image) -> np.ndarray:
    """(h, w) or (h, w, 3) uint8, grey or BGR. Depths and 16-bit values are scaled from black to
    white between the image's least and largest; values that are not finite are black. Encodings
    that only name the number of channels (8UC3) mean BGR, as in OpenCV. Refused: no image."""
    if not msg.width or not msg.height:
        raise Refused("the picture has no pixels")
    try:
        picture = _bridge.imgmsg_to_cv2(msg)
        named = "C" not in msg.encoding  # bgr8 and its like, not 8UC3
        if named and picture.dtype == np.uint8 and msg.encoding != "mono8":
            return _bridge.imgmsg_to_cv2(msg, "bgr8")
    except (CvBridgeError, ValueError, TypeError, MemoryError) as error:
        raise _cannot(msg, str(error)) from None
    channels = 1 if picture.ndim == 2 else picture.shape[2]
    if channels not in (1, 3, 4):
        raise _cannot(msg, f"{channels} numbers a pixel are not a colour")
    colours = picture[..., :3] if channels == 4 else picture
    if msg.encoding.startswith("rgb"):
        colours = colours[..., ::-1]
    return colours if colours.dtype == np.uint8 else _spread(colours)


def _cannot(msg: Image, reason: str) -> Refused:
    return Refused(f"a picture of {msg.width} x {msg.height} in {msg.encoding!r:.30} cannot be "
                   f"shown: {reason}")


def _spread(values: np.ndarray) -> np.ndarray:
    values = np.asarray(values, np.float32)
    finite = np.isfinite(values)
    low, high = (values[finite].min(), values[finite].max()) if finite.any() else (0.0, 1.0)
    span = max(float(high) - float(low), 1e-6)
    grey = np.where(finite, values, low).astype(np.float64) - float(low)
    grey *= 255 / span
    return grey.astype(np.uint8)


def _decode(data: bytes, width: int) -> np.ndarray:
    """Decode a compressed image; JPEGs at least twice as wide as `width` are read at half size."""
    large = _jpeg_width(data) >= 2 * width
    mode = cv2.IMREAD_REDUCED_COLOR_2 if large else cv2.IMREAD_COLOR
    picture = cv2.imdecode(np.frombuffer(data, np.uint8), mode) if data else None
    if picture is None:
        raise Refused("the compressed picture is of a kind that cannot be read")
    return picture


def _jpeg_width(data: bytes) -> int:
    """The width in px; 0 if the data are not a JPEG."""
    size = image_size(data) if data.startswith(JPEG) else None
    return size[0] if size else 0
