"""Looks up a text's plugins, with their tags, and elements in the support table."""

from collections.abc import Iterator
from pathlib import PurePosixPath
from xml.etree.ElementTree import Element

from bullet_sim_ros.interface import ABSENT, ACCEPTED, WORKS, Entry, Row
from bullet_sim_ros.plugin_host.registry import NOT_NEEDED
from bullet_sim_ros.plugin_host.unknown import MATTERS
from workspace_needs.check.findings import Finding, problem, told

LIGHTS = ("point", "spot", "directional")


class Lookup:
    """Looks up the findings of one text."""

    def __init__(self, rows: dict[str, Row], where: str):
        self._where = where
        self._plugins = {name: row for name, row in rows.items() if name.endswith(".so")}
        self._elements = {}
        for row in rows.values():
            for name, entry in row.names():
                language, _, path = name.partition(" ")
                if language in ("sdf", "urdf"):
                    self._elements[(language, *path.split("/"))] = entry

    def findings(self, root: Element) -> Iterator[Finding]:
        """The findings of all plugins, and of elements that do not simply work."""
        language = "urdf" if root.tag == "robot" else "sdf"
        joints = {joint.get("name") for joint in root.iter("joint")}
        yield from self._walk(root, (), language, joints)

    def _walk(self, element: Element, above: tuple[str, ...], language: str,
              joints: set) -> Iterator[Finding]:
        here = (*above, _label(element, joints))
        if element.tag == "plugin":
            yield from self._plugin(element, above[-1].split("@")[0] if above else "")
            return
        kind = element.get("type", LIGHTS[0])
        if element.tag == "light" and kind not in LIGHTS:
            yield problem(self._where, f"light {element.get('name')}",
                          f"there is no type {kind!r}; there are {', '.join(LIGHTS)}")
        entry = self._entry(language, here)
        if entry is not None and entry.status != WORKS:
            yield Finding(self._where, f"<{'/'.join(here[-2:])}>", entry.status, told(entry))
        for child in element:
            if isinstance(child.tag, str):
                yield from self._walk(child, here, language, joints)

    def _entry(self, language: str, path: tuple[str, ...]) -> Entry | None:
        """The entry of the longest end of the path; the last name alone must not match."""
        for first in range(len(path) - 1):
            if entry := self._elements.get((language, *path[first:])):
                return entry
        return None

    def _plugin(self, element: Element, parent: str) -> Iterator[Finding]:
        library = PurePosixPath(element.get("filename", "").strip()).name
        name = f"plugin {element.get('name') or '(no name)'}"
        if not library:
            yield problem(self._where, name, 'it has no filename="lib….so", so nothing is loaded')
            return
        name += f" ({library})"
        if parent == "gui" or library in NOT_NEEDED:
            yield Finding(self._where, name, ACCEPTED, "nothing is missing without it")
            return
        row = self._plugins.get(library)
        if row is None:
            kind = parent if parent in MATTERS else "model"
            yield Finding(self._where, name, ABSENT, f"not known here: {MATTERS[kind]}")
            return
        yield Finding(self._where, name, row.status, told(row))
        for child in element:
            tag = row.tags.get(child.tag) if isinstance(child.tag, str) else None
            if tag is not None and tag.status != WORKS:
                yield Finding(self._where, f"{name} <{tag.name}>", tag.status, told(tag))


def _label(element: Element, joints: set) -> str:
    reference = element.get("reference") if element.tag == "gazebo" else None
    if not reference:
        return element.tag
    return "gazebo@joint" if reference in joints else "gazebo@link"
