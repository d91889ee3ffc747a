"""A learner's own folder: an overlay workspace with copies of the lessons' scripts and pages.

    FOLDER/src/my_lessons/scripts/PACKAGE/FILE    copies, to be changed; `reset` brings one back
    FOLDER/src/my_lessons/exercises/NAME.py       the exercises' starting files
    FOLDER/pages/                                 the lessons' pages, read-only, renewed each time
    FOLDER/.lab/                                  JupyterLab's settings, logs, and the lab's lock
"""

from __future__ import annotations

import difflib
import errno
import fcntl
import os
import shutil
import subprocess
import time
from pathlib import Path
from typing import IO, Any

import yaml

from exercises.catalogue import find_exercises

ROOT = Path(__file__).resolve().parents[2]
OFFERS = Path(__file__).with_name("lessons.yaml")
PACKAGE = "my_lessons"
DEPENDS = ("rospy", "cv_bridge", "geometry_msgs", "sensor_msgs", "std_msgs", "learning_topic")
PAGES = ("README*.md", "THEORY*.md", "images/*")


class LabError(Exception):
    """What a person has done or has to do, in one line."""


def offers() -> dict[str, Any]:
    """The table lessons.yaml."""
    return yaml.safe_load(OFFERS.read_text("utf-8"))


def source_of(package: str) -> Path:
    """The folder of one of our packages of lessons."""
    folder = ROOT / "src" / package
    return folder if folder.is_dir() else ROOT / "src/lessons" / package


class Folder:
    """A learner's folder at `path`."""

    def __init__(self, path: Path) -> None:
        self.path = path.expanduser().resolve()
        self.state = self.path / ".lab"
        self.package = self.path / "src" / PACKAGE

    def take(self) -> IO[str]:
        """Make it if need be, and lock it against a second lab; LabError if it is not ours."""
        if self.path.is_relative_to(ROOT) and not self.path.is_relative_to(ROOT / "out"):
            raise LabError(f"{self.path} lies in the courses' own folder: name another, such as: "
                           "make lab WS=~/courses_ws")
        try:
            self.state.mkdir(parents=True, exist_ok=True)
            self.state.chmod(0o700)  # the token is in it
            lock = open(self.state / "lock", "a+", encoding="utf-8")  # noqa: SIM115 (kept open)
        except OSError as error:
            if error.errno == errno.ENOSPC:
                raise
            raise LabError(f"{self.path} cannot be written by you: name a folder of your own, "
                           "such as: make lab WS=~/my_ws") from error
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            lock.seek(0)
            raise LabError(f"A lab runs already in {self.path}: {lock.read().strip()}") from None
        lock.truncate(0)
        return lock

    def sources(self) -> dict[Path, Path]:
        """Where each file of the learner's is copied from, by its path below the package."""
        found = {Path("scripts", package, name): source_of(package) / "scripts" / name
                 for package, lesson in offers()["lessons"].items() for name in lesson["scripts"]}
        for exercise in find_exercises().values():
            if exercise.start.suffix == ".py":
                found[Path("exercises", exercise.start.name)] = exercise.start
        return found

    def fill(self) -> None:
        """Make the workspace and what is missing in it; what the learner has stays as it is."""
        if not (self.package / "package.xml").exists():
            (self.path / "src").mkdir(exist_ok=True)
            self._run("catkin_create_pkg", PACKAGE, *DEPENDS, folder=self.path / "src")
        for name, source in self.sources().items():
            copy = self.package / name
            if not copy.exists():
                copy.parent.mkdir(parents=True, exist_ok=True)
                _copy(source, copy)
        if not (self.path / "devel/setup.bash").exists():
            self._run("catkin_make", folder=self.path)
        self._copy_pages()

    def _copy_pages(self) -> None:
        """The pages and their pictures, at the same places to each other as ours."""
        for folder in (ROOT / "docs", *map(source_of, offers()["lessons"]), ROOT / "src/lessons"):
            for pattern in PAGES if folder != ROOT / "docs" else ("*.md", "images/*"):
                for page in filter(Path.is_file, folder.glob(pattern)):
                    copy = self.path / "pages" / page.relative_to(ROOT)
                    if copy.exists() and copy.stat().st_mtime >= page.stat().st_mtime:
                        continue
                    copy.parent.mkdir(parents=True, exist_ok=True)
                    _copy(page, copy)
                    copy.chmod(0o444)

    def reset(self, path: Path) -> Path:
        """Bring a copy back as it was; returns where the changed file is kept now.

        LabError if the path names none; it says which one may be meant.
        """
        if path == Path():
            raise LabError("name a file: reset_lesson 05follower_proporation.py")
        file = (self.path / path).resolve()
        if not file.is_relative_to(self.package):
            file = next(iter(sorted(self.package.glob(f"*/**/{path.name}"))), file)
        name = file.relative_to(self.package) if file.is_relative_to(self.package) else Path()
        sources = self.sources()
        source = sources.get(name)
        if source is None:
            names = {each.name for each in sources}
            same = {each for each in names if each[:2] == path.name[:2]}  # of one lesson's number
            meant = difflib.get_close_matches(path.name, same or names, 1)
            if meant:
                raise LabError(f"{path} is no copy of a lesson's file: there is nothing to reset "
                               f"it to; is {meant[0]} meant?")
            raise LabError(f"{path} is no copy of a lesson's file: there is nothing to reset it to")
        kept = file.with_name(f"{file.name}.{time.strftime('%Y%m%d-%H%M%S')}")
        while kept.exists():  # a double click: what was kept a moment ago is the learner's
            kept = kept.with_name(f"{kept.name}-again")
        if file.exists():
            _copy(file, kept)  # before anything changes, should the disk be full
        _copy(source, file)
        return kept

    def _run(self, *command: str, folder: Path) -> None:
        done = subprocess.run(command, cwd=folder, env=os.environ | {"PWD": str(folder)},
                              capture_output=True, text=True, check=False)
        if done.returncode:
            log = self.state / "build.log"
            log.write_text(done.stdout + done.stderr, "utf-8")
            raise LabError(f"{command[0]} failed in {folder}; its output is in {log}")


def _copy(source: Path, file: Path) -> None:
    """Whole or not at all, should the disk be full."""
    fresh = file.with_name(f".{file.name}.new")
    try:
        shutil.copy(source, fresh)
        fresh.replace(file)
    except OSError as error:  # shutil names the file that was read
        raise OSError(error.errno, error.strerror, str(file)) from error
    finally:
        fresh.unlink(missing_ok=True)
