"""How wide a text is on a terminal: a Chinese character takes two cells."""

from __future__ import annotations

from itertools import accumulate
from unicodedata import east_asian_width


def width(text: str) -> int:
    """How many cells a text takes."""
    return sum(map(_cells, text))


def cut(text: str, cells: int) -> str:
    """The longest beginning of the text that fits into `cells` cells of a terminal."""
    return text[:sum(end <= cells for end in accumulate(map(_cells, text)))]


def _cells(character: str) -> int:
    return 2 if east_asian_width(character) in "WF" else 1
