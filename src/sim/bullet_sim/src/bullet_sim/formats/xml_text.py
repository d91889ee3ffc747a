"""From bytes to XML elements, with limits of size, depth and number against XML bombs."""

import re
import sys
from pathlib import Path
from typing import NoReturn
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from bullet_sim.errors import FormatError
from bullet_sim.files import check_file

LARGEST_TEXT = 32 * 2**20  # bytes; its elements take about ten times as much memory
MOST_ELEMENTS = 300_000
DEEPEST = 200  # levels; reading nested models takes a few Python calls per level
DECLARED = re.compile(rb"""<\?xml[^>]*\bencoding\s*=\s*["']([\w.-]+)["']""")
# Its version is ignored: PyBullet's own robots have 0.0, which Expat 2.9 rejects.
DECLARATION = re.compile(r"<\?xml\s[^<>]*\?>")
BYTE_ORDER_MARKS = {b"\xef\xbb\xbf": "utf-8-sig", b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16"}


def parse_xml(text: str, what: str = "XML") -> Element:
    """Root element of a text. Prefixes such as `xacro:` stay part of the tag, declared or not.

    FormatError for a text that is not well-formed or too large.
    """
    if len(text) > LARGEST_TEXT:
        raise FormatError(_too_large(what, len(text)))
    stripped = text.lstrip("\ufeff \t\r\n")
    skipped_lines = text[:len(text) - len(stripped)].count("\n")
    if declaration := DECLARATION.match(stripped):
        blank = re.sub(r"[^\n]", " ", declaration[0])  # positions in error messages stay
        stripped = blank + stripped[declaration.end():]
    parser = expat.ParserCreate("utf-8")
    builder = _BoundedBuilder(parser, what, skipped_lines)
    parser.StartElementHandler = builder.start
    parser.EndElementHandler = builder.end
    parser.CharacterDataHandler = builder.data
    parser.EntityDeclHandler = builder.refuse_entity
    parser.buffer_text = True
    try:
        parser.Parse(stripped.encode("utf-8", errors="replace"), True)
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code)
        place = f"line {error.lineno + skipped_lines}, column {error.offset + 1}"
        raise FormatError(f"{what} is not well-formed XML: {reason} at {place}") from None
    return builder.close()


def read_xml_file(path: Path) -> Element:
    """Root element of a file; FormatError if it cannot be read."""
    return parse_xml(decoded(read_bytes(path)), str(path))


def read_bytes(path: Path) -> bytes:
    """A file's content; FormatError if it cannot be read, or is too large for one text."""
    try:
        size = check_file(path, sys.maxsize).st_size
        if size > LARGEST_TEXT:
            raise FormatError(_too_large(str(path), size))
        return path.read_bytes()
    except OSError as error:
        raise FormatError(f"{path} cannot be read: {error.strerror}") from None


def decoded(content: bytes) -> str:
    """Text by its byte order mark or XML declaration, else UTF-8; invalid bytes are replaced."""
    for mark, encoding in BYTE_ORDER_MARKS.items():
        if content.startswith(mark):
            return content.decode(encoding, errors="replace")
    declared = DECLARED.match(content[:200].lstrip())
    if declared:
        try:
            return content.decode(declared[1].decode("ascii"))
        except (LookupError, UnicodeError):
            pass  # a copied declaration may be wrong for this file
    return content.decode("utf-8", errors="replace")


class _BoundedBuilder(TreeBuilder):
    """Builds the tree until a limit is exceeded."""

    def __init__(self, parser: expat.XMLParserType, what: str, skipped_lines: int):
        super().__init__()
        self._parser = parser
        self._what = what
        self._skipped_lines = skipped_lines
        self._depth = 0
        self._count = 0

    def start(self, tag: str, attributes: dict[str, str]) -> Element:
        self._depth += 1
        self._count += 1
        if self._depth > DEEPEST:
            self._refuse(f"elements are nested more than {DEEPEST} deep; flatten them")
        if self._count > MOST_ELEMENTS:
            self._refuse(f"more than {MOST_ELEMENTS} elements; split the file")
        return super().start(tag, attributes)

    def end(self, tag: str) -> Element:
        self._depth -= 1
        return super().end(tag)

    def refuse_entity(self, name: str, *_details: object) -> None:
        """Entities defined in a file can grow without limit or read other files."""
        self._refuse(f"the entity {name!r} is declared, which is not supported; "
                     "write its text where it is used")

    def _refuse(self, reason: str) -> NoReturn:
        line = self._parser.CurrentLineNumber + self._skipped_lines
        raise FormatError(f"{self._what}, line {line}: {reason}")


def _too_large(what: str, size: int) -> str:
    return (f"{what} is too large: {size // 2**20} MiB, more than {LARGEST_TEXT // 2**20}; "
            "split it or keep only what is needed")
