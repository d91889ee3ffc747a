"""Image files as arrays for surfaces."""

from __future__ import annotations

import logging

import cv2
import numpy as np

from bullet_sim.errors import FormatError
from bullet_sim.meshes.images import read_image, shrunk

log = logging.getLogger(__name__)


def load_image(path: str, largest_px: int) -> np.ndarray | None:
    """(height, width, 4) uint8 RGBA, opaque, bottom row first; None, with a warning, if unreadable.

    An image larger than `largest_px` on a side is shrunk to fit.
    """
    try:
        image = read_image(path, cv2.IMREAD_COLOR)
    except FormatError as error:
        log.warning("texture %s; left out", error)
        return None
    shrink = largest_px / max(image.shape[:2])
    if shrink < 1:
        image = shrunk(image, shrink)
    return np.ascontiguousarray(cv2.cvtColor(image, cv2.COLOR_BGR2RGBA)[::-1])
