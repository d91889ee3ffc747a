"""Errors of a track, and their places in the picture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


class TrackError(Exception):
    """The track cannot be made; the text says why, where, and what to do."""


@dataclass(frozen=True)
class Mark:
    """A place in a picture to circle."""

    x_px: float
    y_px: float
    text: str


class DrawingError(TrackError):
    """The drawing has no usable road; the marks are in pixels of `picture`, BGR, as read."""

    def __init__(self, text: str, picture: np.ndarray, marks: list[Mark] | None = None):
        super().__init__(text)
        self.picture = picture
        self.marks = marks or []
