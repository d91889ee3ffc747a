"""Locates this package's files, in the source tree or installed."""

from __future__ import annotations

from pathlib import Path

import rospkg

HERE = Path(__file__).resolve().parents[2]


def package_folder() -> Path:
    """The folder with data/ and rosdep/."""
    if (HERE / "rosdep").is_dir():
        return HERE
    return Path(rospkg.RosPack().get_path("workspace_needs"))


def release() -> str:
    """This machine's Debian release, such as bookworm."""
    for line in Path("/etc/os-release").read_text("utf-8").splitlines():
        name, _, value = line.partition("=")
        if name == "VERSION_CODENAME":
            return value.strip('"')
    return ""
