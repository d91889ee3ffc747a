"""From bytes to XML elements, with limits of size, depth and number against XML bombs."""

import re
import sys
from pathlib import Path
from typing import NoReturn
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from bullet_sim.errors import FormatError
from bullet_sim.files import check_file
from bullet_sim.formats.mistakes import remark
from bullet_sim.formats.tinyxml import as_xml

LARGEST_TEXT = 32 * 2**20  # bytes; its elements take about ten times as much memory
MOST_ELEMENTS = 300_000
DEEPEST = 200  # levels; reading nested models takes a few Python calls per level
DECLARED = re.compile(rb"""<\?xml[^>]*\bencoding\s*=\s*["']([\w.-]+)["']""")
# Its version is ignored: PyBullet's own robots have 0.0, which Expat 2.9 rejects.
DECLARATION = re.compile(r"<\?xml\s[^<>]*\?>")
BYTE_ORDER_MARKS = {b"\xef\xbb\xbf": "utf-8-sig", b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16"}


def parse_xml(text: str, what: str = "XML") -> Element:
    """Root element of a text. Prefixes such as `xacro:` stay part of the tag, declared or not.

    What Gazebo's parser takes beyond XML is taken, with one warning. FormatError for a text that
    it refuses, too, or that is too large.
    """
    if len(text) > LARGEST_TEXT:
        raise FormatError(_too_large(what, len(text)))
    content = text.lstrip("\ufeff \t\r\n")
    if not content:
        raise FormatError(f"{what} is empty: there is no XML in it")
    if declaration := DECLARATION.match(content):
        content = content[declaration.end():]
    before = text[:len(text) - len(content)]
    content = re.sub(r"[^\n]", " ", before) + content  # positions in error messages stay
    try:
        return _parsed(content, what)
    except expat.ExpatError:
        mended, advice = as_xml(content)
    try:
        root = _parsed(mended, what)
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code)
        place = f"line {error.lineno}, column {error.offset + 1}"
        also = f"; {advice}" if advice else ""
        raise FormatError(f"{what} is not well-formed XML: {reason} at {place}{also}") from None
    remark(f"{what}, {advice}; taken all the same, as by Gazebo")
    return root


def _parsed(text: str, what: str) -> Element:
    parser = expat.ParserCreate("utf-8")
    builder = _BoundedBuilder(parser, what)
    parser.StartElementHandler = builder.start
    parser.EndElementHandler = builder.end
    parser.CharacterDataHandler = builder.data
    parser.EntityDeclHandler = builder.refuse_entity
    parser.buffer_text = True
    parser.Parse(text.encode("utf-8", errors="replace"), True)
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
    declared = DECLARED.search(content[:1000])  # a comment may come first
    if declared:
        try:
            return content.decode(declared[1].decode("ascii"))
        except (LookupError, UnicodeError):
            pass  # a copied declaration may be wrong for this file
    return content.decode("utf-8", errors="replace")


class _BoundedBuilder(TreeBuilder):
    """Builds the tree until a limit is exceeded."""

    def __init__(self, parser: expat.XMLParserType, what: str):
        super().__init__()
        self._parser = parser
        self._what = what
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
        raise FormatError(f"{self._what}, line {self._parser.CurrentLineNumber}: {reason}")


def _too_large(what: str, size: int) -> str:
    return (f"{what} is too large: {size // 2**20} MiB, more than {LARGEST_TEXT // 2**20}; "
            "split it or keep only what is needed")
