"""The versions of software that a run used."""

from __future__ import annotations

import importlib.metadata
import platform
import subprocess
from collections.abc import Iterable
from pathlib import Path

PACKAGES = ("pybullet", "moderngl", "opencv-python-headless", "numpy")
RENDERER_SAYS = "Cameras are drawn by"  # the simulator's log line


def versions(root: Path, log: Iterable[str]) -> dict:
    """Versions by name; the renderer is as the simulator logged it."""
    found = {"python": platform.python_version(), "machine": platform.platform()}
    for package in PACKAGES:
        try:
            found[package] = importlib.metadata.version(package)
        except importlib.metadata.PackageNotFoundError:
            found[package] = None
    drawn = (line.partition(RENDERER_SAYS)[2].strip() for line in log if RENDERER_SAYS in line)
    found["renderer"] = next(drawn, None)
    found["revision"] = _revision(root)
    return found


def _revision(root: Path) -> str | None:
    command = ["git", "-C", str(root), "describe", "--always", "--dirty"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=0.5, check=True)
    except (OSError, subprocess.SubprocessError):
        return None
    return done.stdout.strip()
