"""Which language is wanted, and whether a program is ours; each Python here starts with it."""

from __future__ import annotations

import os
import sys


def wanted_language(environment: dict[str, str]) -> str | None:
    """zh_CN where the locale asks for Chinese, else None.

    As gettext: LC_ALL, LC_MESSAGES or LANG is the locale, C and POSIX mean untranslated, and
    LANGUAGE comes before any other locale.
    """
    locale = next((environment[name] for name in ("LC_ALL", "LC_MESSAGES", "LANG")
                   if environment.get(name)), "")
    if locale in ("C", "POSIX"):
        return None
    first = (environment.get("LANGUAGE") or locale).split(":")[0]
    return "zh_CN" if first.startswith("zh") else None


def home() -> str:
    """The folder that our programs lie in: this repository, or where its Debian package put it."""
    here = os.path.dirname(os.path.realpath(__file__))
    for folder in ("/src/interfaces/", "/lib/python3/dist-packages/"):
        before, found, _ = here.rpartition(folder)
        if found:
            return before
    return here


def is_ours(argv: list[str]) -> bool:
    """Whether Python's command line (sys.orig_argv) runs a program or module of ours."""
    words = iter(argv[1:])
    for word in words:
        if word == "-c":
            return False
        if word in ("-X", "-W"):
            next(words, "")
        elif word == "-m":
            return _is_our_module(next(words, "").split(".")[0])
        elif not word.startswith("-"):
            return os.path.realpath(word).startswith(home() + os.sep)
    return False


def _is_our_module(name: str) -> bool:
    """PyPI's packages lie in our home, too, but in site-packages."""
    where = (folder for folder in sys.path if os.path.isdir(os.path.join(folder, name)))
    folder = next(where, "")
    return folder.startswith(home() + os.sep) and "site-packages" not in folder


def start() -> None:
    """Let a program of ours print in the wanted language."""
    language = wanted_language(dict(os.environ))
    if language and is_ours(sys.orig_argv):
        from terminal_language.streams import translate_output

        translate_output(language)
