"""Tables for the terminal."""

from __future__ import annotations

from collections.abc import Collection, Sequence


def table(rows: Sequence[Sequence[str]], left: Collection[int] = (0,)) -> str:
    """Columns under each other: those with a number in `left` to the left, the others right."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join("  ".join(
        cell.ljust(width) if column in left else cell.rjust(width)
        for column, (cell, width) in enumerate(zip(row, widths, strict=True))).rstrip()
        for row in rows)


def cell(value: float | None, factor: float = 1, digits: int = 1) -> str:
    """A figure times `factor`, with so many decimals; a dash where there is none."""
    return "-" if value is None else f"{value * factor:.{digits}f}"
