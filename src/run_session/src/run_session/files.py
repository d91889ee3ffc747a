"""Files of a run: of packages, results written completely or not at all, growing logs."""

from __future__ import annotations

import contextlib
import errno
import os
import shlex
from pathlib import Path

import rospkg

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


def disk_of(path: Path) -> Path:
    """Where the disk of this file, which need not be there, is mounted, as `df` names it."""
    whole = path.absolute()
    return next(each for each in (whole, *whole.parents) if each.is_mount())


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


def world_argument(world: Path) -> str:
    """What roslaunch is told of a world's file; its path, which may have spaces, stays one word."""
    return f"world_name:={shlex.quote(str(world))}"


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
