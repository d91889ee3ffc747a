"""Reads image files named by a model, after a check of their unpacked size."""

import logging
import os
import struct
from pathlib import Path

import cv2
import numpy as np

from bullet_sim.errors import FormatError
from bullet_sim.files import check_file

log = logging.getLogger(__name__)

LARGEST_FILE = 100 * 10**6  # bytes
MOST_PIXELS = 100 * 10**6  # 10 000 x 10 000: 300 MB while it is read
SILENT = 0  # OpenCV's log level: our own line replaces its messages
HEADER_BYTES = 2**16  # JPEG's size may come after a preview
PNG = b"\x89PNG\r\n\x1a\n"
JPEG = b"\xff\xd8"
# Its name up to about OpenCV 4.12, and the later one; both return the previous level.
set_log_level = getattr(cv2, "setLogLevel", None) or cv2.utils.logging.setLogLevel
JPEG_SIZES = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}  # markers of a frame's header


def check_image(path: Path | str) -> os.stat_result:
    """The file's status; FormatError, one line that begins with the path, if it is too large."""
    status = check_file(path, LARGEST_FILE, "make it smaller")
    try:
        with open(path, "rb") as file:
            size = image_size(file.read(HEADER_BYTES))
    except OSError as error:
        raise FormatError(f"{path} cannot be read: {error.strerror}") from None
    if size and 0 in size:
        raise FormatError(f"{path} cannot be read: it has no pixels")
    if size and size[0] * size[1] > MOST_PIXELS:
        raise FormatError(f"{path} cannot be read: {size[0]} x {size[1]} pixels, more than "
                          f"{MOST_PIXELS // 10**6} million; make it smaller")
    return status


def warn_if_unreadable(path: str) -> None:
    """One line for a texture that cannot be shown; its pixels are not unpacked for that."""
    try:
        check_image(path)
        if not cv2.haveImageReader(path):
            raise FormatError(f"{path} cannot be read: it is not an image; give a PNG or JPEG")
    except FormatError as error:
        log.warning("texture %s; left out", error)


def read_image(path: Path | str, flags: int, advice: str = "give a PNG or JPEG") -> np.ndarray:
    """(height, width[, 3]) by OpenCV's `flags`; FormatError as `check_image`, with `advice`."""
    check_image(path)
    before, reason = set_log_level(SILENT), "it is damaged, or no image"
    try:
        image = cv2.imread(str(path), flags)
    except cv2.error:  # the size of an unchecked format is beyond OpenCV's limit
        reason = f"it has more than {MOST_PIXELS // 10**6} million pixels, or a long side"
        image, advice = None, "make it smaller"
    finally:
        set_log_level(before)
    if image is None:
        raise FormatError(f"{path} cannot be read: {reason}; {advice}")
    return image


def shrunk(image: np.ndarray, factor: float) -> np.ndarray:
    """The image with its sides times `factor`, below 1, and at least one pixel each."""
    size = [max(1, round(side * factor)) for side in image.shape[1::-1]]
    return cv2.resize(image, size, interpolation=cv2.INTER_AREA)


def image_size(header: bytes) -> tuple[int, int] | None:
    """Width and height, px, from the first bytes of a PNG or JPEG; None if they do not give it."""
    if header.startswith(PNG) and len(header) >= 24:
        return struct.unpack(">II", header[16:24])
    if not header.startswith(JPEG):
        return None
    place = 2
    while place + 9 <= len(header) and header[place] == 0xFF:
        marker, length = header[place + 1], int.from_bytes(header[place + 2:place + 4], "big")
        if marker in JPEG_SIZES:
            height, width = struct.unpack(">HH", header[place + 5:place + 9])
            return width, height
        place += 2 + length
    return None


def load_image(path: str, largest_px: int) -> np.ndarray | None:
    """(height, width, 4) uint8 RGBA, opaque, bottom row first; None, with a warning, if unreadable.

    An image larger than `largest_px` on a side is reduced to fit.
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
