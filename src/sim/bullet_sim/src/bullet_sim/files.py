"""Checks a file named by a model before it is opened: reading a pipe would block."""

import os
import stat
from pathlib import Path
from urllib.parse import unquote

from bullet_sim.errors import FormatError


def check_file(path: Path | str, largest: int, advice: str = "") -> os.stat_result:
    """The file's status; FormatError, one line that begins with the path, if it must not be opened.

    It must be a regular file of at most `largest` bytes; `advice` says how to make it smaller.
    """
    try:
        status = os.stat(path)
    except (OSError, ValueError) as error:  # ValueError: a name that contains a zero byte
        raise FormatError(
            f"{path} cannot be read: {getattr(error, 'strerror', None) or error}") from None
    if not stat.S_ISREG(status.st_mode):
        kind = "a folder" if stat.S_ISDIR(status.st_mode) else "a pipe or device"
        raise FormatError(f"{path} cannot be read: it is {kind}, not a file")
    if status.st_size > largest:
        raise FormatError(f"{path} cannot be read: {status.st_size / 1e6:.0f} MB, "
                          f"more than {largest / 1e6:.0f}{'; ' if advice else ''}{advice}")
    return status


def find_beside(name: str, folder: Path) -> Path | None:
    """A file that one in `folder` names: by path, or by name, as paths are of other machines."""
    name = unquote(name.replace("\\", "/"))
    for path in (folder / name, folder / Path(name).name):
        if os.path.isfile(path):  # Path.is_file raises for a name that is too long
            return path
    return None
