"""Result files that are written completely or not at all, and whether there is room for them."""

from __future__ import annotations

import contextlib
import errno
import os
from pathlib import Path

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
