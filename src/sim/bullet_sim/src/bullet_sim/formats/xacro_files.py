"""Expands xacro files with PyPI's xacro, and those without the xacro: prefix as ROS Melodic did."""

from __future__ import annotations

import logging
import threading
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.dom import minidom
from xml.parsers.expat import ExpatError

import xacro
from xacro import substitution_args

from bullet_sim.errors import FormatError

FindPackage = Callable[[str], str]  # package name -> its folder; raises when there is none

_LOCK = threading.Lock()  # xacro keeps its state in module variables: one expansion at a time
_LOGGER = logging.getLogger(__name__)
_KEYWORDS = frozenset(["arg", "if", "include", "insert_block", "macro", "property", "unless"])
_ROBOT_TAGS = frozenset([
    # URDF
    "gazebo", "joint", "link", "material", "origin", "sensor", "transmission",
    # SRDF
    "disable_collisions", "disable_default_collisions", "enable_collisions", "end_effector",
    "group", "group_state", "joint_property", "link_sphere_approximation", "passive_joint",
    "virtual_joint",
])


@dataclass(frozen=True)
class Expansion:
    """What a file became."""

    text: str  # the XML document
    files: tuple[str, ...]  # what it read besides itself, in order


def expand(
    path: str | Path,
    mappings: Mapping[str, str] | None = None,
    find_package: FindPackage | None = None,
) -> str:
    """The XML text of a xacro file; `mappings` are its arguments, `find_package` its $(find …)."""
    return expand_file(path, mappings, find_package).text


def expand_file(
    path: str | Path,
    mappings: Mapping[str, str] | None = None,
    find_package: FindPackage | None = None,
) -> Expansion:
    """As `expand`, and which other files took part.

    Read strictly first. When that fails or leaves tags that URDF does not know, the file may be an
    old one: macros and keywords then also count without their prefix, and the result is kept if no
    two links and no two joints share a name.
    """
    run = _Run(str(path), dict(mappings or {}), find_package)
    with _LOCK:
        attempt = _choose(run)
    for level, text in attempt.messages:
        _LOGGER.log(level, "%s", text)
    return Expansion(attempt.document.toprettyxml(indent="  "), attempt.files)


@dataclass(frozen=True)
class _Run:
    path: str
    mappings: dict[str, str]
    find_package: FindPackage | None


@dataclass(frozen=True)
class _Attempt:
    document: minidom.Document
    files: tuple[str, ...]
    messages: list[tuple[int, str]]

    def unknown_tags(self) -> list[str]:
        """Top-level tags that look like calls nobody answered."""
        root = self.document.documentElement
        tags = [element.tagName for element in _elements(root)]
        if root.tagName == "robot":
            return [tag for tag in tags if tag not in _ROBOT_TAGS]
        return [tag for tag in tags if tag in _KEYWORDS]

    def has_unique_names(self) -> bool:
        """Whether each link and each joint has a name of its own."""
        children = _elements(self.document.documentElement)
        names = Counter((child.tagName, child.getAttribute("name")) for child in children)
        return all(n == 1 for (tag, _), n in names.items() if tag in ("link", "joint"))


def _choose(run: _Run) -> _Attempt:
    """The strict reading, or Melodic's where that one is better; see `expand_file`."""
    strict, problem = None, None
    try:
        strict = _attempt(run, {"parse": _parse})
        if not strict.unknown_tags():
            return strict
    except FormatError as error:
        problem = error

    melodic = _Melodic()
    try:
        loose = _attempt(run, melodic.replacements())
        if melodic.used and loose.has_unique_names():
            return _with_hint(loose, run.path)
    except FormatError as error:
        if problem and melodic.used:  # an old file: the strict reading failed for want of prefixes
            problem = error
    if strict is None:
        raise problem
    return _with_hint(strict, run.path)


def _with_hint(attempt: _Attempt, path: str) -> _Attempt:
    """The same, with a warning when something was perhaps meant as a macro."""
    if tags := dict.fromkeys(attempt.unknown_tags()):
        names = ", ".join(f"<{tag}>" for tag in tags)
        hint = f"{path}: {names} left as it is: no macro and no tag of URDF or SRDF"
        attempt.messages.append((logging.WARNING, hint))
    return attempt


def _attempt(run: _Run, replacements: dict[str, Any]) -> _Attempt:
    """Expands once, with these functions of xacro replaced."""
    messages = _Messages()
    with _private_state(replacements, messages, run.find_package):
        try:
            document = xacro.process_file(run.path, mappings=dict(run.mappings))
        except Exception as error:  # expressions in the file may raise anything
            place, reason = _place(run.path), _reason(error)
            text = reason if reason.startswith(place) else f"{place}: {reason}"
            raise FormatError(text) from error
        return _Attempt(document, tuple(xacro.all_includes), messages.lines)


