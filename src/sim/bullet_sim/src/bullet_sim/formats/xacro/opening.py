"""Opens files for xacro: only regular ones, with limits of size, number and self-inclusion."""

import errno
import os
from pathlib import Path
from typing import Any
from xml.dom import minidom

import xacro

from bullet_sim.errors import FormatError, nearest_file
from bullet_sim.files import check_file
from bullet_sim.formats.xacro.bounds import TooLarge
from bullet_sim.formats.xacro.errors import includes_itself, place

MOST_FILES = 2000  # includes; large robots have 100
LARGEST_FILE = 8 * 10**6  # bytes; large robots have 100 kB
REPEATED = 20  # a file this often in the stack of includes includes itself
_xacros_load_yaml = xacro.load_yaml


def parse(_source: object, filename: str) -> minidom.Document:
    """Read bytes, so that the file's own encoding counts and not the terminal's.

    TooLarge beyond MOST_FILES, XacroException for a file that cannot be read.
    """
    if len(xacro.all_includes) > MOST_FILES:
        raise TooLarge(f"{place('xacro')}: more than {MOST_FILES} files are included; include each "
                       "once and call its macros")
    if [os.path.normpath(name) for name in xacro.filestack].count(
            os.path.normpath(filename)) > REPEATED:
        raise TooLarge(f"{place('xacro')}: {includes_itself(xacro.filestack)}")
    try:
        _check(filename)
        content = Path(filename).read_bytes()
    except OSError as error:
        xacro.filestack.pop()  # the error is reported for the including file
        raise xacro.XacroException(_unreadable(filename, error), exc=error) from error
    return minidom.parseString(content)


def load_yaml(filename: str) -> Any:
    """Replaces xacro's; FormatError for a file that cannot be read or is nested too deep."""
    try:
        _check(xacro.abs_filename_spec(filename))
        return _xacros_load_yaml(filename)
    except OSError as error:
        raise FormatError(_unreadable(filename, error)) from None
    except RecursionError:
        raise FormatError(f"{filename} is nested too deep; flatten it") from None


def _check(filename: str) -> None:
    """OSError for anything that exists and is not a regular file: reading a pipe would block."""
    if os.path.exists(filename):
        try:
            check_file(filename, LARGEST_FILE, "split it, or use macros for repeated parts")
        except FormatError as error:
            reason = str(error).removeprefix(f"{filename} cannot be read: ")
            raise OSError(errno.EINVAL, reason) from None


def _unreadable(filename: str, error: OSError) -> str:
    if isinstance(error, FileNotFoundError):
        return f"{filename} does not exist{nearest_file(filename)}"
    return f"{filename} cannot be read: {error.strerror}"
