"""Finds the exercises: the file exercises.yaml of each package that rospack finds."""

from __future__ import annotations

import functools
import math
import reprlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import rospkg
from node_basics.records import check_keys, read_yaml

from exercises.finding import CannotCheck

FILE = "exercises.yaml"
KEYS = ("title", "start", "solution", "check", "limits")
MODULES = {  # of exercises.checks -> the functions that are checks
    "files": ("bag", "link"),
    "laws": ("chase", "halls", "pid", "stop"),
    "nodes": ("action", "ending", "parameter", "radar", "switch", "wall"),
    "pictures": ("lamp", "line", "mask"),
    "planner": ("planner",),
    "simulated": ("lane", "lap", "steering"),
}
CHECKS = {  # check -> its limits, in SI units unless the name says otherwise
    "action": ("least", "seconds"),
    "bag": ("messages", "period", "tolerance"),
    "chase": ("distance", "tolerance", "seconds"),
    "ending": ("seconds",),
    "halls": ("halls", "seconds"),
    "lamp": ("pictures",),
    "lane": ("places", "aside", "right_share"),
    "lap": ("speed", "rms", "off_course"),
    "line": ("pictures", "error_px"),
    "link": ("x", "y", "z", "yaw", "tolerance"),
    "mask": ("kept_share", "taken_share"),
    "parameter": ("default", "other", "seconds"),
    "pid": ("left_px", "swing_px"),
    "planner": ("cost", "way_share"),
    "radar": ("x", "y", "z", "tolerance"),
    "steering": ("angle", "tolerance", "seconds"),
    "stop": ("distance", "tolerance", "seconds"),
    "switch": ("seconds",),
    "wall": ("least_x", "most_x", "seconds"),
}


@dataclass(frozen=True)
class Exercise:
    """An entry of an exercises.yaml."""

    file: Path  # the exercises.yaml
    name: str
    title: str
    start: Path  # the file that the learner edits
    solution: Path
    check: str
    limits: dict[str, float]


def find_exercises(packages: dict[str, Path] | None = None) -> dict[str, Exercise]:
    """Exercises by name, of these packages (folders by name) or of all that rospack finds.

    CannotCheck if a file is invalid or two packages use the same name.
    """
    found: dict[str, Exercise] = {}
    for _, folder in sorted((packages or _all_packages()).items()):
        if (folder / FILE).is_file():
            for name, exercise in read_exercises(folder / FILE).items():
                if name in found:
                    raise CannotCheck(f"{folder / FILE}: {name!r} is also in"
                                      f" {found[name].file}: rename one")
                found[name] = exercise
    return found


def read_exercises(file: Path) -> dict[str, Exercise]:
    """Exercises of one file, by name; CannotCheck names file and key of an error."""
    table = read_yaml(file, CannotCheck)
    if not isinstance(table, dict):
        raise CannotCheck(f"{file}: must be a table of exercises, NAME: {{{', '.join(KEYS)}}}")
    return {name: _exercise(file, str(name), entry) for name, entry in table.items()}


def _exercise(file: Path, name: str, entry: Any) -> Exercise:
    place = f"{file}: {name}"
    check_keys(place, entry, KEYS, CannotCheck)
    for key in ("title", "start", "solution", "check"):
        if not isinstance(entry[key], str):
            raise CannotCheck(f"{place}: {key}: must be a text, is"
                              f" {reprlib.repr(entry[key])[:80]}")
    start, solution = (file.parent / entry[key] for key in ("start", "solution"))
    for key, path in (("start", start), ("solution", solution)):
        if not path.is_file():
            raise CannotCheck(f"{place}: {key}: no file {path}")
    if entry["check"] not in CHECKS:
        raise CannotCheck(f"{place}: check: no check {entry['check']!r:.80}; there are:"
                          f" {', '.join(CHECKS)}")
    limits = entry["limits"]
    check_keys(f"{place}: limits", limits, CHECKS[entry["check"]], CannotCheck)
    for key, value in limits.items():
        if type(value) not in (int, float) or not math.isfinite(value):
            raise CannotCheck(f"{place}: limits: {key}: must be a number, is"
                              f" {reprlib.repr(value)[:80]}")
    return Exercise(file, name, entry["title"], start, solution, entry["check"], limits)


@functools.cache
def _all_packages() -> dict[str, Path]:
    known = rospkg.RosPack()
    return {name: Path(known.get_path(name)) for name in known.list()}