@contextmanager
def _private_state(
    replacements: dict[str, Any], messages: _Messages, find_package: FindPackage | None
) -> Iterator[None]:
    """Fresh module variables for one expansion; the old ones come back afterwards."""
    fresh = {
        "message": messages.message, "warning": messages.warning, "error": messages.error,
        "print_location": messages.print_location, "verbosity": 1, "all_includes": [],
        "filestack": None, "macrostack": None, "substitution_args_context": {}, **replacements,
    }
    with (
        _swapped(vars(xacro), fresh),
        _swapped(vars(xacro), {"_global_symbols": xacro.create_global_symbols()}),  # binds `fresh`
        _swapped(vars(substitution_args), {"_eval_find": _finder(find_package)}),
    ):
        yield


@contextmanager
def _swapped(table: dict[str, Any], values: dict[str, Any]) -> Iterator[None]:
    before = {name: table[name] for name in values}
    table.update(values)
    try:
        yield
    finally:
        table.update(before)


class _Messages:
    """Stands in for xacro's own messages, which would go to the terminal."""

    def __init__(self) -> None:
        self.lines: list[tuple[int, str]] = []

    def message(self, *words: object, **_: object) -> None:
        self._add(logging.INFO, words)

    def warning(self, *words: object, **_: object) -> None:
        self._add(logging.WARNING, words)

    def error(self, *words: object, **_: object) -> None:
        self._add(logging.ERROR, words)

    def print_location(self) -> None:
        """Nothing: every line names its place."""

    def _add(self, level: int, words: tuple[object, ...]) -> None:
        text = _one_line(" ".join(map(str, words)))
        self.lines.append((level, f"{_place('xacro')}: {text}"))


class _Melodic:
    """Melodic's tolerance: keywords and macro calls without prefix, macros that are all global."""

    def __init__(self) -> None:
        self.used = False  # whether anything without its prefix was met
        self._call, self._grab = xacro.handle_macro_call, xacro.grab_macro

    def replacements(self) -> dict[str, Any]:
        return {"parse": self.parse, "handle_macro_call": self.call, "grab_macro": self.grab}

    def parse(self, source: object, filename: str) -> minidom.Document:
        document = _parse(source, filename)
        for element in document.getElementsByTagName("*"):
            if element.tagName in _KEYWORDS and not _is_sdf_include(element):
                self._prefix(element)
        return document

    def call(self, node: minidom.Element, macros: xacro.Table, symbols: xacro.Table) -> bool:
        if not node.tagName.startswith("xacro:") and _is_macro(node.tagName, macros, symbols):
            self._prefix(node)
        return self._call(node, macros, symbols)

    def grab(self, element: minidom.Element, macros: xacro.Table) -> None:
        everywhere = macros.top()
        self.used |= everywhere is not macros
        self._grab(element, everywhere)

    def _prefix(self, element: minidom.Element) -> None:
        self.used = True
        element.tagName = element.nodeName = f"xacro:{element.tagName}"


def _is_sdf_include(element: minidom.Element) -> bool:
    """Gazebo's <include> holds elements (a <uri>); xacro's holds nothing."""
    return element.tagName == "include" and bool(_elements(element))


def _is_macro(tag: str, macros: xacro.Table, symbols: xacro.Table) -> bool:
    try:
        xacro.resolve_macro(tag, macros, symbols)
    except (KeyError, TypeError, AttributeError):
        return False
    return True


def _parse(_source: object, filename: str) -> minidom.Document:
    """Reads bytes, so that the file's own encoding counts and not the terminal's."""
    try:
        content = Path(filename).read_bytes()
    except OSError as error:
        xacro.filestack.pop()  # the place of the mistake is the file that asked for this one
        reason = "does not exist" if isinstance(error, FileNotFoundError) else error.strerror
        raise xacro.XacroException(f"{filename} {reason}", exc=error) from error
    return minidom.parseString(content)


def _finder(find_package: FindPackage | None) -> FindPackage:
    def find(name: str) -> str:
        if find_package is None:
            raise FormatError(f"$(find {name}): packages cannot be looked up here")
        try:
            return str(find_package(name))
        except Exception as error:  # each resolver has its own way of saying no
            raise FormatError(f"$(find {name}): package not found: {error}") from error

    return find


def _place(default: str) -> str:
    """The file being read, and the macro being expanded in it."""
    place = xacro.filestack[-1] if xacro.filestack else default
    if xacro.macrostack:
        place += f": macro {xacro.macrostack[-1].body.getAttribute('name')}"
    return place


def _reason(error: BaseException) -> str:
    """One line for people, from the exception at the bottom of xacro's wrapping ones."""
    root = error
    while getattr(root, "exc", None) is not None:
        root = root.exc
    if isinstance(root, FormatError):
        return _one_line(str(root))
    if isinstance(root, OSError) and isinstance(error, xacro.XacroException):
        return _one_line(error.args[0] or str(root))
    if isinstance(root, substitution_args.ArgException):
        return f"argument {root} has no value: pass {root}:=VALUE or give its xacro:arg a default"
    if isinstance(root, ExpatError):
        return f"XML error: {root}"
    text = _one_line(str(error))
    if not text or text.startswith("<class"):  # xacro's wording for what it did not expect
        text = f"{type(root).__name__}: {_one_line(str(root))}"
    return text.replace("name '", "property '", 1) if isinstance(root, NameError) else text


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _elements(node: minidom.Element) -> list[minidom.Element]:
    return [child for child in node.childNodes if child.nodeType == child.ELEMENT_NODE]
