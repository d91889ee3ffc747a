"""Reads XML text, and numbers, vectors, colours and poses out of it, with errors that say where."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from bullet_sim.description import Rgba
from bullet_sim.errors import FormatError
from bullet_sim.pose import IDENTITY, Pose, Vector3

TRUE_WORDS = ("true", "1")


def parse_xml(text: str, what: str = "XML") -> Element:
    """Root element of a text. Prefixes such as `xacro:` stay part of the tag, declared or not."""
    stripped = text.lstrip("\ufeff \t\r\n")
    skipped_lines = text[:len(text) - len(stripped)].count("\n")
    builder = TreeBuilder()
    parser = expat.ParserCreate()
    parser.StartElementHandler = builder.start
    parser.EndElementHandler = builder.end
    parser.CharacterDataHandler = builder.data
    parser.buffer_text = True
    try:
        parser.Parse(stripped, True)
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code)
        place = f"line {error.lineno + skipped_lines}, column {error.offset + 1}"
        raise FormatError(f"{what} is not well-formed XML: {reason} at {place}") from None
    return builder.close()


def read_xml_file(path: Path) -> Element:
    """Root element of a file; letters of another encoding than UTF-8 are read as placeholders."""
    return parse_xml(path.read_text(encoding="utf-8", errors="replace"), str(path))


def numbers(text: str, count: int, where: str) -> tuple[float, ...]:
    """`count` finite numbers parted by any white space."""
    words = text.split()
    try:
        values = tuple(float(word) for word in words)
    except ValueError:
        values = ()
    if len(values) != count or any(math.isnan(value) for value in values):
        wanted = "a number" if count == 1 else f"{count} numbers"
        raise FormatError(f"{where}: {text.strip()!r} is not {wanted}")
    if any(math.isinf(value) for value in values):
        raise FormatError(f"{where}: {text.strip()!r} is not finite")
    return values


def not_negative(values: Sequence[float], where: str) -> Sequence[float]:
    """The same numbers, or an error that names the first below zero."""
    for value in values:
        if value < 0.0:
            raise FormatError(f"{where}: {value:g} is negative")
    return values


def child_text(parent: Element, path: str, default: str = "") -> str:
    """Trimmed text of the first element at `path`; the default where it is absent or blank."""
    return (parent.findtext(path) or "").strip() or default


def number(parent: Element, path: str, default: float, where: str) -> float:
    """One number at `path`."""
    text = child_text(parent, path)
    return numbers(text, 1, f"{where} <{path}>")[0] if text else default


def amount(parent: Element, path: str, default: float, where: str) -> float:
    """One number at `path` that is not below zero."""
    return not_negative([number(parent, path, default, where)], f"{where} <{path}>")[0]


def integer(parent: Element, path: str, default: int, where: str) -> int:
    """One whole number at `path`; `8.0` counts as 8, as saved files write it."""
    value = number(parent, path, float(default), where)
    if value != int(value):
        raise FormatError(f"{where} <{path}>: {value} is not a whole number")
    return int(value)


def flag(parent: Element, path: str, default: bool) -> bool:
    """A truth value at `path`: SDF knows `true`, `1` and everything else."""
    text = child_text(parent, path).lower()
    return text in TRUE_WORDS if text else default


def vector(parent: Element, path: str, default: Vector3, where: str) -> Vector3:
    """Three numbers at `path`."""
    text = child_text(parent, path)
    return numbers(text, 3, f"{where} <{path}>") if text else default


def colour(parent: Element, path: str, default: Rgba, where: str) -> Rgba:
    """Red, green, blue and, if written, alpha at `path`."""
    text = child_text(parent, path)
    if not text:
        return default
    count = 3 if len(text.split()) == 3 else 4
    return (*numbers(text, count, f"{where} <{path}>"), 1.0)[:4]


def pose(parent: Element, where: str) -> Pose:
    """The `<pose>` of an element in whatever frame it names; identity when absent."""
    text = child_text(parent, "pose")
    if not text:
        return IDENTITY
    values = numbers(text, 6, f"{where} <pose>")
    return Pose.from_xyz_rpy(values[:3], values[3:])


def vector_text(values: Sequence[float]) -> str:
    """Numbers as XML text that reads back to the same floats."""
    return " ".join(repr(float(value)) for value in values)
