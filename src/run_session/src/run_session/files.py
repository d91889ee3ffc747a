"""Result files that are whole or not there."""

from __future__ import annotations

from pathlib import Path


def write_whole(path: Path, content: bytes) -> None:
    """Written beside it first: a run that is killed, or a full disk, leaves the last file whole.

    OSError names the file.
    """
    half = path.with_name(f"{path.name}.tmp")
    try:
        half.write_bytes(content)
        half.replace(path)
    except OSError as error:
        half.unlink(missing_ok=True)
        raise OSError(error.errno, error.strerror, str(path)) from error
