"""Files of a run: of packages, in YAML, results written completely or not at all, growing logs."""

from __future__ import annotations

import contextlib
import errno
import math
import os
import reprlib
from collections.abc import Callable, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

import rospkg
import yaml

from run_session.failure import RunError

LEAST_SPACE = 2**20  # bytes; with less, logs of a drive may already be incomplete


def check_space(folder: Path) -> None:
    """OSError (ENOSPC), which names the folder, if its disk is full.

    Who could write nothing more cannot say why; and a drive without its logs proves nothing.
    """
    disk = os.statvfs(folder)
    if not disk.f_blocks:  # a network's or user's file system that does not count them
        return
    if disk.f_bavail * disk.f_frsize < LEAST_SPACE or (disk.f_files and not disk.f_favail):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(folder))


def write_whole(path: Path, content: bytes) -> None:
    """Write a file by way of a temporary one: if that fails, the previous file stays intact.

    An OSError names the file.
    """
    half = path.with_name(f"{path.name}.tmp")
    try:
        half.write_bytes(content)
        half.replace(path)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from error
    finally:
        with contextlib.suppress(OSError):  # it has been renamed, or was never created
            half.unlink()


class Tail:
    """Complete new lines of a file that grows."""

    def __init__(self, path: Path):
        self.path, self.read, self._rest = path, 0, b""  # bytes read

    def lines(self) -> list[str]:
        """The lines since the last call; none if there is no file."""
        try:
            with self.path.open("rb") as file:
                file.seek(self.read)
                data = file.read()
        except FileNotFoundError:
            return []
        self.read += len(data)
        *lines, self._rest = (self._rest + data).split(b"\n")
        return [line.decode("utf-8", "replace") for line in lines]

    def skip(self) -> None:
        """Skip the lines that are there."""
        self.lines()


def find_package(name: str) -> Path:
    """The folder of a package."""
    try:
        return Path(rospkg.RosPack().get_path(name))
    except rospkg.ResourceNotFound as error:
        raise RunError(f"package {name} not found: source devel/setup.bash") from error


def located(text: str) -> Path:
    """The path for a plain path or package://PACKAGE/PATH."""
    package, _, rest = text.removeprefix("package://").partition("/")
    return find_package(package) / rest if text.startswith("package://") else Path(text)


def load_record(kind: type, name: str, folder: Path) -> Any:
    """An instance of dataclass `kind` from NAME.yaml of a folder, or from the file of that path.

    Fields have one of the types in RULES. A RunError names file and key.
    """
    path = Path(name) if name.endswith(".yaml") else folder / f"{name}.yaml"
    if not name.endswith(".yaml") and not path.exists():
        known = ", ".join(sorted(found.stem for found in folder.glob("*.yaml")))
        what = folder.name[:-1]
        raise RunError(f"no {what} {name!r} (--{what}); there are: {known}")
    values = read_keys(path, [field.name for field in fields(kind)])
    for field in fields(kind):
        wanted, fits = RULES[field.type]
        if not fits(values[field.name]):
            raise RunError(f"{path}: {field.name}: must be {wanted}, is "
                           f"{reprlib.repr(values[field.name])[:80]}")
    return kind(**{key: _frozen(value) for key, value in values.items()})


def _frozen(value: object) -> object:
    return tuple(map(_frozen, value)) if isinstance(value, list) else value


def _is_number(value: object, least: float = -math.inf) -> bool:
    return type(value) in (int, float) and least <= value < math.inf


def _are(value: object, fits: Callable[[object], bool], count: int | None = None) -> bool:
    """Whether it is a list of `count` (None: any number of) values that fit."""
    return isinstance(value, list) and count in (None, len(value)) and all(map(fits, value))


def _is_text(value: object) -> bool:
    return isinstance(value, str)


Length = float  # positive: 0 makes no sense
RULES: dict[str, tuple[str, Callable[[object], bool]]] = {
    "str": ("a text", _is_text),
    "float": ("a number, 0 or more", lambda value: _is_number(value, 0.0)),
    "Length": ("a number above 0", lambda value: _is_number(value, 0.0) and value > 0),
    "tuple[str, str]": ("[package, file]", lambda value: _are(value, _is_text, 2)),
    "tuple[str, ...]": ("a list of topics", lambda value: _are(value, _is_text)),
    "tuple[float, float, float]": ("[x, y, yaw]", lambda value: _are(value, _is_number, 3)),
    "tuple[tuple[float, float], ...]": ("a list of [x, y]", lambda value: bool(value) and _are(
        value, lambda point: _are(point, _is_number, 2))),
}


def read_keys(path: Path, expected: Sequence[str]) -> dict:
    """The content of a YAML file that has exactly these keys; a RunError names file and key."""
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise RunError(f"{path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise RunError(f"{path}: not a text file") from error
    except Exception as error:  # PyYAML also raises KeyError, IndexError and more
        raise RunError(f"{path}: not valid YAML: {' '.join(str(error).split())[:200]}") from error
    if not isinstance(values, dict) or set(values) != set(expected):
        given = set(values) if isinstance(values, dict) else set()
        wrong = sorted(given - set(expected), key=str) or sorted(set(expected) - given)
        kind = "unknown" if given - set(expected) else "missing"
        raise RunError(f"{path}: {kind} key {wrong[0]!r:.80}; there are: {', '.join(expected)}")
    return values
