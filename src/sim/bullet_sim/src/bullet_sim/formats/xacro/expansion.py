"""One expansion by PyPI's xacro: its module variables made private, its messages collected."""

from __future__ import annotations

import logging
import sys
from collections import Counter
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any
from xml.dom import minidom

import xacro
from xacro import substitution_args

from bullet_sim.errors import FormatError
from bullet_sim.formats.xacro import substitutions
from bullet_sim.formats.xacro.bounds import Budget, TooLarge, noted_eval
from bullet_sim.formats.xacro.errors import located, one_line, place, root_of
from bullet_sim.formats.xacro.expressions import evaluate, evaluate_substitution, restricted
from bullet_sim.formats.xacro.nodes import Siblings
from bullet_sim.formats.xacro.opening import load_yaml, parse

FindPackage = Callable[[str], str]  # package name -> its folder; raises if there is none

# Python calls. Python's default of 1000 suits ROS's xacro, which needs fewer calls for a macro.
DEEPEST = 2000
KEYWORDS = frozenset(["arg", "if", "include", "insert_block", "macro", "property", "unless"])
_ROBOT_TAGS = frozenset([
    # URDF
    "gazebo", "joint", "link", "material", "origin", "sensor", "transmission",
    # SRDF
    "disable_collisions", "disable_default_collisions", "enable_collisions", "end_effector",
    "group", "group_state", "joint_property", "link_sphere_approximation", "passive_joint",
    "virtual_joint",
])
BLOCK = "insert_block"  # no other tag has this name
_CONDITIONS = frozenset(["if", "unless"])
_TAGS_OF_URDF = frozenset([
    "acceleration", "actuator", "axis", "box", "calibration", "capsule", "child", "collision",
    "color", "cylinder", "dynamics", "geometry", "hardwareInterface", "inertia", "inertial",
    "joint", "limit", "link", "mass", "material", "mechanicalReduction", "mesh", "mimic", "origin",
    "parent", "role", "safety_controller", "sphere", "texture", "type", "verbose", "visual",
])


@dataclass(frozen=True)
class Run:
    """The input of an expansion."""

    path: str
    mappings: dict[str, str]
    find_package: FindPackage | None


@dataclass(frozen=True)
class Attempt:
    """The result of one reading."""

    path: str
    document: minidom.Document
    files: tuple[str, ...]
    messages: list[tuple[int, str]]
    macros: frozenset[str] = frozenset()  # the names of the defined macros

    def text(self) -> str:
        """The document as XML. FormatError if it is nested too deep."""
        try:
            return self.document.toprettyxml(indent="  ")
        except RecursionError:
            raise FormatError(f"{self.path}: elements are nested too deep to be written; "
                              "flatten them") from None

    def unknown_tags(self) -> list[str]:
        """Tags that look like calls of undefined macros."""
        root = self.document.documentElement
        tags = [element.tagName for element in elements(root)]
        inside = _unanswered_inside(root, self.macros)
        if root.tagName == "robot":
            return [tag for tag in tags if tag not in _ROBOT_TAGS] + inside
        return [tag for tag in tags if tag in KEYWORDS] + inside

    def has_unique_names(self) -> bool:
        """Whether all links and all joints have different names."""
        children = elements(self.document.documentElement)
        names = Counter((child.tagName, child.getAttribute("name")) for child in children)
        return all(n == 1 for (tag, _), n in names.items() if tag in ("link", "joint"))


def _unanswered_inside(root: minidom.Element, macros: Collection[str]) -> list[str]:
    """Tags below the top level that need the prefix: keywords, and calls of these macros.

    In a `<gazebo>` tag and in SDF only blocks count: a macro may be named like SDF's `<camera>`.
    """
    found = [BLOCK] * len(root.getElementsByTagName(BLOCK))
    if root.tagName != "robot":
        return found
    calls = _CONDITIONS | set(macros) - _TAGS_OF_URDF
    for part in root.childNodes:
        if part.nodeType == part.ELEMENT_NODE and part.tagName != "gazebo":
            found += [element.tagName for element in part.getElementsByTagName("*")
                      if element.tagName in calls]
    return found


