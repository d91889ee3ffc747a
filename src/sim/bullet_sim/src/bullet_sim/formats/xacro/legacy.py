"""The order of releases before Melodic: includes first, then all macros and properties."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any
from xml.dom import minidom

import xacro

from bullet_sim.formats.xacro.expansion import elements
from bullet_sim.formats.xacro.melodic import Melodic

ONLY_IN_ORDER = ("default", "scope", "remove")  # attributes of a property


class Legacy(Melodic):
    """Macros and properties count above the line that defines them, and conditions hide none."""

    def replacements(self) -> dict[str, Any]:
        """By the names that xacro looks up."""
        return super().replacements() | {"process_doc": self.process}

    def process(self, document: minidom.Document, mappings: dict[str, str] | None = None) -> None:
        """Stands for xacro's `process_doc`."""
        self.used = True
        context = xacro.substitution_args_context
        context["arg"] = mappings or {}
        macros, symbols = xacro.Table(), xacro.Table(xacro._global_symbols)
        root = document.documentElement
        self._include(root, macros, symbols)
        for element in _everywhere(root):
            if element.tagName == "xacro:macro":
                xacro.grab_macro(element, macros)
        for element in _everywhere(root):
            if element.tagName == "xacro:property" and not any(
                map(element.hasAttribute, ONLY_IN_ORDER)
            ):
                xacro.grab_property(element, symbols)
        xacro.eval_all(root, macros, symbols)

    def _include(self, parent: minidom.Element, macros: xacro.Table, symbols: xacro.Table) -> None:
        """Puts files in the place of their includes; one named by a property waits its turn."""
        for element in elements(parent):
            if element.tagName == "xacro:arg" and element.getAttribute("default"):
                arguments = xacro.substitution_args_context["arg"]
                default = xacro.eval_text(element.getAttribute("default"), symbols)
                arguments.setdefault(element.getAttribute("name"), str(default))
            elif element.tagName != "xacro:include" or element.hasAttribute("ns"):
                self._include(element, macros, symbols)
            elif "${" not in element.getAttribute("filename"):
                xacro.process_include(element, macros, symbols, self._include)


def _everywhere(parent: minidom.Element) -> Iterator[minidom.Element]:
    """Elements below, outside of macros; the caller may remove what it gets."""
    for element in elements(parent):
        yield element
        if element.parentNode is not None and element.tagName != "xacro:macro":
            yield from _everywhere(element)
