"""The image of a map: its size is checked before OpenCV decodes it."""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from map_server.errors import MapImageError
from map_server.files import read_file

LARGEST = 1 << 27  # pixels: 579 m to a side at 5 cm
LARGEST_FILE = 8 * LARGEST  # bytes: four channels of 16 bits, not compressed
GAP = rb"(?:\s|#[^\n]*\n)+"
PNM = re.compile(rb"P([1-6])%b(\d{1,9})%b(\d{1,9})(?:%b(\d{1,5}))?" % (GAP, GAP, GAP))
PNG = re.compile(rb"\x89PNG\r\n\x1a\n....IHDR(....)(....)", re.DOTALL)


@dataclass(frozen=True)
class MapImage:
    """Brightness of pixels, image row 0 first."""

    sums: np.ndarray  # (rows, columns) uint16, 0 to 255 * channels: the colours' sum
    channels: int  # 1 or 3, without alpha
    transparent: np.ndarray | None  # (rows, columns) bool: fully transparent; None without alpha


def read_image(path: Path) -> MapImage:
    """Reads any format of OpenCV's; raises MapImageError. Deeper images are converted to 8 bits."""
    try:
        content = read_file(path, LARGEST_FILE)
    except (FileNotFoundError, NotADirectoryError):
        raise MapImageError(f"{path}: there is no such image; image: is a path beside the YAML "
                            f"file, or one that begins with /") from None
    except OSError as error:
        raise MapImageError(f"{path}: cannot be read: {error.strerror}") from None
    if len(content) > LARGEST_FILE:
        raise MapImageError(f"{path}: is too large for a map, more than {LARGEST_FILE >> 20} MiB; "
                            f"save it as PNG")
    width, height, brightest = _header(content)
    _check_size(path, width, height)
    pixels = _decode(path, content)
    _check_size(path, pixels.shape[1], pixels.shape[0])
    levels = _to_8_bits(path, pixels, brightest)
    if levels.ndim == 2:
        return MapImage(levels.astype(np.uint16), 1, None)
    sums = levels[:, :, :3].sum(axis=2, dtype=np.uint16)
    return MapImage(sums, 3, levels[:, :, 3] == 0 if levels.shape[2] == 4 else None)


def _header(content: bytes) -> tuple[int, int, int]:
    """(width, height, value of white) from the file's header; 0 if not found there.

    White only for binary PGM and PPM; OpenCV scales text ones itself.
    """
    if found := PNM.match(content):
        return int(found[2]), int(found[3]), int(found[4] or 0) if found[1] in b"56" else 0
    if found := PNG.match(content):
        return *struct.unpack(">II", found[1] + found[2]), 0
    return 0, 0, 0


def _check_size(path: Path, width: int, height: int) -> None:
    if width * height > LARGEST:
        raise MapImageError(f"{path}: {width} x {height} pixels are too many for a map, at most "
                            f"{LARGEST}: cut it, or make it smaller with a larger resolution")


def _decode(path: Path, content: bytes) -> np.ndarray:
    """(rows, columns) or (rows, columns, 3 or 4)."""
    if content[:2] in (b"P1", b"P2", b"P3"):
        content += b"\n"  # otherwise OpenCV misses the last number
    told = cv2.setLogLevel(0)  # else OpenCV logs the error, too
    try:
        pixels = cv2.imdecode(np.frombuffer(content, np.uint8), cv2.IMREAD_UNCHANGED)
    except cv2.error:
        pixels = None
    finally:
        cv2.setLogLevel(told)
    if pixels is None or not pixels.size:
        raise MapImageError(f"{path}: is not an image, or a damaged one ({len(content)} bytes); a "
                            f"PGM or PNG file is wanted")
    return pixels


def _to_8_bits(path: Path, pixels: np.ndarray, brightest: int) -> np.ndarray:
    """The pixels scaled to white at 255; `brightest`: white's value in the file, 0 if unknown."""
    if pixels.dtype not in (np.uint8, np.uint16):
        raise MapImageError(f"{path}: has pixels of type {pixels.dtype}; save it with 8 bits")
    white = brightest or np.iinfo(pixels.dtype).max
    if white == 255:
        return pixels
    table = np.minimum(np.rint(np.arange(np.iinfo(pixels.dtype).max + 1) * (255 / white)), 255)
    return table.astype(np.uint8)[pixels]
