"""Result files that are whole or not there."""

from __future__ import annotations

import contextlib
from pathlib import Path


def write_whole(path: Path, content: bytes) -> None:
    """Written beside it first: a run that is ended, or a full disk, leaves the last file whole.

    OSError names the file.
    """
    half = path.with_name(f"{path.name}.tmp")
    try:
        half.write_bytes(content)
        half.replace(path)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from error
    finally:
        with contextlib.suppress(OSError):  # it has become the file, or never was
            half.unlink()
