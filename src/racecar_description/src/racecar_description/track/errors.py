"""What can be wrong with a track, and where in the picture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


class TrackError(Exception):
    """A track that cannot be made; the text says what is wrong, where, and what to do."""


@dataclass(frozen=True)
class Mark:
    """A place in a picture that is worth a circle."""

    x_px: float
    y_px: float
    text: str


class DrawingError(TrackError):
    """A drawing without a usable road; the marks are in pixels of `picture`, BGR as it was read."""

    def __init__(self, text: str, picture: np.ndarray, marks: list[Mark] | None = None):
        super().__init__(text)
        self.picture = picture
        self.marks = marks or []


@dataclass(frozen=True)
class Fault:
    """What is wrong with one way of reading a drawing: a kind, a sentence, places."""

    kind: str  # "blank", "open" or "crossing"
    text: str
    marks: tuple[Mark, ...] = ()
