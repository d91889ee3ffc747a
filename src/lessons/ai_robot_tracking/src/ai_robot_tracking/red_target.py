"""Finds the red target in an image: mask, blobs, and distance from their size."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np

KERNEL = np.ones((3, 3), np.uint8)
PASSES = 2  # of erosion, then of dilation, to remove specks
HIGH_ENOUGH = 0.7  # least share of the target's height at which a column belongs to it
EDGE_PX = 2  # a blob this close to the image's edge counts as cut off


@dataclass(frozen=True)
class Colour:
    """Bounds in HSV: hue 0..180, saturation and value 0..255.

    If hue_low is larger than hue_high, the range passes through 180, which equals 0.
    """

    hue_low: float
    hue_high: float
    saturation_low: float
    value_low: float


@dataclass(frozen=True)
class Blob:
    """One connected component of the mask: its bounding box and enclosing circle, px."""

    left: int
    top: int
    width: int
    height: int
    column: float  # of the circle's centre
    row: float
    radius: float
    area: float

    @property
    def fill(self) -> float:
        """The share of its box that it covers."""
        return self.area / (self.width * self.height)


def red_mask(picture: np.ndarray, colour: Colour) -> np.ndarray:
    """Mask (rows, columns) of a BGR image: 255 where it has this colour, else 0; no specks."""
    hsv = cv2.cvtColor(picture, cv2.COLOR_BGR2HSV)
    low, high = colour.hue_low, colour.hue_high
    spans = [(low, high)] if low <= high else [(low, 180), (0, high)]
    mask = np.zeros(picture.shape[:2], np.uint8)
    for start, end in spans:
        mask |= cv2.inRange(hsv, (start, colour.saturation_low, colour.value_low), (end, 255, 255))
    mask = cv2.erode(mask, KERNEL, iterations=PASSES)
    return cv2.dilate(mask, KERNEL, iterations=PASSES)


def all_red(picture: np.ndarray, colour: Colour) -> bool:
    """Whether each pixel of a BGR image has this colour."""
    return bool(red_mask(picture, colour).all())


def find_blobs(mask: np.ndarray, least_radius: float) -> list[Blob]:
    """All blobs with an enclosing circle larger than this radius (px), largest area first."""
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)
    found = []
    for contour in sorted(contours, key=cv2.contourArea, reverse=True):
        (column, row), radius = cv2.minEnclosingCircle(contour)
        if radius > least_radius:
            found.append(Blob(*cv2.boundingRect(contour), column, row, radius,
                              cv2.contourArea(contour)))
    return found


def focal_length(width: int, hfov: float) -> float:
    """Focal length, px, of an image of this width (px) and horizontal field of view (rad)."""
    return width / 2 / math.tan(hfov / 2)


def bearing_of(blob: Blob, width: int, hfov: float) -> float:
    """rad to the left of the camera's axis, midway between the blob's two sides."""
    focal = focal_length(width, hfov)
    left, right = width / 2 - blob.left, width / 2 - (blob.left + blob.width)
    return (math.atan2(left, focal) + math.atan2(right, focal)) / 2


def distance_of(blob: Blob, shape: tuple[int, int], hfov: float, radius: float,
                height: float) -> float:
    """m from the camera to the axis of an upright cylinder (radius, height, m), from its size.

    `shape`: the image's rows and columns. If the image's edge or an object hides a part of it, it
    looks smaller, so the larger of its two apparent sizes counts.
    """
    focal = focal_length(shape[1], hfov)
    aslant = math.cos(bearing_of(blob, shape[1], hfov))
    by_height = height * focal / (blob.height * aslant) + radius  # its near side is visible
    by_width = math.hypot(radius, 2 * radius * focal / (blob.width * aslant**2))
    return min(by_height, by_width)


def looks_upright(blob: Blob, shape: tuple[int, int], radius: float, height: float) -> bool:
    """Whether the blob has the shape of such a cylinder; not checked if the image cuts it off."""
    rows, columns = shape
    if (blob.left <= EDGE_PX or blob.left + blob.width >= columns - EDGE_PX
            or blob.top <= EDGE_PX or blob.top + blob.height >= rows - EDGE_PX):
        return True
    slender = (blob.height / blob.width) / (height / (2 * radius))
    return 0.75 < slender < 1.35 and blob.fill > 0.85


def split_off(mask: np.ndarray, blob: Blob, column: float, height: float) -> Blob:
    """The part of a blob that is as tall as the target, if a lower red object touches it.

    `column` (px) is where the target's middle is expected, `height` (px) its height there.
    """
    piece = mask[blob.top:blob.top + blob.height, blob.left:blob.left + blob.width] > 0
    heights = np.count_nonzero(piece, axis=0)
    high = heights >= HIGH_ENOUGH * min(height, heights.max())
    borders = np.flatnonzero(np.diff(np.concatenate(([False], high, [False]))))
    begin, end = min(zip(borders[::2], borders[1::2], strict=True),
                     key=lambda run: abs(blob.left + (run[0] + run[1]) / 2 - column))
    rows = np.flatnonzero(piece[:, begin:end].any(axis=1))
    left, top = blob.left + int(begin), blob.top + int(rows[0])
    wide, tall = int(end - begin), int(rows[-1] - rows[0] + 1)
    return Blob(left, top, wide, tall, left + wide / 2, top + tall / 2,
                math.hypot(wide, tall) / 2, float(np.count_nonzero(piece[:, begin:end])))
