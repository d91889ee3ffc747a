"""report.json, and report.html: the table, the pictures, and a line for each result."""

from __future__ import annotations

import json
from collections.abc import Sequence
from html import escape
from pathlib import Path

PAGE = "report.html"


def write_json(values: dict, path: Path) -> None:
    """Written beside it first, so that a run that is killed leaves the last report whole."""
    half = path.with_suffix(".tmp")
    half.write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")
    half.replace(path)


def write_page(out: Path, title: str, table: str, lines: Sequence[str],
               pictures: Sequence[str]) -> str:
    """Write OUT/report.html; returns its name. Pictures are files in `out`."""
    shown = "".join(f'<p><img src="{escape(name)}" alt="{escape(name)}"></p>\n'
                    for name in pictures)
    text = (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}'
            "</title><style>body{font-family:sans-serif}img{max-width:100%}</style></head><body>\n"
            f"<h1>{escape(title)}</h1>\n<pre>{escape(table)}</pre>\n{shown}"
            f"<pre>{escape(chr(10).join(lines))}</pre>\n</body></html>\n")
    (out / PAGE).write_text(text, encoding="utf-8")
    return PAGE
