"""Finds a package in a built workspace that this terminal has not sourced."""

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

DEEPEST = 3  # folders below src/ in which a package lies


def unsourced(package: str) -> str:
    """The end of a line on a missing package: what to type if a built workspace nearby has it.

    Nearby: around the current folder, and below the home.
    """
    for workspace in _workspaces():
        manifests = (found for depth in range(1, DEEPEST + 1)
                     for found in (workspace / "src").glob("*/" * depth + "package.xml"))
        if any(found.parent.name == package for found in manifests):
            return f"; its workspace is not sourced: source {workspace}/devel/setup.bash"
    return ""


def _workspaces() -> Iterator[Path]:
    """Built ones, the nearest first."""
    around: list[Path] = []
    with contextlib.suppress(FileNotFoundError):  # the current folder was removed
        around = [Path.cwd(), *Path.cwd().parents]
    for folder in (*around, *sorted(Path.home().glob("*"))):
        # Not Path.is_file, which raises PermissionError below a folder that is somebody else's.
        if os.path.isfile(folder / "devel/setup.bash"):
            yield folder
