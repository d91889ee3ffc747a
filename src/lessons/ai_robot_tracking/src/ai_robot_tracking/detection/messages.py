"""ROS messages from and to arrays: images in, detections and images with boxes drawn out."""

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


FONT = cv2.FONT_HERSHEY_SIMPLEX


def annotated(rgb: np.ndarray, found: Detections, names: list[str]) -> np.ndarray:
    """A copy of the (h, w, 3) uint8 RGB image with the detections drawn into it."""
    picture = rgb.copy()
    large = max(picture.shape[:2]) / 640
    thick = max(1, round(2 * large))
    for box, score, label in zip(found.boxes, found.scores, found.classes):
        left, top, right, bottom = (round(float(side)) for side in box)
        colour = class_colour(int(label))
        cv2.rectangle(picture, (left, top), (right - 1, bottom - 1), colour, thick)
        _write(picture, f"{names[label]} {score:.2f}", (left, top), colour, 0.5 * max(1.0, large))
    return picture


def class_colour(label: int) -> tuple[int, int, int]:
    """A colour (RGB) for a class, distinct from those of the classes before it."""
    hue = label * 111 % 180  # steps of about the golden section of OpenCV's 180
    colour = cv2.cvtColor(np.uint8([[[hue, 220, 255]]]), cv2.COLOR_HSV2RGB)[0, 0]
    return tuple(int(channel) for channel in colour)


def _write(picture: np.ndarray, text: str, corner: tuple[int, int], colour: tuple[int, int, int],
           size: float) -> None:
    """Write on a filled patch above the box, or inside it if there is no room above."""
    (width, height), below = cv2.getTextSize(text, FONT, size, 1)
    left = max(0, min(corner[0], picture.shape[1] - width - 2))
    top = corner[1] - height - below - 2
    if top < 0:
        top = max(0, corner[1])
    cv2.rectangle(picture, (left, top), (left + width + 2, top + height + below + 2), colour, -1)
    cv2.putText(picture, text, (left + 1, top + height + 1), FONT, size, (0, 0, 0), 1, cv2.LINE_AA)
