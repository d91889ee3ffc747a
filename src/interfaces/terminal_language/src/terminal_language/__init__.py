"""What our programs print on a terminal, in the language of the locale (README.md)."""

import os

from terminal_language.wanted import wanted_language

COLUMN = "column\4"  # gettext's msgctxt


def translated(text: str) -> str:
    """A text for the terminal, for those who print it within somebody else's program."""
    language = wanted_language(dict(os.environ))
    if language is None:
        return text
    from terminal_language.catalogue import read_catalogue

    return read_catalogue(language).translate(text)


def headings(words: list[str] | tuple[str, ...]) -> list[str]:
    """A table's headings for the terminal; all as they are if a word among them is not known.

    They are translated for themselves, as they may be names elsewhere. A single letter is a unit
    or an axis.
    """
    found = [translated(COLUMN + word) for word in words]
    if any(each.startswith(COLUMN) and sum(map(str.isalpha, each[len(COLUMN):])) > 1
           for each in found):
        return list(words)
    return [each.removeprefix(COLUMN) for each in found]


def heading(word: str) -> str:
    """A single word of a table or progress line for the terminal."""
    return headings([word])[0]
