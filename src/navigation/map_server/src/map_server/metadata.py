"""The YAML file of a map, checked key by key.

A file that the user names may be a pipe, a device or endless, or its name unexpanded (~).
"""

from __future__ import annotations

import errno
import math
import os
import re
import reprlib
import stat
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml
from node_basics.bounded_yaml import BoundedLoader

from map_server.errors import MapMetadataError, MapMissingError

MODES = ("trinary", "scale", "raw")
LARGEST = 1 << 20  # bytes; a description has a few hundred
LONGEST_NAME = 1024  # characters; Linux allows paths of at most 4096 bytes
FINEST, COARSEST = 1e-6, 1000.0  # m per pixel; in a message's float32 1e-46 is 0, and 4e38 inf
FARTHEST = 1e9  # m from 0; near 1e300 calculations overflow
IMAGE = re.compile(rb"P[1-6]\s|\x89PNG|\xff\xd8\xff|BM|GIF8")  # magic numbers of image files
EXAMPLES = {
    "image": "image: map.pgm",
    "resolution": "resolution: 0.05",
    "origin": "origin: [-10.0, -10.0, 0.0]",
    "negate": "negate: 0",
    "occupied_thresh": "occupied_thresh: 0.65",
    "free_thresh": "free_thresh: 0.196",
    "mode": "mode: trinary",
}


def read_file(path: Path, largest: int) -> bytes:
    """Its content, but at most `largest` + 1 bytes, which means that it is too large.

    Raises OSError, whose strerror says why, also for anything but a regular file: opening a pipe
    could block for ever.
    """
    try:
        found = path.stat()
    except ValueError:
        raise OSError(errno.EINVAL, "its name has a zero byte in it") from None
    kind = found.st_mode
    if not (stat.S_ISREG(kind) or stat.S_ISDIR(kind)):  # for a folder, open() raises the error
        raise OSError(errno.EINVAL, "it is a pipe or device, not a file")
    with path.open("rb") as file:
        return file.read(min(found.st_size, largest) + 1)  # allocated at once


def unexpanded(name: str) -> str:
    """What to write for a name that a shell or roslaunch would have expanded; "" if it is plain.

    Quotes keep a shell from it; in a launch file's `args` there is no shell.
    """
    first, _, rest = name.partition("/")
    if first == "~":
        return f"~ is not expanded here: write {Path.home() / rest}"
    if found := re.match(r"\$\(find ([\w-]+)\)(.*)", name):
        return (f"$(find {found[1]}) is expanded in launch files only: write "
                f'"$(rospack find {found[1]}){found[2]}"')
    if first.startswith("$"):
        value = os.environ.get(first.strip("${}"))
        folder = str(Path(value) / rest) if value else "the path itself"
        return f"{first} is not expanded here: write {folder}"
    return ""


@dataclass(frozen=True)
class MapMetadata:
    """How to convert the image to a map; thresholds are probabilities, 0 to 1."""

    image: Path
    resolution: float  # m a pixel
    origin: tuple[float, float] = (0.0, 0.0)  # (x, y), m, of the lower left corner
    yaw: float = 0.0  # rad
    negate: bool = False  # true: white is occupied
    occupied_thresh: float = 0.65
    free_thresh: float = 0.196
    mode: str = "trinary"


def read_metadata(path: Path) -> MapMetadata:
    """The description in a YAML file; raises MapMissingError or MapMetadataError.

    Unknown keys are ignored, as in upstream.
    """
    keys = _Keys(path, _load(path))
    image = keys.text("image")
    resolution = keys.number("resolution")
    if resolution <= 0:
        raise keys.wrong("resolution", "must be above 0 m a pixel")
    if not FINEST <= resolution <= COARSEST:
        raise keys.wrong("resolution", f"must be from {FINEST:g} to {COARSEST:g} m a pixel")
    x, y, yaw = keys.numbers("origin", "[x, y, yaw] in m, m, rad", 3)
    if max(abs(x), abs(y)) > FARTHEST:
        raise keys.wrong("origin", f"its x and y must be from -{FARTHEST:g} to {FARTHEST:g} m")
    occupied, free = keys.probability("occupied_thresh"), keys.probability("free_thresh")
    if free > occupied:
        raise keys.wrong("free_thresh", f"is above occupied_thresh, {occupied:g}: the two are the "
                                        f"wrong way round")
    mode = keys.text("mode") if "mode" in keys.values else "trinary"
    if mode not in MODES:
        raise keys.wrong("mode", f"must be {' or '.join(MODES)}")
    return MapMetadata(path.parent / image, resolution, (x, y), yaw, keys.flag("negate"),
                       occupied, free, mode)


