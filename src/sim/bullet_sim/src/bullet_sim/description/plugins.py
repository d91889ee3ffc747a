"""A plugin's element as the file has it, not interpreted."""

from dataclasses import dataclass
from xml.etree.ElementTree import Element


@dataclass(frozen=True)
class PluginDescription:
    """A `<plugin>` element as written; who loads it reads the parameters."""

    name: str
    filename: str
    element: Element
