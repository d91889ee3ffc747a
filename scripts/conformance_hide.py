"""A pytest plugin for conformance_audit.py: hides what the environment's CONFORMANCE_HIDE names."""

from __future__ import annotations

import functools
import os
from xml.etree.ElementTree import Element

from conformance_hide_files import hide, put_in_place_of
from gazebo_msgs.msg import LinkStates, ModelStates, PerformanceMetrics

import bullet_sim.formats  # its modules must be loaded to be changed
from bullet_sim.errors import SimulationError
from bullet_sim_ros import names
from bullet_sim_ros.plugin_host import registry
from bullet_sim_ros.plugin_host.plugin_tags import PluginParameters
from bullet_sim_ros.plugins import register_plugins
from bullet_sim_ros.services import answers

TOPICS = {"model_states": ModelStates, "link_states": LinkStates,
          "performance_metrics": PerformanceMetrics}


def pytest_configure() -> None:
    """Runs before any test is collected."""
    name = os.environ["CONFORMANCE_HIDE"]
    row, _, tag = name.rpartition("/")
    if hide(name):
        return
    if ".so" in name:
        _hide_plugin(row or name, tag if row else "")
    elif name.count("/") > 2 and name.startswith("/gazebo/"):
        _hide_field(row.removeprefix("/gazebo/"), tag)
    elif name.startswith("/gazebo/"):
        _hide_topic(name)
    else:
        _hide_element(name)


def _hide_plugin(library: str, tag: str) -> None:
    """The plugin does not see the tag; without a tag the plugin is not known."""
    register_plugins()
    if not tag or tag.endswith(".so"):
        registry._registry.pop(tag or library, None)
        return
    made = PluginParameters.__init__

    def without(self, model, description):
        made(self, model, description)
        if description.filename.endswith(library):
            for child in self._element.findall(tag):
                self._element.remove(child)

    PluginParameters.__init__ = without


def _hide_topic(name: str) -> None:
    """Rename the topic."""
    private = "~" + name.removeprefix("/gazebo/")
    for constant, value in list(vars(names).items()):
        if value in (private, name):
            setattr(names, constant, f"{value}_hidden")


def _hide_field(name: str, field: str) -> None:
    """Remove `a`, `a.b` or all of `a .. c` from messages sent and requests received."""
    if name in TOPICS:
        kind = TOPICS[name]
        send = kind.serialize
        kind.serialize = lambda self, buffer: (_reset(self, field), send(self, buffer))
        return
    original, service = answers.offer, f"~{name}"

    def offer(mailbox, name, kind, handler):
        def without(request, response):
            _reset(request, field)
            try:
                handler(request, response)
            except SimulationError as error:
                raise answers.ServiceError("" if field == "status_message" else error) from None
            _reset(response, field)

        original(mailbox, name, kind, without if name == service else handler)

    put_in_place_of(original, offer)


def _reset(message, field: str) -> None:
    """Reset the field, at any depth, to its default value."""
    *path, last = field.split(".") if ".." not in field else [field]
    for part in path:
        message = getattr(message, part, None)
    first, _, last = last.partition(" .. ")
    slots = getattr(message, "__slots__", ())
    if first not in slots:
        for part in slots:
            _reset(getattr(message, part), field)
        return
    for name in slots[slots.index(first):slots.index(last or first) + 1]:
        setattr(message, name, getattr(type(message)(), name))


def _hide_element(name: str) -> None:
    """Remove the elements at a path: `sdf a/b/c`, `urdf gazebo@link/mu1`.

    `sdf a/b@c` removes only the attribute c, `sdf a/b@c/d` those b whose c is d.
    """
    language, _, written = name.partition(" ")
    above, _, attribute = written.partition("@") if language == "sdf" else (written, "", "")
    attribute, _, value = attribute.partition("/")
    path = [part.split("@")[0] for part in above.split("/")]

    def strip(element: Element, parents: tuple[str, ...]) -> None:
        here = (*parents, element.tag)
        for child in list(element):
            meant = list((*here, child.tag)[-len(path):]) == path
            if meant and attribute and not value:
                child.attrib.pop(attribute, None)
            elif meant and (not attribute or child.get(attribute) == value):
                element.remove(child)
                continue
            strip(child, here)

    for function in ("parse_xml", "read_xml_file"):
        original = getattr(bullet_sim.formats.xml_values, function)

        @functools.wraps(original)
        def stripped(*args, _original=original, **options):
            root = _original(*args, **options)
            root.tag = "hidden" if [root.tag] == path else root.tag
            strip(root, ())
            return root

        put_in_place_of(original, stripped)