def attempt(run: Run, replacements: dict[str, Any]) -> Attempt:
    """Expand once, with these functions of xacro replaced; FormatError (TooLarge) is one line."""
    messages, macros = _Messages(), set()
    grab = replacements.get("grab_macro", xacro.grab_macro)

    def noted_grab(element: minidom.Element, table: xacro.Table) -> None:
        macros.add(element.getAttribute("name").removeprefix("xacro:"))
        grab(element, table)

    replacements = {**replacements, "grab_macro": noted_grab}
    with _private_state(replacements, messages, run.find_package):
        try:
            document = xacro.process_file(run.path, mappings=substitutions.Arguments(run.mappings))
            _only_text(document)
        except Exception as error:  # expressions in the file may raise anything
            beyond = isinstance(root_of(error), TooLarge | RecursionError | MemoryError)
            kind = TooLarge if beyond else FormatError
            raise kind(located(error, run.path)) from error
        return Attempt(run.path, document, tuple(xacro.all_includes), messages.lines,
                       frozenset(macros))


def _only_text(document: minidom.Document) -> None:
    """Make text of numbers from <xacro:attribute>, which cannot be written otherwise."""
    for element in document.getElementsByTagName("*"):
        for attribute in element.attributes.values():
            if not isinstance(attribute.value, str):
                attribute.value = str(attribute.value)


@contextmanager
def _private_state(
    replacements: dict[str, Any], messages: _Messages, find_package: FindPackage | None
) -> Iterator[None]:
    """Fresh module variables for one expansion; the old ones are restored afterwards."""
    budget = Budget()
    fresh = {
        "message": messages.at(logging.INFO), "warning": messages.at(logging.WARNING),
        "error": messages.at(logging.ERROR),
        "print_location": lambda: None, "verbosity": 1, "all_includes": [],  # each line has a place
        "filestack": None, "macrostack": None, "substitution_args_context": {"filename": ""},
        "parse": parse, "LEXER": substitutions.LEXER, "replace_node": budget.replace_node,
        "safe_eval": noted_eval(evaluate), "eval_text": budget.eval_text,
        "load_yaml": load_yaml, **replacements,
    }
    commands = {"_eval_find": _finder(find_package), "_eval_dirname": substitutions.directory,
                "resolve_args": substitutions.resolver(substitution_args.resolve_args),
                "eval": evaluate_substitution}
    depth = sys.getrecursionlimit()
    sys.setrecursionlimit(max(depth, DEEPEST))
    try:
        with (
            _swapped(vars(xacro), fresh),
            _swapped(vars(xacro), {"_global_symbols": restricted(xacro.create_global_symbols())}),
            _swapped(vars(substitution_args), commands),
            _swapped(vars(minidom), {"NodeList": Siblings}),
            _swapped(substitution_args._eval_dict, {"find": commands["_eval_find"]}),
        ):
            yield
    finally:
        sys.setrecursionlimit(depth)


@contextmanager
def _swapped(table: dict[str, Any], values: dict[str, Any]) -> Iterator[None]:
    before = {name: table[name] for name in values if name in table}
    table.update(values)
    try:
        yield
    finally:
        for name in values:
            del table[name]
        table.update(before)


class _Messages:
    """Replaces xacro's own messages, which would go to the terminal."""

    def __init__(self) -> None:
        self.lines: list[tuple[int, str]] = []

    def at(self, level: int) -> Callable[..., None]:
        """A function for xacro that keeps a line, to be logged when the expansion is over."""
        def keep(*words: object, **_: object) -> None:
            text = one_line(" ".join(map(str, words)))
            self.lines.append((level, f"{place('xacro')}: {text}"))

        return keep


def _finder(find_package: FindPackage | None) -> FindPackage:
    def find(name: str) -> str:
        if find_package is None:
            raise FormatError(f"$(find {name}): packages cannot be looked up here")
        try:
            return str(find_package(name))
        except Exception as error:  # each resolver has its own exceptions
            raise FormatError(f"$(find {name}): package not found: {error}") from error

    return find


def elements(node: minidom.Element) -> list[minidom.Element]:
    """The child elements."""
    return [child for child in node.childNodes if child.nodeType == child.ELEMENT_NODE]
