"""How older releases read xacro files, for one expansion each.

Melodic: keywords and macro calls without prefix, all macros global. Before Melodic also another
order: includes first, then all macros and properties.
"""

from collections.abc import Iterator
from typing import Any
from xml.dom import minidom

import xacro

from bullet_sim.formats.xacro.expansion import KEYWORDS, elements
from bullet_sim.formats.xacro.opening import parse

ONLY_IN_ORDER = ("default", "scope", "remove")  # attributes of a property


class Melodic:
    """Replaces functions of xacro for one expansion."""

    def __init__(self) -> None:
        self.used = False  # whether anything without prefix was found
        self._call, self._grab = xacro.handle_macro_call, xacro.grab_macro

    def replacements(self) -> dict[str, Any]:
        """The replacements by the names in xacro."""
        return {"parse": self.parse, "handle_macro_call": self.call, "grab_macro": self.grab}

    def parse(self, source: object, filename: str) -> minidom.Document:
        """The file with the prefix added to keywords. TooLarge for a file beyond the limits."""
        document = parse(source, filename)
        for element in document.getElementsByTagName("*"):
            if element.tagName in KEYWORDS and not _is_sdf_include(element):
                self._prefix(element)
            elif element.tagName == "xacro:call":
                self._strip(element)
        return document

    def call(self, node: minidom.Element, macros: xacro.Table, symbols: xacro.Table) -> bool:
        """Expand a macro, whose call may lack the prefix."""
        if not node.tagName.startswith("xacro:") and _is_macro(node.tagName, macros, symbols):
            self._prefix(node)
        return self._call(node, macros, symbols)

    def grab(self, element: minidom.Element, macros: xacro.Table) -> None:
        """Keep a macro for the whole document, as Melodic did."""
        everywhere = macros.top()
        self.used |= everywhere is not macros
        self._grab(element, everywhere)

    def _strip(self, call: minidom.Element) -> None:
        """Remove the prefix from the name of a macro that is called by its name."""
        name = call.getAttribute("macro")
        self.used |= name.startswith("xacro:")
        call.setAttribute("macro", name.removeprefix("xacro:"))

    def _prefix(self, element: minidom.Element) -> None:
        self.used = True
        element.tagName = element.nodeName = f"xacro:{element.tagName}"


class Legacy(Melodic):
    """Macros and properties count before their definition, too, even within conditions."""

    def replacements(self) -> dict[str, Any]:
        """The replacements by the names in xacro."""
        return super().replacements() | {"process_doc": self.process}

    def process(self, document: minidom.Document, mappings: dict[str, str] | None = None) -> None:
        """Replaces xacro's `process_doc`."""
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
        """Replace includes by their files; one named by a property comes later."""
        for element in elements(parent):
            if element.tagName == "xacro:arg" and element.getAttribute("default"):
                arguments = xacro.substitution_args_context["arg"]
                default = xacro.eval_text(element.getAttribute("default"), symbols)
                arguments.setdefault(element.getAttribute("name"), str(default))
            elif element.tagName != "xacro:include" or element.hasAttribute("ns"):
                self._include(element, macros, symbols)
            elif "${" not in element.getAttribute("filename"):
                xacro.process_include(element, macros, symbols, self._include)


def _is_sdf_include(element: minidom.Element) -> bool:
    """Whether it is Gazebo's <include>, which has elements (a <uri>); xacro's has none."""
    return element.tagName == "include" and bool(elements(element))


def _is_macro(tag: str, macros: xacro.Table, symbols: xacro.Table) -> bool:
    try:
        xacro.resolve_macro(tag, macros, symbols)
    except (KeyError, TypeError, AttributeError):
        return False
    return True


def _everywhere(parent: minidom.Element) -> Iterator[minidom.Element]:
    """Elements below, outside of macros; the caller may remove what it gets."""
    for element in elements(parent):
        yield element
        if element.parentNode is not None and element.tagName != "xacro:macro":
            yield from _everywhere(element)
