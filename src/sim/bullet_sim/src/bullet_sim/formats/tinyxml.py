"""Rewrites as XML what Gazebo's parser takes beyond it.

The rules are TinyXML 2.6's, tinyxmlparser.cpp. Recovering parsers have others: lxml's drops a lone
`&` and every attribute from an unquoted one on, html5lib's moves `<link>` and lowers the case.
"""

import re

MOST_ADVICE = 5  # remarks on one text
MOST_PARTS = 2_000_000  # of a text; the rest of it stays as it is
NAME = r"[^\W\d][\w.:-]*"
ATTRIBUTE = rf"""(\s*)({NAME})(\s*=\s*)(?>"([^"]*)"|'([^']*)'|([^\s/>"']*+)(?=[\s/>]))"""
ALONE = r"&(?!(?:amp|lt|gt|quot|apos|#\d{1,7}|#x[\da-fA-F]{1,6});)"
CONTROL = r"[\x00-\x08\x0b\x0c\x0e-\x1f]"
# Each alternative takes all that it has looked at, so that the time is linear.
MARKUP = re.compile(r"(?=[<&\]\x00-\x08\x0b\x0c\x0e-\x1f])(?:" + "|".join((
    rf"(?P<text>{ALONE}|\]\]>|{CONTROL})",
    r"(?P<comment><!--(?>.*?-->|.*))",
    r"(?P<same><!\[CDATA\[(?>.*?\]\]>|.*)|<![A-Z][^>]*>?)",
    r"(?P<end></[^>]*>?)",
    rf"(?P<start>(?><{NAME}(?:{ATTRIBUTE})*+)\s*(?P<closed>/?)>)",
    rf"(?P<broken><{NAME}.*)",
    r"(?P<other><[^>]*>?)",
)) + ")", re.DOTALL)
ONE_ATTRIBUTE = re.compile(ATTRIBUTE)
IN_VALUE = re.compile(rf'(?P<text>{ALONE}|{CONTROL}|[<"])')
ESCAPED = {"&": "&amp;", "]]>": "]]&gt;", "<": "&lt;", '"': "&quot;"}


def as_xml(text: str) -> tuple[str, str]:
    """The text up to the end of its root element, and what is to be written instead, with lines.

    Lines keep their numbers. What TinyXML refuses, too, stays as it is. Takes linear time.
    """
    mender = _Mender(text)
    return mender.mended(), mender.advice()


class _Mender:
    def __init__(self, text: str):
        self._text = text
        self._place = 0  # of the part that is being rewritten
        self._first: dict[str, int] = {}  # what to write, and the first place for it

    def mended(self) -> str:
        parts, done, depth = [], 0, 0
        for found in MARKUP.finditer(self._text):
            self._place = found.start()
            parts += self._text[done:self._place], self._rewritten(found)
            done = found.end()
            if len(parts) > MOST_PARTS:
                parts.append(self._text[done:])
                break
            if found.lastgroup in ("start", "end"):
                depth += -1 if found.lastgroup == "end" else not found["closed"]
                if depth <= 0:
                    self._look_at_rest(done)
                    break
        else:
            parts.append(self._text[done:])
        return "".join(parts)

    def advice(self) -> str:
        """`line 3: write &amp; for &; line 7: ...`, in the order of the lines; the first ones."""
        line, counted, said = 1, 0, []
        for what, place in [*self._first.items()][:MOST_ADVICE]:  # in the order of their places
            line += self._text.count("\n", counted, place)
            counted = place
            said.append(f"line {line}: {what}")
        if (more := len(self._first) - MOST_ADVICE) > 0:
            said.append(f"and {more} more of this kind")
        return "; ".join(said)

    def _rewritten(self, found: re.Match) -> str:
        part, kind = found[0], found.lastgroup
        if kind == "text":
            return self._escaped(found)
        if kind == "start":
            return ONE_ATTRIBUTE.sub(self._attribute, part)
        if kind not in ("comment", "other"):
            return part
        if kind == "comment" and "--" in part[4:-3]:
            self._note("write no -- within a comment")
        elif part.startswith("<?xml"):
            self._note("move <?xml ...?> to the beginning")
        elif kind == "other" and not part.startswith("<?"):
            self._note("write &lt; for <")
        return "\n" * part.count("\n")

    def _attribute(self, found: re.Match) -> str:
        space, name, equals, *values = found.groups()
        if values[2] is not None:
            self._note(f'write {name}="..." with quotes')
        elif not space:
            self._note("write a space between attributes")
        value = next(value for value in values if value is not None)
        value = IN_VALUE.sub(self._escaped, value)
        return f'{space or " "}{name}{equals}"{value}"'

    def _escaped(self, found: re.Match) -> str:
        escaped = ESCAPED.get(found[0])
        if escaped is None:
            self._note("remove the control character")
        elif found[0] != '"':
            self._note(f"write {escaped} for {found[0]}")
        return escaped or " "

    def _look_at_rest(self, end: int) -> None:
        rest = self._text[end:].lstrip()
        if rest and not rest.startswith(("<!--", "<?")):
            self._place = len(self._text) - len(rest)
            self._note("remove what follows the root element")

    def _note(self, what: str) -> None:
        self._first.setdefault(what, self._place)
