"""Reports unknown elements of an SDF text: usually they are misspelt."""

import tomllib
from collections.abc import Iterator
from functools import cache
from xml.etree.ElementTree import Element

from bullet_sim.errors import did_you_mean
from bullet_sim.formats.resources import DATA_FOLDER
from bullet_sim.formats.source import Source

MOST_WARNINGS = 20  # of one file; a file of another format has thousands of unknown elements
ALIKE = 0.75  # similarity of a misspelt tag and the intended one, 0..1


@cache
def known_children() -> dict[str, frozenset[str]]:
    """The elements allowed in an element, by its tag or by `parent/tag`."""
    table = tomllib.loads((DATA_FOLDER / "sdf_elements.toml").read_text(encoding="utf-8"))
    return {parent: frozenset(names.split()) for parent, names in table.items()}


def warn_of_unknown_elements(root: Element, source: Source, file: str = "") -> None:
    """One warning for each kind of unknown element, with the name that was probably meant.

    A tag with a colon is an extension and silently accepted.
    """
    prefix = f"{file}: " if file else ""
    first: dict[tuple[str, str], str] = {}  # (parent, tag) -> where it was first found
    for parent, tag, place in _strange(root, "", ""):
        first.setdefault((parent, tag), place)
    for (parent, tag), place in list(first.items())[:MOST_WARNINGS]:
        known = known_children()
        siblings = sorted(known.get(parent) or known[parent.rpartition("/")[2]])
        hint = did_you_mean(tag, siblings, ALIKE, "<{}>")
        source.warn_once(f"{prefix}{place}: <{tag}> is not known, left out{hint}")


def _is_old_pose(element: Element) -> bool:
    """Whether it is a pose of the oldest files, read by `xml_values.pose`, not a URDF origin."""
    return element.tag == "origin" and element.get("pose") is not None


def _strange(element: Element, parent: str, place: str) -> Iterator[tuple[str, str, str]]:
    """Unknown elements with `parent/tag` of their parent, and the names on the path to it."""
    tables = known_children()
    path = f"{parent}/{element.tag}"
    known = tables.get(path, tables.get(element.tag))
    if known is None or parent == "state":
        return
    name = element.get("name")
    if name:
        place = f"{place}, {element.tag} {name!r}" if place else f"{element.tag} {name!r}"
    else:
        place = f"{place} <{element.tag}>" if parent else ""
    for child in element:
        if child.tag in known:
            yield from _strange(child, element.tag, place)
        elif ":" not in child.tag and not _is_old_pose(child):
            yield path, child.tag, place or f"<{element.tag}>"
