"""Workspaces written for tests, in the style of those that pages have people clone."""

from collections.abc import Mapping
from pathlib import Path

from workspace_needs.check import modules, packages, sources
from workspace_needs.check.findings import WORKS, Finding

NODE = "#!/usr/bin/env python3\nimport rospy\nrospy.init_node('n')\n"
MANIFEST = """<?xml version="1.0"?>
<package format="{format}"><name>{name}</name><version>1.0.0</version><description>d</description>
<maintainer email="who@example.com">who</maintainer><license>BSD</license>
<buildtool_depend>catkin</buildtool_depend>{depends}</package>
"""


def add_package(source: Path, name: str, depends: str = "", components: str = "", cmake: str = "",
                style: int = 2) -> Path:
    """A package below `source`; `depends` are its keys, `components` those of CMakeLists.txt."""
    folder = source / name
    (folder / "src").mkdir(parents=True, exist_ok=True)
    tags = ("build_depend", "run_depend") if style == 1 else ("depend",)
    declared = "".join(f"<{tag}>{key}</{tag}>" for key in depends.split() for tag in tags)
    (folder / "package.xml").write_text(
        MANIFEST.format(name=name, format=style, depends=declared), encoding="utf-8")
    (folder / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.0.2)\nproject({name} CXX)\n"
        f"find_package(catkin REQUIRED{' COMPONENTS' if components else ''} {components})\n"
        f"{cmake}\ncatkin_package()\n", encoding="utf-8")
    return folder


def add_plain(source: Path, name: str, depends: str = "", cmake: str = "") -> Path:
    """The same without catkin, which takes a second to configure."""
    folder = add_package(source, name, depends)
    (folder / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.0.2)\nproject({name} CXX)\n{cmake}\n", encoding="utf-8")
    return folder


def add_files(folder: Path, files: Mapping[str, str]) -> Path:
    """The folder, as that of a package with these files: those with #! are executable."""
    for name, text in {"package.xml": "<package><name>arm</name></package>", **files}.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        path.chmod(0o755 if text.startswith("#!") else 0o644)
    return folder


def program_findings(folder: Path) -> list[Finding]:
    """As if check was started anew, which reads each file once."""
    for cached in (modules._names_below, packages._naming, packages._imported):
        cached.cache_clear()
    return [found for found in sources.program_findings(folder) if found.status != WORKS]


def script_findings(path: Path) -> list[Finding]:
    """The same of a script that was named alone."""
    program_findings(path / "nowhere")
    return list(sources.script_findings(path))


def turtlebot3_style(workspace: Path) -> Path:
    """Messages, a C++ node with tf, a package of launch files; the src/ of it."""
    source = workspace / "src"
    add_package(source, "burger_msgs", "std_msgs message_generation message_runtime",
                "std_msgs message_generation")
    add_package(source, "burger_bringup", "roscpp rospy tf diagnostic_msgs burger_msgs python-yaml",
                "roscpp tf  # and what package.xml forgot\n  dynamic_edt_3d diagnostic_msgs")
    simulation = add_package(source, "burger_gazebo", "gazebo_ros burger_bringup", "gazebo_ros",
                             "find_package(gazebo REQUIRED)", style=1)
    (simulation / "launch").mkdir()
    (simulation / "launch" / "a.launch").write_text(
        '<launch><node pkg="image_view" type="image_view" name="v"/>'
        '<include file="$(find burger_bringup)/b.launch"/></launch>', encoding="utf-8")
    return source
