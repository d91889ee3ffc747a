"""The model files that a text includes."""

from collections.abc import Iterator
from pathlib import Path
from xml.etree.ElementTree import Element

from bullet_sim.errors import SimulationError
from bullet_sim.formats import Resources
from bullet_sim.formats.resources import DATA_FOLDER
from bullet_sim.formats.sdf.include import model_file
from bullet_sim.formats.xml_values import child_text, read_xml_file


def included(root: Element, folder: Path | None, resources: Resources,
             seen: set[Path]) -> Iterator[tuple[str, Element]]:
    """URI and root element of each included file, at any depth, once.

    Without those that come with the simulator; what cannot be read, its loader complains of.
    """
    for include in root.iter("include"):
        uri = child_text(include, "uri")
        try:
            file = model_file(resources.resolve(uri, folder))
            if file in seen or DATA_FOLDER in file.parents:
                continue
            seen.add(file)
            inner = read_xml_file(file)
        except SimulationError:
            continue
        yield uri, inner
        yield from included(inner, file.parent, resources, seen)
