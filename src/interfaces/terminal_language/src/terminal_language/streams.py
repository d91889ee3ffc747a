"""stdout and stderr that translate what is written to them, and argparse's help."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterable
from typing import Any, TextIO

from terminal_language.catalogue import read_catalogue


class TranslatedStream:
    """A text stream whose texts are translated; all else is the stream's own."""

    def __init__(self, stream: TextIO, translate: Callable[[str], str]) -> None:
        self._stream = stream
        self._translate = translate

    def write(self, text: str) -> int:
        """Write the translation; returns the length of the text, as any stream."""
        self._stream.write(self._translate(text))
        return len(text)

    def writelines(self, lines: Iterable[str]) -> None:
        """Write each of them."""
        for line in lines:
            self.write(line)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


def translate_output(language: str) -> None:
    """Translate what this program prints from now on, where its terminal can show it."""
    def translate(text: str) -> str:
        return read_catalogue(language).translate(text)

    streams = {name: getattr(sys, name) for name in ("stdout", "stderr") if getattr(sys, name)}
    if not all(map(_can_show, streams.values())):
        return
    for name, stream in streams.items():
        setattr(sys, name, TranslatedStream(stream, translate))
    _translate_help(translate)


def _translate_help(translate: Callable[[str], str]) -> None:
    """argparse wraps its texts, so they are translated before."""
    for name in ("_split_lines", "_fill_text"):
        wrap = getattr(argparse.HelpFormatter, name)
        setattr(argparse.HelpFormatter, name, lambda self, text, *given, wrap=wrap:
                wrap(self, translate(" ".join(text.split())), *given))


def _can_show(stream: TextIO) -> bool:
    try:
        "中".encode(stream.encoding or "ascii")
    except (LookupError, UnicodeEncodeError):
        return False
    return True
