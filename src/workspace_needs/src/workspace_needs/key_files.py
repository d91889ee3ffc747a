"""Generates the files in rosdep/: Debian's keys and those of our own packages.

Run by scripts/rosdep_keys.py; the same lists give the same bytes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from workspace_needs.debian_lists import Binary

SECTIONS = ("same_name", "python", "keys", "groups")
DEBIAN_NOTE = """\
# rosdep keys that Debian can satisfy, by release; null: not in that release.
# Made by scripts/rosdep_keys.py from Debian's lists and data/system_keys.yaml: do not edit.
"""
OURS_NOTE = """\
# rosdep keys that packages of this repository satisfy, with nothing to install.
# Made by scripts/rosdep_keys.py from src/: do not edit.
"""

Keys = dict[str, dict[str, list[str]]]  # by key, then by release


class KeyFileError(ValueError):
    """The data or the lists are invalid; the message says where."""


def check_system_keys(content: Any, where: str) -> dict[str, Any]:
    """Checks data/system_keys.yaml's content; KeyFileError names an unknown or duplicate key."""
    if not isinstance(content, dict):
        raise KeyFileError(f"{where}: this is not a mapping")
    for section in content:
        if section not in SECTIONS:
            raise KeyFileError(f"{where}: unknown section {section!r}; there are "
                               f"{', '.join(SECTIONS)}")
    for key, packages in content.get("keys", {}).items():
        if not packages or not all(isinstance(name, str) for name in packages):
            raise KeyFileError(f"{where}: {key}: {packages!r} is not a list of packages")
    return content


def debian_keys(releases: Mapping[str, tuple[dict[str, list[str]], dict[str, Binary]]],
                system: Mapping[str, Any]) -> Keys:
    """Every key with its packages in each release that has them all.

    `releases`: by name, ROS packages (see debian_lists.ros_packages) and binary packages.
    KeyFileError names a key that no release has.
    """
    keys: Keys = {}
    for release, (ros, binaries) in releases.items():
        for name, packages in ros.items():
            keys.setdefault(name, {})[release] = packages
        for key, choices in _system(system):
            packages = [_first(choice, binaries) for choice in choices]
            if None not in packages:
                keys.setdefault(key, {}).setdefault(release, packages)
    groups = system.get("groups", {})
    for release in releases:
        for group in groups:
            keys.setdefault(group, {})[release] = sorted(_union(group, groups, release, keys))
    missing = [key for key, _ in _system(system) if key not in keys]
    if missing:
        raise KeyFileError(f"no release has what these keys ask for: {' '.join(missing)}")
    return keys


def _system(system: Mapping[str, Any]) -> Iterable[tuple[str, list[str]]]:
    yield from system.get("keys", {}).items()
    for name in _flat(system.get("same_name", [])):
        yield name, [name]
    for name in _flat(system.get("python", [])):
        for key in (f"python3-{name}", f"python-{name}"):
            yield key, [f"python3-{name}"]


def _flat(rows: Iterable[list[str]]) -> list[str]:
    return [name for row in rows for name in row]


def _first(choice: str, binaries: Mapping[str, Binary]) -> str | None:
    return next((name for name in choice.split("|") if name in binaries), None)


def _union(group: str, groups: Mapping[str, list[str]], release: str, keys: Keys) -> set[str]:
    """The Debian packages of a group's members, some of which are groups themselves."""
    found: set[str] = set()
    for member in groups[group]:
        if member in groups:
            found |= _union(member, groups, release, keys)
        elif member in keys:
            found.update(keys[member].get(release, []))
        else:
            raise KeyFileError(f"group {group}: there is no key {member}")
    return found


def debian_text(keys: Keys, releases: Iterable[str]) -> str:
    """rosdep's format, one key a line."""
    names = list(releases)
    lines = []
    for key in sorted(keys):
        rules = ", ".join(f"{release}: {_list(keys[key].get(release))}" for release in names)
        lines.append(f"{key}: {{debian: {{{rules}}}}}\n")
    return DEBIAN_NOTE + "".join(lines)


def ours_text(names: Iterable[str], debian: Iterable[str]) -> str:
    """Our packages, except those that Debian has too, as their C++ part comes from there."""
    ours = sorted(set(names) - set(debian))
    return OURS_NOTE + "".join(f"{name}: {{debian: []}}\n" for name in ours)


def _list(packages: list[str] | None) -> str:
    return "null" if packages is None else f"[{', '.join(packages)}]"
