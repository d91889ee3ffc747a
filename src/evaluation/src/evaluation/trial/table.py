"""Tables for the terminal, and the figures in them."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from typing import Any


def table(rows: Sequence[Sequence[str]], left: Collection[int] = (0,)) -> str:
    """Columns under each other: those with a number in `left` to the left, the others right."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join("  ".join(
        cell.ljust(width) if column in left else cell.rjust(width)
        for column, (cell, width) in enumerate(zip(row, widths, strict=True))).rstrip()
        for row in rows)


def table_of(columns: Mapping[str, Callable[[Any], str]], found: Iterable[Any],
             left: Collection[int] = (0,)) -> str:
    """A row for each thing that was found; `columns` has headings and what makes the cells."""
    return table([list(columns), *([make(each) for make in columns.values()] for each in found)],
                 left)


def grouped(found: Iterable[Any], key: Callable[[Any], Any]) -> dict[Any, list[Any]]:
    """By key, in the order in which keys first appear."""
    groups: dict[Any, list[Any]] = {}
    for each in found:
        groups.setdefault(key(each), []).append(each)
    return groups


def cell(value: float | None, factor: float = 1, digits: int = 1) -> str:
    """A figure times `factor`, with so many decimals; a dash where there is none."""
    return "-" if value is None else f"{value * factor:.{digits}f}"


def mean(values: Sequence[float]) -> float | None:
    """None of nothing."""
    return statistics.fmean(values) if values else None
