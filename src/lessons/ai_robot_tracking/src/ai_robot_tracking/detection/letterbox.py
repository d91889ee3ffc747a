"""Fits images of any shape into a network's input, and maps boxes back to the image."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

PADDING = 114  # grey level of the padding with which YOLO networks are trained


@dataclass(frozen=True)
class Placement:
    """The image's place in the network's input: input = image * scale + offset, in px."""

    scale: float
    left: int
    top: int


def letterbox(picture: np.ndarray, width: int, height: int) -> tuple[np.ndarray, Placement]:
    """The (h, w, 3) uint8 image, evenly scaled and centred in (height, width, 3) of grey."""
    rows, columns = picture.shape[:2]
    scale = min(height / rows, width / columns)
    inner = (max(1, round(columns * scale)), max(1, round(rows * scale)))
    # An odd pixel of padding goes to the right or the bottom.
    placement = Placement(scale, (width - inner[0]) // 2, (height - inner[1]) // 2)
    if (columns, rows) != inner:
        picture = cv2.resize(picture, inner, interpolation=cv2.INTER_LINEAR)
    padded = np.full((height, width, 3), PADDING, np.uint8)
    padded[placement.top:placement.top + inner[1],
           placement.left:placement.left + inner[0]] = picture
    return padded, placement


def to_picture(boxes: np.ndarray, placement: Placement, width: int, height: int) -> np.ndarray:
    """Boxes (n, 4) of left, top, right, bottom in the input, in px of an image of that size.

    Parts outside the image are cut off.
    """
    offset = (placement.left, placement.top) * 2
    return np.clip((boxes - offset) / placement.scale, 0, (width, height) * 2)
