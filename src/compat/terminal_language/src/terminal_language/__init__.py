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
