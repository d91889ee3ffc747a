"""Packages that this terminal does not see: hidden by a learner's own, or not sourced.

    python3 -m workspace_needs.hidden SETUP NAME...     SETUP: the courses' own setup.bash

The shell calls this only where a package hides one of the courses' (env-hooks of this package).
"""

import contextlib
import os
import sys
from collections.abc import Iterator
from pathlib import Path

DEEPEST = 3  # folders below src/ in which a package lies


def line(setup: str, names: list[str]) -> str:
    """What is hidden, and how to reach it."""
    return (f"Your own {', '.join(names)} hides the courses' package of that name: rosrun and "
            f"roslaunch take yours. In a terminal for the courses' type: source {setup}")


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


def main(words: list[str]) -> int:
    """Print the line; returns the exit code."""
    setup, *names = words
    print(line(setup, sorted(set(names))), file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
