"""Draws boxes and names into an image."""

from __future__ import annotations

import cv2
import numpy as np

from ai_robot_tracking.detection.decoding import Detections

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
