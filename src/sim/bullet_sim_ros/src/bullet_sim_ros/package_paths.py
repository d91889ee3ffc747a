"""Search paths of models, media and packages: the environment, and exports to gazebo_ros."""

import logging
import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element

import rospkg

from bullet_sim.errors import FormatError, ResourceNotFound, SimulationError
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.xml_values import child_text, read_xml_file
from bullet_sim_ros.unsourced import unsourced

log = logging.getLogger("bullet_sim.packages")

MANIFESTS = ("package.xml", "manifest.xml")
INSTALLED = "/usr/share/"  # the folders in it are packages or not; they are not searched any deeper


class Package(NamedTuple):
    """One package, with the root of its manifest."""

    folder: Path
    manifest: Element


def list_packages(ros_paths: Iterable[str]) -> dict[str, Package]:
    """All packages by name; of two with one name, the first found.

    A manifest that cannot be read is one warning, and its package is named after the folder.
    """
    found: dict[str, Package] = {}
    for path in dict.fromkeys(os.path.abspath(path) for path in ros_paths):
        for file in _manifests(path):
            try:
                manifest = read_xml_file(file)
            except FormatError as error:
                log.warning("%s; what that package exports is not used", error)
                manifest = Element("package")
            name = child_text(manifest, "name") if file.name == MANIFESTS[0] else ""
            found.setdefault(name or file.parent.name, Package(file.parent, manifest))
    return found


def _manifests(path: str) -> Iterator[Path]:
    """Searches as rospkg: nothing below a package or a CATKIN_IGNORE, and no hidden folders."""
    for folder, below, files in os.walk(path, followlinks=True):
        named = [name for name in MANIFESTS if name in files]
        if "CATKIN_IGNORE" in files:
            below.clear()
        elif named:
            below.clear()
            yield Path(folder) / named[0]
        elif "rospack_nosubdirs" in files or folder.startswith(INSTALLED):
            below.clear()
        else:
            below[:] = [name for name in below if not name.startswith(".")]


def open_resources(environ: Mapping[str, str] = os.environ) -> Resources:
    """Search paths of a process with `environ`, like those of gazebo_ros_paths_plugin.cpp."""
    ros_paths = rospkg.get_ros_paths(environ)
    packages = list_packages(ros_paths)

    def find_package(name: str) -> str:
        if name not in packages:
            raise ResourceNotFound(f"package://{name}", [", ".join(ros_paths) + unsourced(name)])
        return str(packages[name].folder)

    return Resources.from_environment(
        environ,
        extra_model_paths=_exports(packages, "gazebo_model_path"),
        extra_resource_paths=_exports(packages, "gazebo_media_path"),
        find_package=find_package,
    )


def unreadable_world(name: str) -> str:
    """Why a world's file cannot be opened, for who has no ROS master yet; "" if it can."""
    try:
        read_xml_file(open_resources().find_world(name))
    except SimulationError as error:
        return why_unopened(name, error)
    return ""


def why_unopened(name: str, error: SimulationError) -> str:
    """A line about a world's file, with its name once."""
    is_missing = isinstance(error, ResourceNotFound) and error.uri == name
    return str(error) if is_missing else f"Could not open file {name}: {error}"


def _exports(packages: dict[str, Package], attribute: str) -> list[Path]:
    """The paths of `<export><gazebo_ros ATTRIBUTE="${prefix}/a:${prefix}/b"/>` in all packages."""
    found: dict[Path, None] = {}
    for package in packages.values():
        for export in package.manifest.findall("export/gazebo_ros"):
            value = export.get(attribute, "").replace("${prefix}", str(package.folder))
            found.update((Path(part), None) for part in value.split(":") if part)
    return list(found)
