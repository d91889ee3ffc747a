"""Writes report.json, and report.html (table, pictures, a line for each result); makes tables."""

from __future__ import annotations

import json
import statistics
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

from terminal_language import headings, translated
from terminal_language.cells import width

from bullet_sim import __version__
from run_session.files import write_whole

PAGE = "report.html"


def write_json(values: dict, path: Path) -> None:
    """Write our version and values as JSON; OSError names the file, whose old content stays."""
    write_whole(path, (json.dumps({"version": __version__, **values}, indent=1) + "\n").encode())


def write_page(out: Path, title: str, table: str, lines: Sequence[str],
               pictures: Sequence[str]) -> str:
    """Write OUT/report.html; returns its name. Pictures are files in `out`."""
    shown = "".join(f'<p><img src="{escape(name)}" alt="{escape(name)}"></p>\n'
                    for name in pictures)
    text = (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}'
            "</title><style>body{font-family:sans-serif}img{max-width:100%}</style></head><body>\n"
            f"<h1>{escape(title)}</h1>\n<pre>{escape(table)}</pre>\n{shown}"
            f"<pre>{escape(chr(10).join(lines))}</pre>\n</body></html>\n")
    write_whole(out / PAGE, text.encode())
    return PAGE


def table(rows: Sequence[Sequence[str]], left: Collection[int] = (0,),
          names: Collection[int] = ()) -> str:
    """An aligned text table in the terminal's language; the first row are headings.

    Columns whose index is in `left` are left-aligned, others right; those in `names` have names,
    which stay as they are. If a heading has no translation, the whole table stays English.
    """
    titles = headings(list(rows[0]))
    shown: list[Sequence[str]] = list(rows)
    if titles != list(rows[0]):
        shown = [titles, *(
            [text if column in names else translated(text) for column, text in enumerate(row)]
            for row in rows[1:])]
    widths = [max(map(width, column)) for column in zip(*shown, strict=True)]
    return "\n".join("  ".join(
        _padded(cell, wide, column in left)
        for column, (cell, wide) in enumerate(zip(row, widths, strict=True))).rstrip()
        for row in shown)


def _padded(text: str, cells: int, left: bool) -> str:
    free = " " * (cells - width(text))
    return text + free if left else free + text


def table_of(columns: Mapping[str, Callable[[Any], str]], found: Iterable[Any],
             left: Collection[int] = (0,)) -> str:
    """A table with a row for each item; `columns`: headings and the functions that make cells."""
    return table([list(columns), *([make(each) for make in columns.values()] for each in found)],
                 left)


def grouped(found: Iterable[Any], key: Callable[[Any], Any]) -> dict[Any, list[Any]]:
    """Items by key, in the order in which keys first appear."""
    groups: dict[Any, list[Any]] = {}
    for each in found:
        groups.setdefault(key(each), []).append(each)
    return groups


def cell(value: float | None, factor: float = 1, digits: int = 1) -> str:
    """A figure times `factor`, with this many decimals; a dash for None."""
    return "-" if value is None else f"{value * factor:.{digits}f}"


def mean(values: Sequence[float]) -> float | None:
    """The mean; None of an empty sequence."""
    return statistics.fmean(values) if values else None
