"""Reads and writes maps in the format of map_server and map_saver; needs no ROS.

An image's size is checked before OpenCV decodes it.
"""

from __future__ import annotations

import json
import os
import re
import struct
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from map_server.errors import MapFileError, MapImageError
from map_server.metadata import MapMetadata, read_file, read_metadata, unexpanded
from nav_algorithms.cells import FREE, OCCUPIED, UNKNOWN, OccupancyGrid

LARGEST = 1 << 27  # pixels: 579 m to a side at 5 cm
LARGEST_FILE = 8 * LARGEST  # bytes: four channels of 16 bits, not compressed
GAP = rb"(?:\s|#[^\n]*\n)+"
PNM = re.compile(rb"P([1-6])%b(\d{1,9})%b(\d{1,9})(?:%b(\d{1,5}))?" % (GAP, GAP, GAP))
PNG = re.compile(rb"\x89PNG\r\n\x1a\n....IHDR(....)(....)", re.DOTALL)
WHITE, GREY, BLACK = 254, 205, 0  # values written for free, unknown and occupied cells


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


def read_map(path: Path | str) -> tuple[OccupancyGrid, float]:
    """The map of a YAML file, and the yaw, rad, that the file gives its origin.

    Raises MapFileError: one line that names the file, the key, and what to write.
    """
    return load_map(read_metadata(Path(path)))


def load_map(metadata: MapMetadata) -> tuple[OccupancyGrid, float]:
    """The map of a description, and its origin's yaw, rad. Raises MapImageError."""
    cells = cells_of(read_image(metadata.image), metadata)
    return OccupancyGrid(cells, metadata.resolution, metadata.origin), metadata.yaw


def cells_of(image: MapImage, metadata: MapMetadata) -> np.ndarray:
    """Cells int8 (rows, columns), row 0 the lowest, of an image.

    Alpha does not count as a colour; upstream averages it with the colours in trinary mode, so that
    grey pixels become free. Fully transparent pixels that are not dark are unknown. In raw mode
    pixels from 128 on become negative, as in upstream's int8.
    """
    mean = np.arange(255 * image.channels + 1) / image.channels
    if metadata.negate:
        mean = 255 - mean
    if metadata.mode == "raw":
        return _upright(mean.astype(np.uint8).view(np.int8)[image.sums])
    probability = (255 - mean) / 255
    is_occupied = probability > metadata.occupied_thresh
    is_free = probability < metadata.free_thresh
    between = np.full(mean.size, UNKNOWN)
    if metadata.mode == "scale":
        width = metadata.occupied_thresh - metadata.free_thresh or 1.0
        between = 1 + 98 * ((probability - metadata.free_thresh) / width).clip(0, 1)
    table = np.where(is_occupied, OCCUPIED, np.where(is_free, FREE, between)).astype(np.int8)
    cells = table[image.sums]
    if image.transparent is not None:
        cells[image.transparent & (cells != OCCUPIED)] = UNKNOWN
    return _upright(cells)


def _upright(cells: np.ndarray) -> np.ndarray:
    """Flips between an image, with row 0 at the top, and a map, with row 0 at the bottom."""
    return np.ascontiguousarray(np.flipud(cells))


def check_target(name: Path) -> None:
    """Raises MapFileError with one line if NAME.pgm and NAME.yaml cannot be written."""
    folder = name.parent
    if advice := unexpanded(str(name)):
        raise MapFileError(advice)
    if not folder.is_dir():
        raise MapFileError(f"{folder}: there is no such folder; make it first: mkdir -p {folder}")
    if not name.name.isprintable() or not name.name:
        raise MapFileError(f"{str(name)!r} is not a name for a map; write for example map")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise MapFileError(f"{folder}: is not yours to write in; choose another folder")
    for path in _files(name):
        if path.is_dir():
            raise MapFileError(f"{path}: is a folder; choose another name")


def write_map(name: Path | str, grid: OccupancyGrid, yaw: float = 0.0, occupied: int = 65,
              free: int = 25) -> tuple[Path, Path]:
    """Write NAME.pgm and NAME.yaml, completely or not at all; returns their paths.

    Cells from `occupied` on are black, those from 0 to `free` white, percent. `image:` has no
    folder in it: the two files may be moved together. Raises MapFileError.
    """
    check_target(name := Path(name))
    pgm, description = _files(name)
    parts = [(path.with_name(f".{path.name}.{os.getpid()}"), path) for path in (pgm, description)]
    try:
        for (part, _), content in zip(parts, (_pgm(grid, occupied, free),
                                              _yaml(pgm.name, grid, yaw)), strict=True):
            with part.open("wb") as file:
                file.write(content)
                os.fsync(file.fileno())
        for part, path in parts:
            part.replace(path)
    except OSError as error:
        raise MapFileError(f"{pgm}: cannot be written: {error.strerror}") from None
    finally:
        for part, _ in parts:
            part.unlink(missing_ok=True)
    return pgm, description


def _files(name: Path) -> tuple[Path, Path]:
    return name.with_name(f"{name.name}.pgm"), name.with_name(f"{name.name}.yaml")


def _pgm(grid: OccupancyGrid, occupied: int, free: int) -> bytes:
    cells = _upright(grid.cells)
    pixels = np.full(cells.shape, GREY, np.uint8)
    pixels[(cells >= FREE) & (cells <= free)] = WHITE
    pixels[cells >= occupied] = BLACK
    return b"P5\n# %.3f m/pix\n%d %d\n255\n" % (grid.resolution, *cells.shape[::-1]) \
        + pixels.tobytes()


def _yaml(image: str, grid: OccupancyGrid, yaw: float) -> bytes:
    """The YAML text, with the shortest exact numbers; a message's resolution is float32."""
    x, y, turn = (np.format_float_positional(number, trim="0") for number in (*grid.origin, yaw))
    resolution = np.format_float_positional(np.float32(grid.resolution), trim="0")
    return (f"image: {_quoted(image)}\nresolution: {resolution}\norigin: [{x}, {y}, {turn}]\n"
            f"negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n").encode()


def _quoted(text: str) -> str:
    """The text as a YAML value, unquoted if it has no special characters."""
    if all(letter.isalnum() or letter in "._-" for letter in text) and not text.startswith("-"):
        return text
    return json.dumps(text, ensure_ascii=False)
