"""Files named by the user: a pipe, a device or an endless one; names that nobody has expanded."""

from __future__ import annotations

import errno
import os
import re
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
