#!/usr/bin/env python3
"""Builds a source package and a wheel of each package that works without ROS.

    build_wheels.py FOLDER

Only what git knows of is built, as it lies here. SOURCE_DATE_EPOCH (seconds) is the time of all
files; each wheel is built from its source package, which is therefore complete.
"""

from __future__ import annotations

import gzip
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("sim/bullet_sim", "interfaces/node_basics", "racecar_description", "car_control",
            "evaluation", "lessons/ai_robot_tracking", "driving_courses")
DATA = ("learning_topic", "lessons/lane_keeping", "compat/turtlebot3_description")  # for the last
MANIFEST = "include package.xml\nprune test\n"
BUILD = "import sys; from setuptools import build_meta; build_meta.build_{}(sys.argv[1])"


def copy_sources(target: Path) -> None:
    """Copy what git lists of those folders, with plain permissions, to target/src."""
    folders = [f"src/{folder}" for folder in (*PACKAGES, *DATA)]
    listed = subprocess.run(["git", "ls-files", "-z", *folders], cwd=ROOT, check=True,
                            stdout=subprocess.PIPE, text=True).stdout
    for name in filter(None, listed.split("\0")):
        source, copy = ROOT / name, target / name
        if source.is_file():
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, copy)
            copy.chmod(0o755 if source.stat().st_mode & 0o100 else 0o644)
    for folder in PACKAGES:
        shutil.copyfile(ROOT / "LICENSE", target / "src" / folder / "LICENSE")
        (target / "src" / folder / "MANIFEST.in").write_text(MANIFEST, encoding="utf-8")


def build(what: str, source: Path, target: Path) -> Path:
    """Build `what`, sdist or wheel, of a folder; returns its file in the new folder `target`.

    CalledProcessError if setuptools does not.
    """
    target.mkdir()
    subprocess.run([sys.executable, "-c", BUILD.format(what), str(target)], cwd=source, check=True,
                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    (made,) = target.iterdir()
    return made


def write_archive(folder: Path, archive: Path, seconds: int) -> None:
    """A .tar.gz of the folder in which only names, permissions and contents count."""
    with archive.open("wb") as file, \
            gzip.GzipFile("", "wb", fileobj=file, mtime=seconds) as packed, \
            tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as tar:
        for path in sorted(folder.rglob("*")):
            entry = tar.gettarinfo(path, path.relative_to(folder))
            entry.uid = entry.gid = 0
            entry.uname = entry.gname = ""
            entry.mtime = seconds
            if entry.isfile():
                with path.open("rb") as content:
                    tar.addfile(entry, content)
            else:
                tar.addfile(entry)


def build_package(source: Path, work: Path, made: Path, seconds: int) -> None:
    """Both files of one package, in `made`; `work` is a new folder."""
    work.mkdir()
    unpacked = work / "unpacked"
    sdist = build("sdist", source, work / "sdist")
    shutil.unpack_archive(sdist, unpacked)
    write_archive(unpacked, made / sdist.name, seconds)
    (folder,) = unpacked.iterdir()
    shutil.move(build("wheel", folder, work / "wheel"), made)


def main(folder: Path) -> int:
    """Replaces the packages in the folder, once all are built; returns the exit code."""
    os.umask(0o022)
    seconds = int(os.environ["SOURCE_DATE_EPOCH"])
    with tempfile.TemporaryDirectory(prefix="wheels-") as name:
        work, made = Path(name), Path(name, "made")
        made.mkdir()
        copy_sources(work)
        for package in PACKAGES:
            try:
                build_package(work / "src" / package, work / Path(package).name, made, seconds)
            except subprocess.CalledProcessError as error:
                print(error.stdout, file=sys.stderr)
                print(f"src/{package} cannot be built: the lines above say why", file=sys.stderr)
                return 1
        folder.mkdir(parents=True, exist_ok=True)
        for old in [*folder.glob("*.whl"), *folder.glob("*.tar.gz")]:
            old.unlink()
        for file in made.iterdir():
            shutil.move(file, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
