"""Locates this package's files, in the source tree or installed, and where a user's are kept."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import rospkg

HERE = Path(__file__).resolve().parents[2]


def package_folder() -> Path:
    """The folder with cmake/, data/ and rosdep/."""
    if (HERE / "rosdep").is_dir():
        return HERE
    return Path(rospkg.RosPack().get_path("workspace_needs"))


def kept_folder(name: str) -> Path:
    """A folder in ~/.ros, or in /tmp if that is not writable; it need not exist."""
    parent = Path(os.environ.get("ROS_HOME") or Path.home() / ".ros")
    try:
        parent.mkdir(parents=True, exist_ok=True)
        if os.access(parent, os.W_OK):
            return parent / name
    except OSError:
        pass
    return Path(tempfile.gettempdir()) / f"{name}-{os.geteuid()}"


def hook() -> list[str]:
    """The option by which CMake includes missing_headers.cmake after a package's project()."""
    file = "cmake/missing_headers.cmake"
    beside = HERE.parent / "interfaces/missing_headers"
    folder = beside if (beside / file).is_file() else (
        Path(rospkg.RosPack().get_path("missing_headers")))
    return [f"-DCMAKE_PROJECT_INCLUDE={folder / file}"]


def release() -> str:
    """This machine's Debian release, such as bookworm."""
    for line in Path("/etc/os-release").read_text("utf-8").splitlines():
        name, _, value = line.partition("=")
        if name == "VERSION_CODENAME":
            return value.strip('"')
    return ""
