"""Reads and writes maps in the format of map_server and map_saver; needs no ROS."""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np

from map_server.errors import MapFileError
from map_server.files import unexpanded
from map_server.image import MapImage, read_image
from map_server.metadata import MapMetadata, read_metadata
from nav_algorithms.cells import FREE, OCCUPIED, UNKNOWN, OccupancyGrid

WHITE, GREY, BLACK = 254, 205, 0  # values written for free, unknown and occupied cells


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
