"""rosdep's cache, made from our files whenever those are newer: nobody types `rosdep update`.

It has a folder of its own in the user's ~/.ros, so that another ROS on the machine keeps its own.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import shutil
import tempfile
from pathlib import Path

from workspace_needs.places import package_folder

STAMP = "made-from"


def enter() -> Path:
    """Points rosdep to our files and to the cache, which is made if need be; returns its folder."""
    files = package_folder() / "rosdep"
    home = _home()
    stamp = _stamp(files)
    if not (home / STAMP).is_file() or (home / STAMP).read_text("utf-8") != stamp:
        _make(files, home, stamp)
    _point_to(files, home)
    return home


def _home() -> Path:
    """~/.ros/rosdep-courses, or a folder in /tmp where that cannot be written."""
    parent = Path(os.environ.get("ROS_HOME") or Path.home() / ".ros")
    try:
        parent.mkdir(parents=True, exist_ok=True)
        if os.access(parent, os.W_OK):
            return parent / "rosdep-courses"
    except OSError:
        pass
    return Path(tempfile.gettempdir()) / f"rosdep-courses-{os.geteuid()}"


def _stamp(files: Path) -> str:
    """Which files, and their content: a copy elsewhere or a change makes the cache anew."""
    digest = hashlib.sha256(str(files).encode())
    for path in sorted(files.iterdir()):
        digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()


def _point_to(files: Path, home: Path) -> None:
    os.environ["ROS_HOME"] = str(home)
    os.environ["ROSDEP_SOURCE_PATH"] = str(home / "sources.list.d")
    os.environ["ROSDISTRO_INDEX_URL"] = (files / "index-v4.yaml").as_uri()


def _make(files: Path, home: Path, stamp: str) -> None:
    """Fills a new folder by rosdep's own update, then puts it in place."""
    made = Path(tempfile.mkdtemp(prefix=f"{home.name}.", dir=home.parent))
    try:
        sources = made / "sources.list.d"
        sources.mkdir()
        (sources / "10-courses.list").write_text(
            "".join(f"yaml {(files / name).as_uri()}\n" for name in ("ours.yaml", "debian.yaml")),
            encoding="utf-8")
        _point_to(files, made)
        _update()
        (made / STAMP).write_text(stamp, encoding="utf-8")
        made.chmod(0o755)
        shutil.rmtree(home, ignore_errors=True)
        made.rename(home)
    finally:
        shutil.rmtree(made, ignore_errors=True)


def _update() -> None:
    """`rosdep update`, which parses YAML in pure Python unless it gets the quick loader."""
    import yaml
    from rosdep2 import sources_list

    plain = yaml.safe_load
    yaml.safe_load = lambda text: yaml.load(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            sources_list.update_sources_list(quiet=True)
    finally:
        yaml.safe_load = plain
