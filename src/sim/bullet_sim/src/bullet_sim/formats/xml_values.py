"""Numbers, vectors, colours and poses from XML elements, with errors that say where.

The readers with a default log one error line and return the default for unreadable values, as in
sdformat's Param.cc, SetFromString; the checks without one (`numbers`, `not_negative`, `bounded`)
raise FormatError.
"""

import math
import re
import textwrap
from collections.abc import Callable, Collection, Sequence
from typing import Any, TypeVar
from xml.etree.ElementTree import Element

from bullet_sim.description import Rgba
from bullet_sim.errors import FormatError
from bullet_sim.formats.mistakes import instead
from bullet_sim.formats.xml_text import parse_xml, read_xml_file
from bullet_sim.pose import IDENTITY, Pose, Vector3

__all__ = [
    "amount", "bounded", "child_text", "colour", "fields", "flag", "integer", "length",
    "not_negative", "number", "numbers", "or_default", "parse_xml", "pose", "read_xml_file",
    "shown", "size", "vector", "vector_text",
]

HEXADECIMAL = re.compile("[+-]?0x", re.IGNORECASE)
TRUE_WORDS = ("true", "1")
# Lengths, masses and poses beyond this are mistakes, and their squares overflow.
# (Limits of joints may be larger: saved files contain the largest number there is.)
LARGEST = 1e12
LONGEST_QUOTE = 80  # characters
Value = TypeVar("Value")


def numbers(text: str, count: int, where: str) -> tuple[float, ...]:
    """`count` finite numbers separated by white space. FormatError for anything else.

    Hexadecimal ones begin with 0x, as in sdformat's Param.cc.
    """
    words = text.split()
    try:
        values = tuple(float.fromhex(word) if HEXADECIMAL.match(word) else float(word)
                       for word in words)
    except (ValueError, OverflowError):  # float.fromhex has no infinity for 0x1p9999
        values = ()
    if len(values) != count or any(math.isnan(value) for value in values):
        raise FormatError(f"{where}: {_quoted(text)} is not a number" if count == 1 else
                          f"{where}: {_quoted(text)} is not {count} numbers")
    if any(math.isinf(value) for value in values):
        raise FormatError(f"{where}: {_quoted(text)} is not finite")
    return values


def _quoted(text: str) -> str:
    """For an error line: one line, and not a long one."""
    return repr(textwrap.shorten(text, LONGEST_QUOTE, placeholder="…"))


def not_negative(values: Sequence[float], where: str) -> Sequence[float]:
    """The same numbers; FormatError names the first that is negative or beyond `LARGEST`."""
    for value in values:
        if value < 0.0:
            raise FormatError(f"{where}: {value:g} is negative")
    return bounded(values, where)


def bounded(values: Sequence[float], where: str) -> Sequence[float]:
    """The same numbers; FormatError names the first whose absolute value is beyond `LARGEST`."""
    for value in values:
        if abs(value) > LARGEST:
            raise FormatError(f"{where}: {value:g} is too large; at most {LARGEST:g} is possible")
    return values


def child_text(parent: Element, path: str, default: str = "") -> str:
    """Stripped text of the first element at `path`; the default if it is absent or blank."""
    return (parent.findtext(path) or "").strip() or default


def or_default(read: Callable[[], Value], default: Value) -> Value:
    """The result of `read`; the default, with an error line, if it raises FormatError."""
    try:
        return read()
    except FormatError as error:
        instead(error, shown(default))
        return default


def one_of(known: Collection[str], kind: str, written: str, usual: str, where: str) -> str:
    """The written word; the usual one, with an error line, if it is unknown.

    `kind` says what the words are names of.
    """
    if written in known:
        return written
    instead(FormatError(f"{where}: no {kind} named {written!r}; there are: {', '.join(known)}"),
            shown(usual))
    return usual


def shown(value: float | Sequence[float] | Pose | str) -> str:
    """A value as written in a file, for an error line."""
    match value:
        case str():
            return repr(value)
        case Pose():
            value = (*value.position, *value.rpy())
        case int() | float():
            value = (value,)
    return " ".join(f"{part:g}" for part in value)


def _number(
    parent: Element, path: str, default: float, where: str,
    check: Callable[[Sequence[float], str], Sequence[float]] = lambda values, _: values,
) -> float:
    text = child_text(parent, path)
    if not text:
        return default
    where = f"{where} <{path}>"
    return or_default(lambda: check(numbers(text, 1, where), where)[0], default)


def number(parent: Element, path: str, default: float, where: str) -> float:
    """One number at `path`."""
    return _number(parent, path, default, where)


def amount(parent: Element, path: str, default: float, where: str) -> float:
    """One number at `path` that is not negative."""
    return _number(parent, path, default, where, not_negative)


def length(parent: Element, path: str, default: float, where: str) -> float:
    """As `amount`, for shapes: a negative length is a FormatError, not replaced by the default."""
    return not_negative([number(parent, path, default, where)], f"{where} <{path}>")[0]


def size(parent: Element, path: str, default: float, where: str) -> float:
    """One number at `path`, of either sign, that is not beyond `LARGEST`."""
    return _number(parent, path, default, where, bounded)


def integer(parent: Element, path: str, default: int, where: str) -> int:
    """One integer at `path`; `8.0` counts as 8, as in saved files."""
    return int(_number(parent, path, default, where, _whole))


def _whole(values: Sequence[float], where: str) -> Sequence[float]:
    for value in values:
        if value != int(value):
            raise FormatError(f"{where}: {value} is not a whole number")
    return values


def flag(parent: Element, path: str, default: bool) -> bool:
    """A boolean at `path`: `true` and `1`; everything else is false, as in SDF."""
    text = child_text(parent, path).lower()
    return text in TRUE_WORDS if text else default


def vector(
    parent: Element, path: str, default: Sequence[float], where: str
) -> Vector3 | tuple[float, ...]:
    """As many numbers at `path` as the default has: usually three."""
    text = child_text(parent, path)
    if not text:
        return default
    where = f"{where} <{path}>"
    return or_default(lambda: bounded(numbers(text, len(default), where), where), default)


def colour(parent: Element, path: str, default: Rgba, where: str) -> Rgba:
    """Red, green, blue and, if written, alpha at `path`."""
    text = child_text(parent, path)
    if not text:
        return default
    count = 3 if len(text.split()) == 3 else 4
    return or_default(
        lambda: (*numbers(text, count, f"{where} <{path}>"), 1.0)[:4], default)


def fields(read: Callable[..., Value], parent: Element, names: str, usual: Any, where: str,
           folder: str = "", prefix: str = "") -> dict[str, Value]:
    """The results of `read` for elements in `folder` with the names of a description's fields.

    `usual` has the defaults. `prefix` comes before the elements' names in the fields' names.
    """
    return {prefix + name: read(parent, folder + name, getattr(usual, prefix + name), where)
            for name in names.split()}


def pose(parent: Element, where: str, default: Pose = IDENTITY) -> Pose:
    """The `<pose>` of an element in whatever frame it names; the default if absent.

    The oldest files have it as an attribute of an `<origin>`.
    """
    text = child_text(parent, "pose")
    origin = None if text else parent.find("origin")
    if origin is not None:
        text = origin.get("pose", "").strip()
    if not text:
        return default
    where = f"{where} <pose>"

    def read() -> Pose:
        values = bounded(numbers(text, 6, where), where)
        return Pose.from_xyz_rpy(values[:3], values[3:])

    return or_default(read, default)


def vector_text(values: Sequence[float]) -> str:
    """Numbers as XML text that reads back to the same floats."""
    return " ".join(repr(float(value)) for value in values)
