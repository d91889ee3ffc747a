"""Ways to spoil a valid file: XML as editors, merges and pranks do, and any other byte by byte.

Each takes the file's text or bytes and a random generator, and gives bytes. The same seed, the
same bytes.
"""

from __future__ import annotations

import random
import re
import struct
from collections.abc import Callable, Sequence
from pathlib import Path

from hypothesis import strategies as st

NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?(?![\w.])")
ATTRIBUTE = re.compile(r'="([^"<]*)"')
TAG = re.compile(r"<(/?)([A-Za-z_][\w:.-]*)")
ELEMENT = re.compile(r"<([A-Za-z_][\w:.-]*)\b[^<>]*(?:/>|>[^<>]*</\1>)")
WHOLE = re.compile(r"<(link|joint|sensor|model|visual|collision|plugin|node|include)\b.*?</\1>",
                   re.DOTALL)
PATH = re.compile(r"(?:model|package|file)://[^<\"\s]*|\$\(find [\w]+\)/[^<\"\s]*")
NUMBERS = ("1e308", "-1e308", "1e400", "nan", "inf", "-inf", "abc", "", "0", "-1", "1 2",
           "99999999999999999999", "1e-320", "0x10", "1,5", "１", "1e9", "- 1", "--1")
PATHS = ("../../../../../../etc/passwd", "model://../../../etc/passwd", "file:///dev/zero",
         "package://../..", "package://no_such_package/a.dae", "file:///", "http://localhost:1/a",
         "model://", "file:///proc/self/mem", "package://bullet_sim_ros/package.xml", "~",
         "\\\\x\\y", "fuel://a/b", "file:///dev/random", "model://ground_plane/../../../..")
BOMB = ('<!DOCTYPE a [<!ENTITY b "bombbombbomb">' + "".join(
    f'<!ENTITY {chr(98 + n)} "{f"&{chr(97 + n)};" * 10}">' for n in range(1, 10)) + "]>")
OUTSIDE = '<!DOCTYPE a [<!ENTITY k SYSTEM "file:///etc/passwd">]>'
EXPRESSIONS = ("${10**10**7}", "${'a'*10**9}", "${[0]*10**9}", "$(eval 2**2**30)",
               "$(find no_such)", "${undefined_name}", "${__import__('os').system('true')}",
               "${1/0}", "$(arg none)",
               "${", "$(env NO_SUCH_VARIABLE)", "${sum(range(10**12))}", "$(eval arg('x')*10**9)")

WORDS = (b"nan", b"-inf", b"1e308", b"-0", b"", b"0", b"-1", b"4294967295",
         b"99999999999999999999", b"1e-320", b"[", b"{", b"]", b"}", b"\0", b"\n", b"\xff\xfe",
         "名".encode(), b"null", b"1 2", b"'", b'"', b"&a", b"*a", b"<", b"/>", b"x" * 5000,
         b"9 " * 5000, b"[" * 3000, b"9" * 5000, b"2020-13-45")
COUNTS = (0, 1, -1, 127, 255, 32767, 65535, 100_000, 2**31 - 1, -(2**31), 2**32 - 1)
FORMS = ("<b", "<h", "<i", ">h", ">i")
MOST_CHANGES = 4

Mutation = Callable[[str, random.Random], bytes]
Change = Callable[[bytes, random.Random], bytes]


def _some(pattern: re.Pattern, text: str, rng: random.Random) -> re.Match | None:
    found = list(pattern.finditer(text))
    return rng.choice(found) if found else None


def _put(text: str, match: re.Match | None, new: str, group: int = 0) -> bytes:
    if match is None:
        return text.encode()
    return (text[:match.start(group)] + new + text[match.end(group):]).encode()


def truncated(text: str, rng: random.Random) -> bytes:
    """Cut off somewhere."""
    return text[:rng.randrange(len(text))].encode()


def number_spoilt(text: str, rng: random.Random) -> bytes:
    """One number is another, or none."""
    return _put(text, _some(NUMBER, text, rng), rng.choice(NUMBERS))


def all_numbers_of_one_kind_spoilt(text: str, rng: random.Random) -> bytes:
    """Every place with the same number is huge."""
    match = _some(NUMBER, text, rng)
    if match is None:
        return text.encode()
    return re.sub(rf"(?<![\w.]){re.escape(match[0])}(?![\w.])", rng.choice(NUMBERS), text).encode()


