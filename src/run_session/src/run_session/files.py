"""Result files that are written completely or not at all."""

from __future__ import annotations

import contextlib
from pathlib import Path


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
