"""Packages that are only a name, from the tables src/{compat,navigation}/names.yaml.

Each build makes them, in names/ beside their table, before catkin looks for packages.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated
from xml.sax.saxutils import escape

from node_basics.records import Must, read_yaml, to_record

from run_session.failure import RunError

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("src/compat", "src/navigation")  # of tables; a learner's package may have a names.yaml

PACKAGE = """<?xml version="1.0"?>
<package format="2">
  <name>{name}</name>
  <version>{version}</version>
  <description>{description}</description>
  <maintainer email="courses@example.org">ros1-driving-courses</maintainer>
  <license>BSD-3-Clause</license>
  <buildtool_depend>catkin</buildtool_depend>
{depends}</package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.5)
project({name})

find_package(catkin REQUIRED{components})
catkin_package({exported})
"""
FRONT = """
configure_file(../../{front} {name} COPYONLY)
foreach(folder ${{CATKIN_PACKAGE_BIN_DESTINATION}} ${{CATKIN_GLOBAL_BIN_DESTINATION}})
  catkin_install_python(PROGRAMS ${{CMAKE_CURRENT_BINARY_DIR}}/{name} DESTINATION ${{folder}})
endforeach()
"""


@dataclass(frozen=True)
class Names:
    """Packages that differ by name and version alone."""

    description: str
    build: tuple[str, ...]  # packages that they hand on to who is built with them
    run: tuple[str, ...]  # packages that do their work
    front: str  # program that the package of this name starts, below the table's folder; or ""
    names: Annotated[dict, Must("upstream's version by package", lambda value: isinstance(
        value, dict) and all(isinstance(part, str) for pair in value.items() for part in pair))]


def files() -> dict[str, bytes]:
    """The files' bytes by path in the repository; RunError names table and key."""
    made: dict[str, bytes] = {}
    for table in tables():
        groups = read_yaml(table, RunError)
        if not isinstance(groups, list) or not all(isinstance(each, dict) for each in groups):
            raise RunError(f"{table}: must be a list of groups of names")
        for values in groups:
            group = to_record(Names, {"build": [], "run": [], "front": ""} | values, table,
                              RunError)
            for name, version in group.names.items():
                folder = f"{table.parent.relative_to(ROOT)}/names/{name}"
                if f"{folder}/package.xml" in made:
                    raise RunError(f"{table}: {name} stands there twice")
                made[f"{folder}/package.xml"] = manifest(group, name, version).encode()
                made[f"{folder}/CMakeLists.txt"] = build_file(group, name).encode()
    return made


def stale() -> list[Path]:
    """Folders of names that no table has any more."""
    known = {ROOT / path for path in files()}
    return [folder for table in tables() for folder in table.parent.glob("names/*")
            if folder / "package.xml" not in known]


def sources() -> list[Path]:
    """The tables, and the folders in which a table or a stale package would come up."""
    folders = [table.parent / "names" for table in tables()]
    return [*(ROOT / folder for folder in FOLDERS), *tables(), *folders]


def tables() -> list[Path]:
    """Those that are there: a learner may have removed a folder of ours."""
    return [table for folder in FOLDERS if (table := ROOT / folder / "names.yaml").is_file()]


def manifest(group: Names, name: str, version: str) -> str:
    """package.xml."""
    depends = "".join(f"  <{tag}>{package}</{tag}>\n" for tag, packages in (
        ("depend", group.build), ("exec_depend", group.run)) for package in packages)
    return PACKAGE.format(name=name, version=version, description=escape(group.description),
                          depends=depends)


def build_file(group: Names, name: str) -> str:
    """CMakeLists.txt."""
    handed = " ".join(group.build)
    text = CMAKE.format(name=name, components=f" COMPONENTS {handed}" if handed else "",
                        exported=f"CATKIN_DEPENDS {handed}" if handed else "")
    return text + FRONT.format(name=name, front=group.front) if group.front else text
