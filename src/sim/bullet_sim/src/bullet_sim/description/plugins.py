"""A plugin's element as written in the file, not interpreted."""

from dataclasses import dataclass
from xml.etree.ElementTree import Element


@dataclass(frozen=True)
class PluginDescription:
    """A `<plugin>` element as written; its loader reads the parameters."""

    name: str
    filename: str
    element: Element
