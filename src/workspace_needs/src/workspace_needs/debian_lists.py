"""Finds ROS packages in Debian's own lists of packages and files.

A mirror has them per release: dists/RELEASE/main/Contents-*.gz and binary-amd64/Packages.xz.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

FIELDS = ("Package", "Source", "Section", "Depends", "Provides", "Version")
# Folders of a ROS package, below the system's share, lib, include ...
ROOM = re.compile(
    r"usr/(?:lib/python3/dist-packages|(?:share|lib)(?:/x86_64-linux-gnu)?/cmake"
    r"|lib/x86_64-linux-gnu|share|lib|include)/([A-Za-z]\w*)/")
MANIFEST = re.compile(r"usr/share/(\w+)/package\.xml$")


@dataclass(frozen=True)
class Binary:
    """One binary package."""

    name: str
    source: str
    section: str
    depends: frozenset[str]
    version: str


def read_packages(lines: Iterable[str]) -> dict[str, Binary]:
    """Binary packages of a Packages file, by name, including virtual ones (Provides)."""
    found: dict[str, Binary] = {}
    for fields in _paragraphs(lines):
        name = fields["Package"]
        binary = Binary(name, fields.get("Source", name).split()[0], fields.get("Section", ""),
                        frozenset(_names(fields.get("Depends", ""))), fields.get("Version", ""))
        found[name] = binary
        for provided in _names(fields.get("Provides", "")):
            found.setdefault(provided, binary)
    return found


def _paragraphs(lines: Iterable[str]) -> Iterator[dict[str, str]]:
    fields: dict[str, str] = {}
    for line in lines:
        if not line.strip():
            if "Package" in fields:
                yield fields
            fields = {}
        elif not line[0].isspace():
            key, _, value = line.partition(":")
            if key in FIELDS:
                fields[key] = value.strip()
    if "Package" in fields:
        yield fields


def _names(relation: str) -> list[str]:
    """Names in a relation: a and b of `a (>= 1), b:any | c`, as apt takes the first alternative."""
    return [re.split(r"[\s(:\[|]", word.strip())[0] for word in relation.split(",") if word.strip()]


def ros_packages(contents: Iterable[str], binaries: dict[str, Binary]) -> dict[str, list[str]]:
    """The binary packages that contain a part of each ROS package, sorted.

    `contents`: lines PATH SECTION/PACKAGE[,SECTION/PACKAGE]. A ROS package has a package.xml in
    /usr/share. Its parts are headers and CMake files (-dev), Python modules, programs, message
    definitions; without Lisp, documentation, and packages that another part depends on.
    """
    rooms: dict[str, set[str]] = defaultdict(set)
    manifests: dict[str, set[str]] = defaultdict(set)
    for line in contents:
        match = ROOM.match(line)
        if match is None:
            continue
        path, _, where = line.rstrip().rpartition(" ")
        packages = [place.rpartition("/")[2] for place in where.split(",")]
        if manifest := MANIFEST.match(path.rstrip()):
            manifests[manifest.group(1)].update(packages)
        else:
            rooms[match.group(1)].update(
                name for name in packages
                if name in binaries and binaries[name].source.startswith("ros-"))
    return {name: _parts(manifests[name] | rooms[name], binaries) for name in sorted(manifests)}


def _parts(names: set[str], binaries: dict[str, Binary]) -> list[str]:
    parts = {name for name in names if name in binaries and not name.startswith("cl-")
             and binaries[name].section.rpartition("/")[2] not in ("doc", "debug", "lisp")}
    for name in sorted(parts):
        if any(name in binaries[other].depends for other in parts - {name}):
            parts.discard(name)
    return sorted(parts)
