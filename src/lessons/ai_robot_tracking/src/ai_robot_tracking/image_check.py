"""Checks that a camera image is usable: correctly encoded, not blank, not frozen."""

from __future__ import annotations

import numpy as np

CHANNELS = {"bgr8": 3, "rgb8": 3, "bgra8": 4, "rgba8": 4}  # supported encodings, all with colour
FROZEN_TIME = 0.5  # s with the same image while moving


class BadImage(ValueError):
    """One line that says what is wrong with an image."""


class BlankImage(BadImage):
    """All is of one colour: a camera's fault, or the target is all that it sees."""


def decode(encoding: str, width: int, height: int, step: int, data: bytes) -> np.ndarray:
    """The image (height, width, 3), uint8, BGR, from the fields of a sensor_msgs/Image.

    Raises BadImage if encoding, sizes and data are inconsistent.
    """
    channels = CHANNELS.get(encoding)
    if channels is None:
        raise BadImage(f"encoding '{encoding}' is not supported; use one of "
                       f"{', '.join(CHANNELS)}")
    row = width * channels
    if width == 0 or height == 0:
        raise BadImage(f"it is empty: {width} x {height} px")
    if step < row:
        raise BadImage(f"encoding '{encoding}' needs {row} bytes for a row of {width} px, but step "
                       f"is {step}")
    if len(data) != step * height:
        raise BadImage(f"{height} rows of {step} bytes are {step * height} bytes, but there are "
                       f"{len(data)}")
    rows = np.frombuffer(data, np.uint8).reshape(height, step)[:, :row]
    picture = rows.reshape(height, width, channels)[:, :, :3]
    return np.ascontiguousarray(picture if encoding.startswith("bgr") else picture[:, :, ::-1])


class ImageCheck:
    """Checks each image, in order."""

    def __init__(self) -> None:
        self._last: np.ndarray | None = None
        self._same_since = 0.0  # s
        self._frozen = False

    def look(self, picture: np.ndarray, time: float, moving: bool) -> None:
        """`picture` (rows, columns, 3) came at this time, s; `moving`: the robot should move.

        Raises BadImage for an image of a single colour, and for one that has stayed identical, byte
        by byte, for FROZEN_TIME while the robot should move, until a different one comes.
        """
        if self._last is None or not np.array_equal(picture, self._last):
            self._last, self._same_since, self._frozen = picture, time, False
        elif (not moving and not self._frozen) or time < self._same_since:
            self._same_since = time  # a standing robot sees no change, or time was reset
        if (picture == picture[0, 0]).all():
            raise BlankImage("it is blank: every pixel has the same colour")
        self._frozen = self._frozen or time - self._same_since >= FROZEN_TIME
        if self._frozen:
            raise BadImage("it is frozen: the same image again and again while the robot moves")
