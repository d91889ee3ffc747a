"""The packages of a ROS package path, whatever state their manifests are in.

rospkg refuses a manifest for what has no bearing on where its package is, such as an e-mail, and
with it all packages where it is no XML.
"""

import logging
import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element

from bullet_sim.errors import FormatError
from bullet_sim.formats.xml_values import child_text, read_xml_file

log = logging.getLogger("bullet_sim.packages")

MANIFESTS = ("package.xml", "manifest.xml")
INSTALLED = "/usr/share/"  # each folder in it is a package or none, and is looked no deeper into


class Package(NamedTuple):
    """One package, with the root of its manifest."""

    folder: Path
    manifest: Element


def list_packages(ros_paths: Iterable[str]) -> dict[str, Package]:
    """All packages by name; of two of a name the one that is found first.

    A manifest that cannot be read is one warning, and its package goes by the folder's name.
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
    """As rospkg walks: nothing below a package or a CATKIN_IGNORE, and no hidden folders."""
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
