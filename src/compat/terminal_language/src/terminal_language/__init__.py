"""What our programs print on a terminal, in the language of the locale (README.md)."""

import os

from terminal_language.wanted import wanted_language


def translated(text: str) -> str:
    """A text for the terminal, for those who print it within somebody else's program."""
    language = wanted_language(dict(os.environ))
    if language is None:
        return text
    from terminal_language.catalogue import read_catalogue

    return read_catalogue(language).translate(text)


def heading(word: str) -> str:
    """A column's heading in a table for the terminal: translated for itself, as it may be a word
    that is a name elsewhere.
    """
    known_as = f"column\4{word}"  # gettext's msgctxt
    found = translated(known_as)
    return word if found == known_as else found
