"""Detects unusable images: wrongly encoded, blank, or frozen."""

from __future__ import annotations

import cv2
import numpy as np

CHANNELS = {"bgr8": 3, "rgb8": 3, "bgra8": 4, "rgba8": 4, "mono8": 1}
TO_BGR = {
    "rgb8": cv2.COLOR_RGB2BGR, "bgra8": cv2.COLOR_BGRA2BGR, "rgba8": cv2.COLOR_RGBA2BGR,
    "mono8": cv2.COLOR_GRAY2BGR,
}
SMALLEST = 80, 60  # px
EVERY = 8  # px; an image without contrast on this grid is blank


def mistake_in(encoding: str, width: int, height: int, step: int, length: int) -> str | None:
    """The error in an image message's fields, in a few words; None if there is none."""
    if encoding not in CHANNELS:
        return f"encoding '{encoding}' is unknown here; known: {', '.join(CHANNELS)}"
    if width < SMALLEST[0] or height < SMALLEST[1]:
        return f"{width}x{height} pixels are too few, {SMALLEST[0]}x{SMALLEST[1]} is the least"
    row = width * CHANNELS[encoding]
    if step < row:
        return f"step is {step}, but {width} pixels of {encoding} need {row} bytes a row"
    if length != step * height:
        return f"{length} bytes of data, but {height} rows of {step} bytes are {step * height}"
    return None


def picture_of(encoding: str, width: int, height: int, step: int, data: bytes) -> np.ndarray:
    """(height, width, 3) uint8 BGR from an image message's fields, checked by `mistake_in`.

    Not with cv_bridge: Debian 12's skews images with padded rows.
    """
    rows = np.frombuffer(data, np.uint8).reshape(height, step)[:, : width * CHANNELS[encoding]]
    pixels = np.ascontiguousarray(rows.reshape(height, width, CHANNELS[encoding]))
    return cv2.cvtColor(pixels, TO_BGR[encoding]) if encoding in TO_BGR else pixels


def is_blank(image: np.ndarray, contrast: float) -> bool:
    """Whether the brightness of an image (h, w, 3) hardly varies; `contrast` is of 255."""
    return float(image[::EVERY, ::EVERY].std(axis=(0, 1)).max()) < contrast


class FrozenWatch:
    """Detects that the camera repeats the same image, byte by byte, while the robot should move."""

    def __init__(self, patience: float):
        self._patience = patience  # s
        self._image: np.ndarray | None = None
        self._since = 0.0  # s, when this image first came, or the robot was last stopped
        self.frozen = False

    def see(self, image: np.ndarray, now: float, moving: bool) -> bool:
        """Whether the image is frozen. moving: whether the last command was to move.

        It stays frozen until a different image comes: only then does the camera work again.
        """
        same = self._image is not None and np.array_equal(image, self._image)
        if not same or (not moving and not self.frozen) or now < self._since:
            self._image, self._since, self.frozen = image, now, False
        elif now - self._since >= self._patience:
            self.frozen = True
        return self.frozen
