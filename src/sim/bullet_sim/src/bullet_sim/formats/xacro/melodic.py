"""Melodic's tolerance: keywords and macro calls without prefix, macros that are all global."""

from __future__ import annotations

from typing import Any
from xml.dom import minidom

import xacro

from bullet_sim.formats.xacro.expansion import KEYWORDS, elements
from bullet_sim.formats.xacro.opening import parse


class Melodic:
    """Replaces functions of xacro for one expansion."""

    def __init__(self) -> None:
        self.used = False  # whether anything without its prefix was met
        self._call, self._grab = xacro.handle_macro_call, xacro.grab_macro

    def replacements(self) -> dict[str, Any]:
        """By the names that xacro looks up."""
        return {"parse": self.parse, "handle_macro_call": self.call, "grab_macro": self.grab}

    def parse(self, source: object, filename: str) -> minidom.Document:
        """The file with the prefix put before keywords."""
        document = parse(source, filename)
        for element in document.getElementsByTagName("*"):
            if element.tagName in KEYWORDS and not _is_sdf_include(element):
                self._prefix(element)
            elif element.tagName == "xacro:call":
                self._strip(element)
        return document

    def call(self, node: minidom.Element, macros: xacro.Table, symbols: xacro.Table) -> bool:
        """Expands a macro, whose call may lack the prefix."""
        if not node.tagName.startswith("xacro:") and _is_macro(node.tagName, macros, symbols):
            self._prefix(node)
        return self._call(node, macros, symbols)

    def grab(self, element: minidom.Element, macros: xacro.Table) -> None:
        """Keeps a macro for the whole document, as Melodic did."""
        everywhere = macros.top()
        self.used |= everywhere is not macros
        self._grab(element, everywhere)

    def _strip(self, call: minidom.Element) -> None:
        """The prefix from the name of a macro that is called by its name."""
        name = call.getAttribute("macro")
        self.used |= name.startswith("xacro:")
        call.setAttribute("macro", name.removeprefix("xacro:"))

    def _prefix(self, element: minidom.Element) -> None:
        self.used = True
        element.tagName = element.nodeName = f"xacro:{element.tagName}"


def _is_sdf_include(element: minidom.Element) -> bool:
    """Gazebo's <include> holds elements (a <uri>); xacro's holds nothing."""
    return element.tagName == "include" and bool(elements(element))


def _is_macro(tag: str, macros: xacro.Table, symbols: xacro.Table) -> bool:
    try:
        xacro.resolve_macro(tag, macros, symbols)
    except (KeyError, TypeError, AttributeError):
        return False
    return True
