"""Finds planners in Python in any package, as pluginlib finds those in C++.

package.xml:  <export><nav_core plugin="${prefix}/planner_plugin.xml"/></export>
that file:    <library path="src">
                <class name="my_package/MyPlanner" type="my_package.my_module.MyPlanner"
                       base_class_type="nav_core::BaseGlobalPlanner"/>
              </library>
`path`, relative to the package, is searched for the module, besides PYTHONPATH.
"""

from __future__ import annotations

import importlib
import sys
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

import rospkg

from nav_nodes.parameters import ParameterError

GLOBAL, LOCAL = "nav_core::BaseGlobalPlanner", "nav_core::BaseLocalPlanner"
NEEDED = {GLOBAL: ("initialize", "make_plan"),
          LOCAL: ("initialize", "set_plan", "compute_velocity_commands", "is_goal_reached")}


@dataclass(frozen=True)
class Exported:
    """One class of an XML file: `type` is module.Class, `folder` is searched for the module."""

    name: str
    type: str
    base: str
    folder: Path
    file: Path


def exported(base: str) -> dict[str, Exported]:
    """The Python classes with this base in all packages, by name. C++ classes are left out.

    Raises ParameterError, which names the file, if one cannot be read.
    """
    packages = rospkg.RosPack()
    found = {}
    for package in packages.list():
        for attribute in _exports(packages, package):
            for each in _classes(packages.get_path(package), attribute):
                if each.base == base and "::" not in each.type:
                    found[each.name] = each
    return found


def _exports(packages: rospkg.RosPack, package: str) -> list[str]:
    """Files exported by its package.xml; a broken one is left for catkin to report."""
    try:
        return packages.get_manifest(package).get_export("nav_core", "plugin")
    except Exception:  # rospkg raises anything, UnboundLocalError among it
        return []


def _classes(package: str, attribute: str) -> list[Exported]:
    file = Path(attribute.replace("${prefix}", package))
    try:
        libraries = list(ET.parse(file).getroot().iter("library"))
        return [Exported(entry.get("name", entry.attrib["type"]), entry.attrib["type"],
                         entry.attrib["base_class_type"],
                         Path(package) / library.get("path", "."), file)
                for library in libraries for entry in library.iter("class")]
    except (OSError, ET.ParseError, KeyError) as error:
        raise ParameterError(f"{file}, named in {package}/package.xml: {error!r}; it must hold "
                             "<library path=\"src\"><class name= type= base_class_type=/>"
                             "</library>") from None


def load(entry: Exported) -> type:
    """The class. Raises ParameterError that says what is wrong, and where."""
    module, _, name = entry.type.rpartition(".")
    if str(entry.folder) not in sys.path:
        sys.path.append(str(entry.folder))
    try:
        found = getattr(importlib.import_module(module), name)
    except Exception as error:  # importing a learner's module may raise anything
        raise ParameterError(f"{entry.file}: {entry.name} is {entry.type}, but "
                             f"{type(error).__name__}: {error}") from error
    missing = [method for method in NEEDED[entry.base] if not hasattr(found, method)]
    if missing:
        raise ParameterError(f"{entry.file}: {entry.type} has no {' and no '.join(missing)}, but "
                             f"{entry.base} needs {', '.join(NEEDED[entry.base])}")
    return found
