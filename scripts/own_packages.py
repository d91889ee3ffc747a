"""Lets a learner's package in src/ replace ours of the same name.

catkin refuses two packages of one name, and rospack takes the first that it finds. So our package's
folder gets a CATKIN_IGNORE, which catkin, rospack and rospkg all respect, for as long as a package
of that name is in src/ outside our own folders; a clone of Gazebo's own packages gets one itself,
as it would hide the simulator. Run before each build; prints a line if a package of ours is left
out or restored, and ends with 1 if two of the learner's packages share a name.

    own_packages.py SRC
"""

from __future__ import annotations

import sys
from pathlib import Path

from catkin_pkg.package import InvalidPackage, parse_package
from catkin_pkg.packages import find_package_paths

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "src/workspace_needs/src"))
from workspace_needs.tables import Tables
from workspace_needs.workspace import hide

OUR_FOLDERS = ("car_control", "compat", "driving_courses", "evaluation", "exercises", "interfaces",
               "learning_topic", "lessons", "marking", "navigation", "racecar_description",
               "run_session", "sim", "sim_bench", "trial_worlds", "workspace_needs")
MARKER = "CATKIN_IGNORE"
MARK = "made by the build: a package of this name elsewhere in src/ is built instead\n"


def is_ours(path: str) -> bool:
    """Whether a path below src/ is in one of our folders."""
    return Path(path).parts[0] in OUR_FOLDERS if path != "." else False


def marked(src: Path) -> set[str]:
    """Our packages, by their paths below src/, that an earlier build left out."""
    found = set()
    for folder in OUR_FOLDERS:
        for marker in (src / folder).rglob(MARKER):
            if marker.is_file() and marker.read_text(errors="replace") == MARK:
                found.add(str(marker.parent.relative_to(src)))
    return found


def names_of(src: Path, paths: list[str]) -> dict[str, list[str]]:
    """Paths by package name; an unreadable package.xml is left for catkin to report."""
    found: dict[str, list[str]] = {}
    for path in sorted(paths):
        try:
            name = parse_package(str(src / path), warnings=[]).name
        except (InvalidPackage, OSError):
            continue
        found.setdefault(name, []).append(path)
    return found


def arrange(src: Path) -> tuple[list[str], list[str]]:
    """Writes and removes markers; returns lines to print, and errors."""
    before = marked(src)
    paths = [*find_package_paths(str(src)), *before]
    theirs = names_of(src, [path for path in paths if not is_ours(path)])
    if not theirs and not before:
        return [], []
    ours = names_of(src, [path for path in paths if is_ours(path)])
    tables = Tables()
    for name in [name for name in theirs if tables.why_ours_stays(name)]:
        for path in theirs.pop(name):
            hide(src / path)
    wrong = [f"two packages in src/ are called {name}: src/{first} and src/{second}; "
             "remove or rename one"
             for name, (first, second, *_) in
             ((name, found) for name, found in theirs.items() if len(found) > 1)]
    after = {ours[name][0]: f"{name} (src/{found[0]})" for name, found in theirs.items()
             if name in ours}
    for path in before - after.keys():
        (src / path / MARKER).unlink()
    for path in after:
        (src / path / MARKER).write_text(MARK)
    told = []
    if after:
        told.append("Built in place of ours: " + ", ".join(after.values()))
    if gone := {path for path in before - after.keys() if (src / path / "package.xml").is_file()}:
        told.append("Ours again: " + ", ".join(sorted(Path(path).name for path in gone)))
    return told, wrong


def main() -> int:
    """0, or 1 with a line for each name that the learner has given twice."""
    told, wrong = arrange(Path(sys.argv[1]))
    for line in told:
        print(line)
    for line in wrong:
        print(f"setup: {line}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
