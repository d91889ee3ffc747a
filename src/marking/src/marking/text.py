"""Makes untrusted text safe for one line of a terminal, a table or a page."""

from __future__ import annotations

import os


def one_line(text: str) -> str:
    """The text without line ends, terminal codes and undecodable bytes."""
    whole = text.encode("utf-8", "replace").decode()
    return "".join(each if each.isprintable() else " " for each in whole).strip()


def visible(text: str) -> str:
    """Text of several lines in which control and other unprintable characters are shown as codes.
    """
    return "".join(each if each.isprintable() or each in "\n\t" else
                   each.encode("unicode_escape").decode() for each in text)


def file_name(name: str) -> str:
    """A file's name as text; Chinese Windows writes them in GBK."""
    raw = os.fsencode(name)
    for encoding in ("utf-8", "gbk"):
        try:
            return one_line(raw.decode(encoding))
        except UnicodeDecodeError:
            continue
    return one_line(name)
