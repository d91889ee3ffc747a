"""Strategies that spoil valid files: by their structure, and byte by byte."""

from __future__ import annotations

import importlib.util
import random
import struct
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from hypothesis import strategies as st
from target import ROOT

WORDS = (b"nan", b"-inf", b"1e308", b"-0", b"", b"0", b"-1", b"4294967295",
         b"99999999999999999999", b"1e-320", b"[", b"{", b"]", b"}", b"\0", b"\n", b"\xff\xfe",
         "名".encode(), b"null", b"1 2", b"'", b'"', b"&a", b"*a", b"<", b"/>", b"x" * 5000,
         b"9 " * 5000, b"[" * 3000, b"9" * 5000, b"2020-13-45")
NUMBERS = (0, 1, -1, 127, 255, 32767, 65535, 100_000, 2**31 - 1, -(2**31), 2**32 - 1)
FORMS = ("<b", "<h", "<i", ">h", ">i")
MOST_CHANGES = 4

Change = Callable[[bytes, random.Random], bytes]


def _mutants() -> object:
    """The mutations of XML that the simulator's own tests know."""
    path = ROOT / "src/workspace_needs/test/malformed/mutations.py"
    spec = importlib.util.spec_from_file_location("mutations", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules["mutations"] = module
    spec.loader.exec_module(module)
    return module


XML = _mutants()


def word_put(content: bytes, rng: random.Random) -> bytes:
    """A word in the place of some bytes."""
    at = rng.randint(0, len(content))
    return content[:at] + rng.choice(WORDS) + content[at + rng.choice((0, 1, 4, 20)):]


def number_put(content: bytes, rng: random.Random) -> bytes:
    """A number as binary files hold them: counts, sizes and places that are not so."""
    form, number = rng.choice(FORMS), rng.choice(NUMBERS)
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


def truncated(content: bytes, rng: random.Random) -> bytes:
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
    return rng.choice(XML.MUTATIONS)(text, rng) if text else content


BINARY: tuple[Change, ...] = (number_put, number_put, bytes_put, truncated, piece_moved, word_put)
TEXT: tuple[Change, ...] = (line_changed, line_changed, line_changed, word_put, bytes_put,
                            truncated, piece_moved)
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
