#!/usr/bin/env python3
"""Completes the tree that `make deb` packs: Python packages, an interpreter, compiled modules.

    deb_stage.py STAGE PREFIX     STAGE/PREFIX holds what `cmake --install` put there
"""

from __future__ import annotations

import compileall
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from importlib.metadata import Distribution, distribution
from pathlib import Path

from package_lists import SOURCE, read_pins, these_lists

ROOT = Path(__file__).resolve().parent.parent
VERSION = f"{sys.version_info.major}.{sys.version_info.minor}"
MODULES = Path(f"lib/python{VERSION}/site-packages")  # of PyPI's packages, below the prefix
# Parts of PyPI's packages that nothing here imports; 180 MB in total.
LEFT_OUT = ("pybullet_data", "pybullet_envs", "pybullet_examples", "pybullet_robots", "tests",
            "__pycache__")
STRIPPED = ("pybullet.",)  # prefix of files' names: 130 of its 140 MB are debug symbols


def required() -> list[Distribution]:
    """PyPI packages needed at run time, as installed for this interpreter."""
    lists = (these_lists() / f"{name}.txt" for name in ("requirements", SOURCE))
    return [distribution(name) for path in lists if path.exists()
            for name in read_pins(path.read_text(encoding="utf-8"))]


def travelling_files(package: Distribution) -> Iterator[Path]:
    """Its files, relative to site-packages; neither commands nor LEFT_OUT."""
    for file in package.files or ():
        if ".." not in file.parts and not set(file.parts) & set(LEFT_OUT):
            yield Path(file)


def add_packages(modules: Path) -> None:
    """Copy PyPI's packages, as pip unpacked them."""
    for package in required():
        for file in travelling_files(package):
            target = modules / file
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(package.locate_file(file), target)
            if file.name.startswith(STRIPPED) and file.suffix == ".so":
                subprocess.run(["strip", "--strip-unneeded", str(target)], check=True)


def add_interpreter(folder: Path) -> None:
    """Make the folder a virtual environment of Debian's python3 that sees Debian's modules.

    setup.bash puts its bin/ first on PATH: that python3 finds PyPI's packages before Debian's.
    """
    (folder / "bin").mkdir(exist_ok=True)
    for name in ("python", "python3"):
        (folder / "bin" / name).symlink_to(f"/usr/bin/python{VERSION}")
    (folder / "pyvenv.cfg").write_text(
        f"home = /usr/bin\ninclude-system-site-packages = true\nversion = {VERSION}\n",
        encoding="utf-8")


def settle_interpreter(folder: Path, prefix: str) -> None:
    """Replace the build's interpreter by the installed one in all files that name it."""
    built_with = f"{ROOT}/.venv/bin/python3".encode()
    for path in _files(folder):
        data = path.read_bytes()
        if built_with in data:
            path.write_bytes(data.replace(built_with, f"{prefix}/bin/python3".encode()))


def compile_modules(stage: Path, folder: Path, epoch: int) -> None:
    """Compile all modules, so that users need no write access to run them."""
    for cached in list(folder.rglob("__pycache__")):
        shutil.rmtree(cached)
    settle_times(stage, epoch)  # a compiled module remembers its source's
    for modules in (folder / MODULES, folder / "rosdep", folder / "lib/python3/dist-packages"):
        compileall.compile_dir(
            modules, maxlevels=50, quiet=2, stripdir=str(stage), prependdir="/",
            workers=os.cpu_count() or 1, hardlink_dupes=False)


def settle_times(stage: Path, epoch: int) -> None:
    """Set one time (s since 1970) for all files and folders; only the owner may write."""
    for folder, folders, files in os.walk(stage):
        for path in (Path(folder), *(Path(folder) / name for name in (*folders, *files))):
            if not path.is_symlink():
                path.chmod(path.stat().st_mode & 0o755 | 0o644)
            os.utime(path, (epoch, epoch), follow_symlinks=False)


def places_of_build(folder: Path) -> list[Path]:
    """Files that contain this checkout's path; there may be none."""
    return [path for path in _files(folder) if bytes(ROOT) in path.read_bytes()]


def epoch() -> int:
    """SOURCE_DATE_EPOCH, else the last commit's time, else that of the list of packages; s."""
    if given := os.environ.get("SOURCE_DATE_EPOCH"):
        return int(given)
    told = subprocess.run(["git", "-C", str(ROOT), "log", "-1", "--format=%ct"],
                          capture_output=True, text=True, check=False)
    return int(told.stdout or (these_lists() / "requirements.txt").stat().st_mtime)


def _files(folder: Path) -> Iterator[Path]:
    return (path for path in folder.rglob("*") if path.is_file() and not path.is_symlink())


def main() -> int:
    """Returns the exit code."""
    stage, prefix = Path(sys.argv[1]), sys.argv[2]
    folder = stage / prefix.lstrip("/")
    add_packages(folder / MODULES)
    shutil.copytree(Path(sys.prefix) / "rosdep", folder / "rosdep",
                    ignore=shutil.ignore_patterns("__pycache__", "bin"))
    add_interpreter(folder)
    settle_interpreter(folder, prefix)
    compile_modules(stage, folder, epoch())
    if wrong := places_of_build(folder):
        print(f"error: {wrong[0]} names {ROOT}, which nobody else has", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
