"""A pytest plugin for conformance_audit.py: hides what the environment's CONFORMANCE_HIDE names."""

from __future__ import annotations

import os
import sys
from xml.etree.ElementTree import Element

import bullet_sim.formats  # its modules have to be there to be changed
from bullet_sim_ros import names
from bullet_sim_ros.plugins import registry
from bullet_sim_ros.plugins.parameters import PluginParameters


def pytest_configure() -> None:
    """Before any test is read."""
    name = os.environ["CONFORMANCE_HIDE"]
    row, _, tag = name.rpartition("/")
    if ".so" in name:
        _hide_plugin(row or name, tag if row else "")
    elif name.startswith("/gazebo/"):
        _hide_topic(name)
    else:
        _hide_element(name)


def _hide_plugin(library: str, tag: str) -> None:
    """The plugin does not see the tag; without a tag the plugin is not known."""
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
    """It goes by another name."""
    private = "~" + name.removeprefix("/gazebo/")
    for constant, value in list(vars(names).items()):
        if value in (private, name):
            setattr(names, constant, f"{value}_hidden")


def _hide_element(name: str) -> None:
    """`sdf a/b/c`, `urdf gazebo@link/mu1`: elements at the end of such a path are taken out."""
    path = [part.split("@")[0] for part in name.split(" ", 1)[1].split("/")]

    def strip(element: Element, above: tuple[str, ...]) -> None:
        here = (*above, element.tag)
        for child in list(element):
            if list((*here, child.tag)[-len(path):]) == path:
                element.remove(child)
            else:
                strip(child, here)

    for function in ("parse_xml", "read_xml_file"):
        original = getattr(bullet_sim.formats.xml_values, function)

        def stripped(*args, _original=original, **options):
            root = _original(*args, **options)
            strip(root, ())
            return root

        for module in list(sys.modules.values()):
            if getattr(module, function, None) is original:
                setattr(module, function, stripped)
