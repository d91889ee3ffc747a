"""Converts ROS messages and arrays: images in, detections and images out."""

from __future__ import annotations

import cv2
import numpy as np
from sensor_msgs.msg import Image
from std_msgs.msg import Header
from vision_msgs.msg import Detection2D, Detection2DArray, ObjectHypothesisWithPose

from ai_robot_tracking.detection.decoding import Detections

# Bytes per pixel, and OpenCV's conversion to RGB (None: it is RGB).
ENCODINGS = {
    "rgb8": (3, None), "bgr8": (3, cv2.COLOR_BGR2RGB), "8UC3": (3, cv2.COLOR_BGR2RGB),
    "rgba8": (4, cv2.COLOR_RGBA2RGB), "bgra8": (4, cv2.COLOR_BGRA2RGB),
    "8UC4": (4, cv2.COLOR_BGRA2RGB),
    "mono8": (1, cv2.COLOR_GRAY2RGB), "8UC1": (1, cv2.COLOR_GRAY2RGB),
}


class PictureError(Exception):
    """The message's image cannot be read; one line."""


def rgb_of(message: Image) -> np.ndarray:
    """(h, w, 3) uint8 RGB; PictureError if encoding, size and data are inconsistent."""
    if message.encoding not in ENCODINGS:
        raise PictureError(f"encoding '{message.encoding}' is not among {', '.join(ENCODINGS)}")
    depth, conversion = ENCODINGS[message.encoding]
    height, width, step = message.height, message.width, message.step
    if not height or not width:
        raise PictureError(f"an image of {width}x{height} px")
    if step < width * depth or len(message.data) < height * step:
        raise PictureError(
            f"{width}x{height} px of {message.encoding} need {width * depth} bytes a row, but "
            f"step is {step} and there are {len(message.data)} bytes in all")
    rows = np.frombuffer(message.data, np.uint8)[:height * step].reshape(height, step)
    pixels = rows[:, :width * depth].reshape(height, width, depth)
    if conversion is None:
        return pixels
    return cv2.cvtColor(np.ascontiguousarray(pixels), conversion)


def image_of(rgb: np.ndarray, header: Header) -> Image:
    """A message with encoding rgb8 from a (h, w, 3) uint8 RGB image."""
    return Image(header=header, height=rgb.shape[0], width=rgb.shape[1], encoding="rgb8",
                 is_bigendian=0, step=3 * rgb.shape[1], data=rgb.tobytes())


def detections_of(found: Detections, header: Header) -> Detection2DArray:
    """Boxes in px with class numbers and scores, with the image's own header."""
    message = Detection2DArray(header=header)
    for box, score, label in zip(found.boxes, found.scores, found.classes):
        one = Detection2D(header=header)
        one.results = [ObjectHypothesisWithPose(id=int(label), score=float(score))]
        one.bbox.center.x, one.bbox.center.y = (float(side) for side in (box[:2] + box[2:]) / 2)
        one.bbox.size_x, one.bbox.size_y = (float(side) for side in box[2:] - box[:2])
        message.detections.append(one)
    return message
