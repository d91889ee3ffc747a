"""Reads a file that somebody else named: it may be a pipe, a device, or endless."""

from __future__ import annotations

import errno
import stat
from pathlib import Path


def read_file(path: Path, largest: int) -> bytes:
    """Its content, but never more than `largest` + 1 bytes: so many mean that it is too large.

    Raises OSError, whose strerror says why, also for what is no plain file: to open a pipe would
    keep its reader for ever.
    """
    try:
        found = path.stat()
    except ValueError:
        raise OSError(errno.EINVAL, "its name has a zero byte in it") from None
    kind = found.st_mode
    if not (stat.S_ISREG(kind) or stat.S_ISDIR(kind)):  # of a folder, open says it
        raise OSError(errno.EINVAL, "it is a pipe or device, not a file")
    with path.open("rb") as file:
        return file.read(min(found.st_size, largest) + 1)  # as much memory is taken at once
