"""The source of a text that is being read, and the warnings already logged."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from xml.etree.ElementTree import Element

from bullet_sim.description import ModelDescription
from bullet_sim.errors import shortened
from bullet_sim.formats.resources import Resources

logger = logging.getLogger(__name__)

NEWEST_SDF = (1, 7)


@dataclass(frozen=True)
class Source:
    """One text with its SDF version; everything that it includes shares `warned` and `scripts`."""

    resources: Resources
    # Reads a file named by an <include>, SDF or URDF; the URDF reader itself uses the SDF reader.
    read_root: Callable[[Element, Source], ModelDescription] | None = None
    version: tuple[int, int] = NEWEST_SDF
    folder: Path | None = None  # of the text's file
    warned: set[str] = field(default_factory=set)
    scripts: dict = field(default_factory=dict)  # material script path -> parsed materials
    including: tuple[Path, ...] = ()  # files being read, outermost first
    files: list[Path] = field(default_factory=list)  # all that were included

    def warn_once(self, message: str, about: str = "") -> None:
        """Log a warning once per load; with `about`, once for all that have the same one."""
        key = about or message
        if key not in self.warned:
            self.warned.add(key)
            logger.warning("%s", shortened(message))

    def of_root(self, root: Element) -> Source:
        """This source with the version given by an `<sdf>` or `<gazebo>` root."""
        return replace(self, version=sdf_version(root.get("version", "")))

    def entering(self, file: Path) -> Source:
        """A source for a file that this one includes."""
        return replace(self, folder=file.parent, including=(*self.including, file))


def sdf_version(text: str) -> tuple[int, int]:
    """`1.6` as (1, 6); the newest if nothing readable is written."""
    major, _, minor = text.strip().partition(".")
    try:
        return (int(major), int(minor or 0))
    except ValueError:
        return NEWEST_SDF
