"""What was measured, as bench.json and as tables on the terminal."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

from sim_bench.acceptance import Verdict, judge
from sim_bench.figures import Figure

MUCH = 10.0  # percent of a core, used by others: more than this spoils a measurement


@dataclass(frozen=True)
class PartResult:
    """One part's figures, or why there are none."""

    part: str
    figures: tuple[Figure, ...]
    wall_s: float = 0.0
    others_percent: float = 0.0  # of one core, used by processes that are not ours
    failure: str = ""


@dataclass
class Results:
    """One run of the benchmark."""

    began: str  # date and time, ISO 8601
    quick: bool
    machine: dict = field(default_factory=dict)
    parts: list[PartResult] = field(default_factory=list)

    def figures(self) -> dict[str, Figure]:
        """All figures, by PART/NAME."""
        return {f"{part.part}/{one.name}": one for part in self.parts for one in part.figures}


def write_json(results: Results, path: Path) -> None:
    """Write everything; lists of runs stay on one line each."""
    values = asdict(results)
    values["acceptance"] = [
        {
            "what": verdict.criterion.what,
            "figure": verdict.criterion.figure,
            "bound": verdict.criterion.bound,
            "median": verdict.figure.median,
            "met": verdict.met,
            "bound_by": {one.name: one.median for one in verdict.binding},
        }
        for verdict in judge(results.figures())
    ]
    path.write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")


def figure_table(result: PartResult) -> str:
    """One part's figures: median, least, greatest and number of runs."""
    rows = [(result.part, "median", "min", "max", "runs", "unit")]
    rows += [
        (f"  {f.name}", _short(f.median), _short(f.min), _short(f.max), str(len(f.runs)), f.unit)
        for f in result.figures
    ]
    lines = _aligned(rows, left={0, 5})
    if result.others_percent > MUCH:
        used = f"{result.others_percent:.0f} % of a core"
        lines.append(f"  other processes used {used} meanwhile: a quiet machine does better")
    return "\n".join(lines)


def acceptance_table(verdicts: Sequence[Verdict]) -> str:
    """What was wanted, what was measured, whether that is enough, and if not, what binds."""
    rows = [("acceptance (median)", "wanted", "measured", "unit", "")]
    rows += [
        (
            f"  {verdict.criterion.what}",
            verdict.criterion.bound,
            _short(verdict.figure.median),
            verdict.figure.unit,
            "met" if verdict.met else "MISSED",
        )
        for verdict in verdicts
    ]
    lines = _aligned(rows, left={0, 3, 4})
    for verdict in verdicts:
        if not verdict.met and verdict.binding:
            parts = ", ".join(f"{one.name.partition('/')[2]} {_short(one.median)} {one.unit}"
                              for one in verdict.binding)
            lines.append(textwrap.fill(f"What binds, {verdict.criterion.what}: {parts}", 100,
                                       subsequent_indent="  "))
    return "\n".join(lines)


def _short(value: float) -> str:
    """Four significant digits, without an exponent."""
    if value == 0 or abs(value) >= 1000:
        return f"{value:.0f}"
    return f"{value:.4g}" if abs(value) >= 0.001 else f"{value:.6f}"


def _aligned(rows: Sequence[Sequence[str]], left: set[int]) -> list[str]:
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    return [
        "  ".join(
            cell.ljust(width) if column in left else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(row, widths))
        ).rstrip()
        for row in rows
    ]
