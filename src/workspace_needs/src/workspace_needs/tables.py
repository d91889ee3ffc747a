"""All tables in one: tells who provides a dependency."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from fnmatch import fnmatchcase
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from workspace_needs import apt
from workspace_needs.places import package_folder, release

OURS, DEBIAN, ABSENT, UNKNOWN = "ours", "debian", "absent", "unknown"
KEYS = ("what", "why", "keys", "headers", "in_ours")  # of a row of absent.yaml
MODULE_KEYS = ("renamed", "packages")  # of python_modules.yaml
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
# Forms of Debian names (lib..., hyphens) that ROS packages never have, so that none is confused.
RELEASES = {"bookworm": "Debian 12", "trixie": "Debian 13"}
DEBIAN_NAME = re.compile(r"lib[a-z0-9.+-]+|[a-z0-9][a-z0-9.+]*(-[a-z0-9.+]+)+")


class TableError(ValueError):
    """A file of data/ is invalid; the message names file and key."""


@dataclass(frozen=True)
class Absence:
    """A row of data/absent.yaml."""

    what: str
    why: str
    keys: tuple[str, ...]
    headers: tuple[str, ...]
    in_ours: tuple[str, ...]


@dataclass(frozen=True)
class Answer:
    """Who has a key: OURS, DEBIAN with its packages, ABSENT with the reason, or UNKNOWN."""

    kind: str
    packages: tuple[str, ...] = ()
    why: str = ""


class Tables:
    """rosdep/*.yaml and data/*.yaml for one release of Debian."""

    def __init__(self, folder: Path | None = None, of_release: str | None = None):
        self._folder = folder or package_folder()
        self._release = of_release or release()
        self.ours = frozenset(self._read("rosdep/ours.yaml"))
        self.debian: dict[str, Any] = self._read("rosdep/debian.yaml")
        self.cmake_names: dict[str, str] = self._read("data/cmake_names.yaml")
        self.absences = read_absences(self._folder / "data/absent.yaml")
        self.renamed_modules, self.module_packages = read_modules(
            self._folder / "data/python_modules.yaml")

    def _read(self, name: str) -> dict:
        return yaml.load((self._folder / name).read_text("utf-8"), LOADER) or {}

    def answer(self, key: str, beside: Iterable[str] = ()) -> Answer:
        """Who has `key`; a name in Debian's form is looked up in apt's list.

        `beside`: other packages that may be meant.
        """
        return self.known(key) or Answer(UNKNOWN, why=self._nobody(key, beside))

    def known(self, key: str) -> Answer | None:
        """The same, without the search for a similar name, which takes long."""
        packages = self.debian.get(key, {}).get("debian", {}).get(self._release)
        if packages is not None:
            return Answer(DEBIAN, tuple(packages))
        if key in self.ours:
            return Answer(OURS)
        if absence := self.absence(key):
            return Answer(ABSENT, why=absence.why)
        if DEBIAN_NAME.fullmatch(key) and key in apt.names():
            return Answer(DEBIAN, (key,))
        if others := self._other_releases(key):
            here = self._named(self._release)
            return Answer(ABSENT, why=f"{others[0]} has it, {here} does not" if len(others) == 1
                          else f"{' and '.join(others)} have it, {here} does not")
        return None

    def _other_releases(self, key: str) -> list[str]:
        """Other releases that have `key`, such as `Debian 13`."""
        found = self.debian.get(key, {}).get("debian", {})
        return [self._named(name) for name, packages in found.items() if packages is not None]

    @staticmethod
    def _named(release: str) -> str:
        return RELEASES.get(release, release or "this system")

    def answer_cmake(self, name: str, beside: Iterable[str] = ()) -> Answer:
        """The same for a name in find_package or pkg_check_modules, mostly a key itself."""
        answer = self.answer(name, beside)
        if answer.kind in (OURS, DEBIAN):
            return answer
        if name in self.cmake_names:
            return self.answer(self.cmake_names[name])
        if answer.kind == ABSENT:
            return answer
        library = next((choice for choice in (f"{name}-dev", f"lib{name}-dev")
                        if choice in apt.names()), None)
        return Answer(DEBIAN, (library,)) if library else answer

    def why_ours_stays(self, package: str) -> str:
        """Why a workspace's package of this name must not be found before ours; "" if it may."""
        return next((row.why for row in self.absences if package in row.in_ours), "")

    def absence(self, key: str) -> Absence | None:
        """Why nobody has `key`, if that is known."""
        return next((row for row in self.absences
                     if any(fnmatchcase(key, pattern) for pattern in row.keys)), None)

    def missing_header(self, header: str) -> Absence | None:
        """Why `#include <header>` finds nothing here, if that is known."""
        folder, slash, _ = header.partition("/")
        return next((row for row in self.absences if slash and folder in row.headers), None)

    def _nobody(self, key: str, beside: Iterable[str]) -> str:
        known = [*beside, *self.ours, *self.debian]
        similar = [name for name in get_close_matches(key, known, 3, 0.85)
                   if name != key and is_slip(key, name)]
        if similar:
            return f"nobody has that name; is {similar[0]} meant?"
        return ("neither Debian nor this repository has it; clone its source into src/, or mend "
                "the name")


@cache
def tables() -> Tables:
    """The tables for this release, read once."""
    return Tables()


def why_absent(name: str, beside: Iterable[str] = ()) -> str:
    """Why there is no `name`, or how it is had; `beside`: other packages that may be meant."""
    answer = tables().answer(name, beside)
    if answer.kind == DEBIAN:
        return f"sudo apt-get install {' '.join(answer.packages)}"
    return answer.why or "source devel/setup.bash of its workspace first"


def is_slip(typed: str, name: str) -> bool:
    """Whether `typed` is `name` mistyped, and not another package's name (turtlebot_msgs)."""
    words, others = typed.split("_"), name.split("_")
    if len(words) != len(others) or re.findall(r"\d+", typed) != re.findall(r"\d+", name):
        return re.sub("[_-]", "", typed) == re.sub("[_-]", "", name)
    wrong = [(word, other) for word, other in zip(words, others) if word != other]
    return len(wrong) == 1 and bool(get_close_matches(wrong[0][0], [wrong[0][1]], 1, 0.75))


def read_absences(path: Path) -> list[Absence]:
    """The rows; TableError names an unknown or missing key."""
    rows = []
    for number, row in enumerate(yaml.load(path.read_text("utf-8"), LOADER), 1):
        where = f"{path.name}, row {number}"
        for key in row:
            if key not in KEYS:
                raise TableError(f"{where}: unknown key {key!r}; there are {', '.join(KEYS)}")
        for key in ("what", "why", "keys"):
            if not row.get(key):
                raise TableError(f"{where}: {key} is missing")
        rows.append(Absence(row["what"], row["why"], tuple(row["keys"]),
                            tuple(row.get("headers", ())), tuple(row.get("in_ours", ()))))
    return rows


def read_modules(path: Path) -> list[dict[str, str]]:
    """Names by module name, a dictionary for each of MODULE_KEYS; TableError names a wrong key."""
    content = yaml.load(path.read_text("utf-8"), LOADER)
    for key in content:
        if key not in MODULE_KEYS:
            raise TableError(f"{path.name}: unknown key {key!r}; there are "
                             f"{', '.join(MODULE_KEYS)}")
    for key in MODULE_KEYS:
        if not isinstance(content.get(key), dict):
            raise TableError(f"{path.name}: {key} is missing")
        for module, name in content[key].items():
            if not (isinstance(module, str) and isinstance(name, str)):
                raise TableError(f"{path.name}, {key}: {module!r} and {name!r} must be names")
    return [content[key] for key in MODULE_KEYS]