def attribute_spoilt(text: str, rng: random.Random) -> bytes:
    """One attribute is empty, long, odd, or another's value."""
    match = _some(ATTRIBUTE, text, rng)
    other = _some(ATTRIBUTE, text, rng)
    new = rng.choice(["", "x" * 1_000_000, "a b/c::d", "名字", "&lt;&amp;", "${x", "%s%n",
                      other[1] if other else ""])
    return _put(text, match, new, 1)


def element_gone(text: str, rng: random.Random) -> bytes:
    """A small element is missing."""
    return _put(text, _some(ELEMENT, text, rng), "")


def part_gone(text: str, rng: random.Random) -> bytes:
    """A link, joint, sensor … is missing."""
    return _put(text, _some(WHOLE, text, rng), "")


def part_twice(text: str, rng: random.Random) -> bytes:
    """A link, joint, sensor … stands twice."""
    match = _some(WHOLE, text, rng)
    return _put(text, match, (match[0] if match else "") * 2)


def parts_swapped(text: str, rng: random.Random) -> bytes:
    """Two names or values are exchanged: joints that go round in circles."""
    a, b = _some(ATTRIBUTE, text, rng), _some(ATTRIBUTE, text, rng)
    if a is None or b is None or a.start() >= b.start():
        return text.encode()
    return (text[:a.start(1)] + b[1] + text[a.end(1):b.start(1)] + a[1] + text[b.end(1):]).encode()


def tag_misspelt(text: str, rng: random.Random) -> bytes:
    """One tag is not closed by its own name, or unknown."""
    match = _some(TAG, text, rng)
    return _put(text, match, (match[2] if match else "")[:-1] + "x", 2)


def element_deep(text: str, rng: random.Random) -> bytes:
    """An element inside itself, many times."""
    match, depth = _some(ELEMENT, text, rng), rng.choice([50, 1000, 100_000])
    if match is None:
        return text.encode()
    return _put(text, match, f"<{match[1]}>" * depth + f"</{match[1]}>" * depth)


def elements_many(text: str, rng: random.Random) -> bytes:
    """An element many times."""
    match = _some(ELEMENT, text, rng)
    return _put(text, match, (match[0] if match else "") * rng.choice([100, 20_000]))


def path_spoilt(text: str, rng: random.Random) -> bytes:
    """A path leads elsewhere."""
    return _put(text, _some(PATH, text, rng), rng.choice(PATHS))


def bytes_spoilt(text: str, rng: random.Random) -> bytes:
    """Some bytes are others."""
    return bytes_put(text.encode(), rng)


def other_encoding(text: str, rng: random.Random) -> bytes:
    """UTF-16, a BOM, Latin-1 or GBK under a wrong name, NULs."""
    body = re.sub(r"<\?xml.*?\?>", "", text)
    declared = f'<?xml version="1.0" encoding="utf-8"?><!-- é 名 -->{body}'
    kind = rng.randrange(5)
    if kind == 0:
        return declared.encode("utf-16")
    if kind == 1:
        return declared.encode("utf-8-sig")
    if kind == 2:
        return declared.encode("gbk", "replace")
    if kind == 3:
        return declared.replace("utf-8", "no-such-code").encode()
    return declared.encode() + b"\0" * 100


def with_entities(text: str, rng: random.Random) -> bytes:
    """Entities that grow, or that read files."""
    bomb = rng.random() < 0.6
    body = re.sub(r"<\?xml.*?\?>", "", text)
    match = _some(ATTRIBUTE, body, rng)
    return (BOMB if bomb else OUTSIDE).encode() + _put(body, match, "&j;" if bomb else "&k;", 1)


def with_expression(text: str, rng: random.Random) -> bytes:
    """An expression where xacro and roslaunch look for one."""
    return _put(text, _some(ATTRIBUTE, text, rng), rng.choice(EXPRESSIONS), 1)


def includes_itself(text: str, rng: random.Random) -> bytes:
    """By each of the ways to include that the formats have; THIS_FILE is the file's own path."""
    end = text.rfind("</")
    inside = rng.choice([
        "<include><uri>file://THIS_FILE</uri></include>", '<include file="THIS_FILE"/>',
        '<xacro:include filename="THIS_FILE"/>',
        '<xacro:macro name="again"><xacro:again/></xacro:macro><xacro:again/>',
        '<xacro:property name="p" value="${q}"/><xacro:property name="q" value="${p}"/>'
        '<link name="${p}"/>'])
    return (text[:end] + inside + text[end:]).encode()


