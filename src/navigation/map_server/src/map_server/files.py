"""Reads a file given by the user, which may be a pipe, a device, or endless."""

from __future__ import annotations

import errno
import stat
from pathlib import Path


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
