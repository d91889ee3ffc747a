"""Checks robot and world texts: reads and spawns them as the simulator would, with its log.

Their plugins, with the tags, and their elements are looked up in the support table.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath
from xml.etree.ElementTree import Element

from bullet_sim.description import ModelDescription
from bullet_sim.errors import FormatError, SimulationError
from bullet_sim.formats.loading import load_entity, load_world
from bullet_sim.formats.resources import DATA_FOLDER, Resources
from bullet_sim.formats.sdf.include import model_file
from bullet_sim.formats.xml_text import decoded, read_bytes
from bullet_sim.formats.xml_values import child_text, parse_xml, read_xml_file
from bullet_sim_ros.interface import ABSENT, ACCEPTED, APPROXIMATED, WORKS, Entry, Row
from bullet_sim_ros.plugin_host.registry import NOT_NEEDED
from bullet_sim_ros.plugin_host.unknown import MATTERS
from workspace_needs.check.dry_run import LogLine, listening, try_model, try_world
from workspace_needs.check.findings import Finding, problem, told
from workspace_needs.check.parameter_commands import expanded

LIGHTS = ("point", "spot", "directional")
NEEDS_MASS = "an <inertial>"  # the end of the error for a robot without any


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


class TextChecker:
    """Checks robots and worlds, with the resources of this environment."""

    def __init__(self, rows: dict[str, Row], resources: Resources):
        self._rows = rows
        self._resources = resources

    def model_file(self, path: Path, arguments: dict[str, str], shown_only: bool = False
                   ) -> list[Finding]:
        """A .urdf, .xacro or .sdf file; xacro is expanded first.

        `shown_only`: nobody asked to spawn it.
        """
        where = str(path)
        try:
            text = (expanded(path, arguments, self.find_package) if path.suffix == ".xacro"
                    else _utf8(path))
        except SimulationError as error:
            return [problem(where, "robot", error)]
        found = self.model_text(text, where)
        if shown_only and found[0].how.endswith(NEEDS_MASS) and is_for_show(text):
            how = "only to be shown: nothing in it has mass"
            return [Finding(where, "robot", APPROXIMATED, how)]
        return found

    def with_resources(self, resources: Resources) -> TextChecker:
        """A checker with other search paths."""
        return TextChecker(self._rows, resources)

    def find_package(self, name: str) -> str:
        """The package's folder. ResourceNotFound if there is none."""
        return str(self._resources.package_folder(name))

    def model_text(self, text: str, where: str, parameters: Mapping[str, object] | None = None,
                   namespace: str = "") -> list[Finding]:
        """A robot or model, spawned into an empty world with its plugins.

        `parameters` are those of the parameter server by full name; by default, the robot's text is
        in /robot_description.
        """
        if parameters is None:
            parameters = {"/robot_description": text}
        with listening() as captured:
            try:
                description = load_entity(text, self._resources)
                if isinstance(description, ModelDescription):
                    try_model(description, parameters, namespace)
            except SimulationError as error:
                return [problem(where, "robot", error)]
        if not isinstance(description, ModelDescription):
            return [Finding(where, "light", WORKS), *self._details(text, where, None)]
        links = f"{len(description.links)} links, {len(description.joints)} joints"
        return [Finding(where, f"model {description.name} ({links})", WORKS),
                *_not_failed(self._details(text, where, None), captured), *_logged(captured, where)]

    def world_file(self, path: Path, parameters: Mapping[str, object] | None = None
                   ) -> list[Finding]:
        """A world with all that it includes."""
        where = str(path)
        with listening() as captured:
            try:
                text = decoded(read_bytes(path))
                description = load_world(path, self._resources)
                try_world(description, parameters or {})
            except (SimulationError, OSError) as error:
                return [problem(where, "world", error)]
        name = f"world {description.name} ({len(description.models)} models)"
        details = _not_failed(self._details(text, where, path.parent), captured)
        return [Finding(where, name, WORKS), *details, *_logged(captured, where)]

    def _details(self, text: str, where: str, folder: Path | None) -> list[Finding]:
        """Findings about plugins and elements of the text in `folder`, and of included files."""
        with listening():  # what the reader warns of was said when the text was loaded
            root = _root(text)
            if root is None:
                return []
            found = list(Lookup(self._rows, where).findings(root))
            for uri, inner in included(root, folder, self._resources, set()):
                found += Lookup(self._rows, f"{where}, included {uri}").findings(inner)
        return found


def _utf8(path: Path) -> str:
    """The text, decoded as by roslaunch, which knows no other encoding."""
    content = read_bytes(path)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise FormatError(f"{path}, line {line}: this is not UTF-8, which roslaunch needs; save "
                          "the file as UTF-8") from None


def _logged(captured: list[LogLine], where: str) -> list[Finding]:
    return [Finding(where, "it says", each.status,
                    " ".join(each.line.split()).replace("the text, ", f"{where}, "))
            for each in captured]


def _not_failed(details: list[Finding], captured: list[LogLine]) -> list[Finding]:
    """The findings without those of plugins that work by the table but were not loaded."""
    return [found for found in details
            if not any(f"{found.part} is not loaded" in each.line for each in captured)]


def _root(text: str) -> Element | None:
    try:
        return parse_xml(text)
    except FormatError:
        return None


def is_for_show(text: str) -> bool:
    """Whether it is a URDF in which nothing has mass: RViz shows it, no simulator can move it."""
    with listening():
        root = _root(text)
    return root is not None and root.tag == "robot" and root.find("link") is not None and (
        root.find("link/inertial") is None)


def included(root: Element, folder: Path | None, resources: Resources,
             seen: set[Path]) -> Iterator[tuple[str, Element]]:
    """URI and root element of each included file, at any depth, once.

    Without those that come with the simulator, and those that cannot be read, which are errors
    when the text is loaded.
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