def empty_or_other(_text: str, rng: random.Random) -> bytes:
    """Not such a file at all."""
    return rng.choice([b"", b" ", b"\n\n", b"{}", b"<a/>", b"<robot/>", b"<sdf/>", b"<launch/>",
                       b"\x89PNG\r\n", bytes(range(256)), b"<sdf version='9.9'><world/></sdf>",
                       b"<robot name=''><link name=''/></robot>",
                       b"<sdf><world name='a'><model/></world></sdf>"])


MUTATIONS: tuple[Mutation, ...] = (
    truncated, number_spoilt, number_spoilt, all_numbers_of_one_kind_spoilt, attribute_spoilt,
    element_gone, part_gone, part_twice, parts_swapped, tag_misspelt, element_deep, elements_many,
    path_spoilt, bytes_spoilt, other_encoding, with_entities, with_expression, includes_itself,
    empty_or_other)


def malformed(text: str, seed: int) -> tuple[str, bytes]:
    """Name of what was done, and the spoilt file."""
    rng = random.Random(seed)
    mutation = MUTATIONS[seed % len(MUTATIONS)]
    return mutation.__name__, mutation(text, rng)


def word_put(content: bytes, rng: random.Random) -> bytes:
    """A word in the place of some bytes."""
    at = rng.randint(0, len(content))
    return content[:at] + rng.choice(WORDS) + content[at + rng.choice((0, 1, 4, 20)):]


def number_put(content: bytes, rng: random.Random) -> bytes:
    """A number as binary files hold them: counts, sizes and places that are not so."""
    form, number = rng.choice(FORMS), rng.choice(COUNTS)
    size = struct.calcsize(form)
    packed = (number % (1 << 8 * size)).to_bytes(size, "little" if form[0] == "<" else "big")
    # Half of them in the first bytes, where most formats say how large they are.
    at = rng.randint(0, min(len(content), 100) if rng.random() < 0.5 else len(content))
    return content[:at] + packed + content[at + size:]


def bytes_put(content: bytes, rng: random.Random) -> bytes:
    """Some bytes are others."""
    data = bytearray(content)
    for _ in range(rng.choice((1, 3, 30)) if data else 0):
        data[rng.randrange(len(data))] = rng.randrange(256)
    return bytes(data)


def cut_off(content: bytes, rng: random.Random) -> bytes:
    """Cut off somewhere."""
    return content[:rng.randint(0, len(content))]


def piece_moved(content: bytes, rng: random.Random) -> bytes:
    """A piece stands at another place too, once or a hundred times."""
    start, at = rng.randint(0, len(content)), rng.randint(0, len(content))
    piece = content[start:start + rng.choice((4, 40, 400))]
    return content[:at] + piece * rng.choice((1, 1, 100)) + content[at:]


def line_changed(content: bytes, rng: random.Random) -> bytes:
    """A line of a text is gone, or twice, or has another word in it."""
    lines = content.split(b"\n")
    at = rng.randrange(len(lines))
    words = lines[at].split(b" ")
    words[rng.randrange(len(words))] = rng.choice(WORDS)
    lines[at:at + 1] = rng.choice(([], [lines[at]] * 2, [b" ".join(words)], [b" ".join(words)]))
    return b"\n".join(lines)


def xml_changed(content: bytes, rng: random.Random) -> bytes:
    """One of the mutations of XML; a text that is none any more stays as it is."""
    text = content.decode("utf-8", "replace")
    return rng.choice(MUTATIONS)(text, rng) if text else content


BINARY: tuple[Change, ...] = (number_put, number_put, bytes_put, cut_off, piece_moved, word_put)
TEXT: tuple[Change, ...] = (line_changed, line_changed, line_changed, word_put, bytes_put,
                            cut_off, piece_moved)
XML_TEXT: tuple[Change, ...] = (xml_changed,) * 6 + (word_put,)


def spoilt(files: Sequence[Path | bytes], changes: Sequence[Change]) -> st.SearchStrategy[bytes]:
    """One of these files (or contents) after some of these changes."""
    contents = [file if isinstance(file, bytes) else file.read_bytes() for file in files]

    def change(content: bytes, chosen: list[Change], seed: int) -> bytes:
        rng = random.Random(seed)
        for one in chosen:
            content = one(content, rng)
        return content

    return st.builds(change, st.sampled_from(contents),
                     st.lists(st.sampled_from(changes), min_size=1, max_size=MOST_CHANGES),
                     st.integers(0, 2**32 - 1))
