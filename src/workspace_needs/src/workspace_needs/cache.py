"""rosdep's cache, remade whenever our files change, so that `rosdep update` is not needed.

It is in a separate folder in the user's ~/.ros, so that it does not affect another ROS's cache.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import shutil
import tempfile
from pathlib import Path

from workspace_needs.places import kept_folder, package_folder

STAMP = "made-from"


def enter() -> Path:
    """Points rosdep to our files and the cache, which is made if needed; returns its folder."""
    files = package_folder() / "rosdep"
    home = kept_folder("rosdep-courses")
    stamp = _stamp(files)
    if not (home / STAMP).is_file() or (home / STAMP).read_text("utf-8") != stamp:
        _make(files, home, stamp)
    _point_to(files, home)
    return home


def _stamp(files: Path) -> str:
    """A digest of the files' path and content: a copy elsewhere or a change renews the cache."""
    digest = hashlib.sha256(str(files).encode())
    for path in sorted(files.iterdir()):
        digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()


def _point_to(files: Path, home: Path) -> None:
    os.environ["ROS_HOME"] = str(home)
    os.environ["ROSDEP_SOURCE_PATH"] = str(home / "sources.list.d")
    os.environ["ROSDISTRO_INDEX_URL"] = (files / "index-v4.yaml").as_uri()


def _make(files: Path, home: Path, stamp: str) -> None:
    """Fills a new folder by rosdep's own update, then moves it into place."""
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
    """Runs `rosdep update` with the fast YAML loader, which rosdep does not use by itself."""
    import yaml
    from rosdep2 import sources_list

    plain = yaml.safe_load
    yaml.safe_load = lambda text: yaml.load(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            sources_list.update_sources_list(quiet=True)
    finally:
        yaml.safe_load = plain