def _load(path: Path) -> dict[str, Any]:
    try:
        content = read_file(path, LARGEST)
    except (FileNotFoundError, NotADirectoryError):
        if advice := unexpanded(str(path)):
            raise MapMissingError(advice) from None
        meant = path.with_suffix(".yaml")
        advice = meant if os.path.isfile(meant) else "the path of a map's YAML file"
        raise MapMissingError(f"{path}: there is no such file; write {advice}") from None
    except OSError as error:
        raise MapMissingError(f"{path}: cannot be read: {error.strerror}") from None
    if IMAGE.match(content):
        raise MapMetadataError(f"{path}: is an image; write the YAML file that belongs to it, "
                               f"such as {path.with_suffix('.yaml').name}")
    if len(content) > LARGEST:
        raise MapMetadataError(f"{path}: is not a map's YAML file: it has more than {LARGEST} "
                               f"bytes")
    try:
        found = yaml.load(content, BoundedLoader)
    except Exception as error:  # PyYAML also raises KeyError, IndexError and more
        reason = " ".join(str(error).split())[:200]
        raise MapMetadataError(f"{path}: is not valid YAML: {reason}; write KEY: VALUE lines such "
                               f"as {EXAMPLES['resolution']}") from None
    if not isinstance(found, dict):
        raise MapMetadataError(f"{path}: must hold KEY: VALUE lines such as {EXAMPLES['image']}")
    return found


class _Keys:
    """The values by key, each checked when read."""

    def __init__(self, path: Path, values: dict[str, Any]) -> None:
        self.path, self.values = path, values

    def wrong(self, key: str, what: str) -> MapMetadataError:
        """The error for a key's value."""
        value = reprlib.repr(self.values[key])[:80]  # YAML aliases can expand to 10^9 values
        return MapMetadataError(f"{self.path}: {key} is {value}, but {what}; write for example "
                                f"{EXAMPLES[key]}")

    def text(self, key: str) -> str:
        value = self._value(key)
        if not isinstance(value, str) or not value or "\0" in value:
            raise self.wrong(key, "must be text")
        if len(value) > LONGEST_NAME:
            raise self.wrong(key, f"has more than {LONGEST_NAME} characters")
        return value

    def number(self, key: str) -> float:
        found = _finite(self._value(key))
        if found is None:
            raise self.wrong(key, "must be a number")
        return found

    def flag(self, key: str) -> bool:
        value = self._value(key)
        if not isinstance(value, bool) and _finite(value) not in (0, 1):
            raise self.wrong(key, "must be 0 or 1")
        return bool(float(value))

    def probability(self, key: str) -> float:
        found = self.number(key)
        if not 0 <= found <= 1:
            raise self.wrong(key, "must be between 0 and 1")
        return found

    def numbers(self, key: str, meaning: str, count: int) -> list[float]:
        value = self._value(key)
        found = [_finite(number) for number in value] if isinstance(value, list) else []
        if len(found) != count or None in found:
            raise self.wrong(key, f"must be {meaning}")
        return found

    def _value(self, key: str) -> Any:
        if key not in self.values:
            raise MapMetadataError(f"{self.path}: has no {key}; write for example "
                                   f"{EXAMPLES[key]}")
        return self.values[key]


def _finite(value: Any) -> float | None:
    """A finite number, also one that PyYAML reads as text (5e-2); None for everything else."""
    if isinstance(value, bool):
        return None
    try:
        found = float(value)
    except (TypeError, ValueError, OverflowError):
        return None
    return found if math.isfinite(found) else None
