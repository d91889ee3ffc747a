"""What was measured, compared with acceptance.yaml: tables, bench.json and bench.png."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

from matplotlib.figure import Figure as Sheet
from node_basics.records import read_yaml

from evaluation import report
from run_session.failure import RunError
from run_session.files import find_package
from sim_bench.figures import Figure

MUCH = 10.0  # percent of a core, used by others: more than this spoils a measurement
MET, MISSED = "#3a8f5c", "#c0392b"
MOST = 4.0  # times its bound, at which a bar is cut off


@dataclass(frozen=True)
class Criterion:
    """A row of acceptance.yaml; exactly one of the two bounds is given, in the figure's unit."""

    what: str
    figure: str  # PART/NAME
    at_least: float | None = None
    at_most: float | None = None
    bound_by: tuple[str, ...] = ()  # figures, or beginnings of their names: what it cannot beat
    limit: str | float = ""  # a figure, or a value: the best that engine and OpenGL alone allow

    def met(self, value: float) -> bool:
        """Whether a median is within the bound."""
        return value <= self.at_most if self.at_least is None else value >= self.at_least

    @property
    def bound(self) -> str:
        """As it is printed."""
        return f"<= {self.at_most:g}" if self.at_least is None else f">= {self.at_least:g}"


@dataclass(frozen=True)
class Verdict:
    """A criterion and the figure that was measured for it; figures of `binding` are PART/NAME."""

    criterion: Criterion
    figure: Figure
    binding: tuple[Figure, ...] = ()  # of the criterion's `bound_by`, what was measured
    limit: float | None = None  # in the figure's unit

    @property
    def met(self) -> bool:
        """By the median."""
        return self.criterion.met(self.figure.median)

    @property
    def share(self) -> float | None:
        """Of the limit, 1 where nothing but the engine and OpenGL takes time."""
        if not self.limit:
            return None
        share = self.figure.median / self.limit
        return share if self.criterion.at_most is None else 1 / share


def criteria() -> list[Criterion]:
    """All rows, in the order in which they are printed."""
    rows = read_yaml(find_package("sim_bench") / "acceptance.yaml", RunError)
    return [Criterion(**{**row, "bound_by": tuple(row.get("bound_by", ()))}) for row in rows]


def judge(figures: Mapping[str, Figure]) -> list[Verdict]:
    """Verdicts on what was measured; figures by PART/NAME."""
    found = []
    for criterion in criteria():
        limit, bound_by = criterion.limit, criterion.bound_by
        if isinstance(limit, str):
            limit = figures[limit].median if limit in figures else None
        if criterion.figure in figures:
            found.append(Verdict(criterion, figures[criterion.figure], tuple(
                replace(one, name=name) for name, one in figures.items()
                if bound_by and name.startswith(bound_by)), limit))
    return found


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

    def verdicts(self) -> list[Verdict]:
        """On what was measured."""
        return judge({f"{part.part}/{one.name}": one for part in self.parts
                      for one in part.figures})


def write_json(results: Results, path: Path) -> None:
    """Write all figures with their runs, and the verdicts on them."""
    verdicts = [
        {"what": verdict.criterion.what, "figure": verdict.criterion.figure,
         "bound": verdict.criterion.bound, "median": verdict.figure.median, "met": verdict.met,
         "limit": verdict.limit, "share_of_limit": verdict.share,
         "bound_by": {one.name: one.median for one in verdict.binding}}
        for verdict in results.verdicts()
    ]
    report.write_json({**asdict(results), "acceptance": verdicts}, path)


def figure_table(result: PartResult) -> str:
    """One part's figures: median, least, greatest and number of runs."""
    text = report.table_of({
        result.part: lambda one: f"  {one.name}", "median": lambda one: _short(one.median),
        "min": lambda one: _short(one.min), "max": lambda one: _short(one.max),
        "runs": lambda one: str(len(one.runs)), "unit": lambda one: one.unit,
    }, result.figures, left=(0, 5))
    if result.others_percent > MUCH:
        text += (f"\n  other processes used {result.others_percent:.0f} % of a core meanwhile:"
                 " a quiet machine does better")
    return text


def acceptance_table(verdicts: Sequence[Verdict]) -> str:
    """What was wanted and measured, whether that is enough, which share of what the engine and
    OpenGL alone allow, and what binds where it is not enough.
    """
    rows = [("acceptance (median)", "wanted", "measured", "unit", "", "of the limit")]
    rows += [(f"  {verdict.criterion.what}", verdict.criterion.bound,
              _short(verdict.figure.median), verdict.figure.unit,
              "met" if verdict.met else "MISSED",
              "" if verdict.share is None else f"{verdict.share:.0%}") for verdict in verdicts]
    lines = [report.table(rows, left=(0, 3, 4))]
    for verdict in verdicts:
        if not verdict.met and verdict.binding:
            parts = ", ".join(f"{one.name.partition('/')[2]} {_short(one.median)} {one.unit}"
                              for one in verdict.binding)
            lines.append(textwrap.fill(f"What binds, {verdict.criterion.what}: {parts}", 100,
                                       subsequent_indent="  "))
    return "\n".join(lines)


def write_chart(results: Results, path: Path) -> None:
    """A bar for each criterion that was measured: beyond the line at 1 is good."""
    verdicts = results.verdicts()[::-1]
    sheet = Sheet((9.0, 1.5 + 0.25 * len(verdicts)), layout="constrained")
    axes = sheet.subplots()
    bars = axes.barh([verdict.criterion.what for verdict in verdicts], list(map(_score, verdicts)),
                     color=[MET if verdict.met else MISSED for verdict in verdicts])
    axes.bar_label(bars, [f"{verdict.figure.median:.3g} {verdict.figure.unit} "
                          f"({verdict.criterion.bound})" for verdict in verdicts], fontsize=7)
    axes.axvline(1.0, color="black", linewidth=1)
    axes.set_xlim(0, 1.4 * MOST)
    axes.set_xlabel("times as good as wanted")
    axes.tick_params(labelsize=8)
    kind = "quick pass, " if results.quick else ""
    where = f"{results.machine.get('processor', '')}, {results.machine.get('cores', '?')} cores"
    axes.set_title(f"{kind}{where}, {results.began[:10]}", fontsize=10)
    sheet.savefig(path, dpi=110)


def _score(verdict: Verdict) -> float:
    value, criterion = verdict.figure.median, verdict.criterion
    if criterion.at_least is not None:
        return min(value / criterion.at_least, MOST)
    if not criterion.at_most:
        return 1.0 if verdict.met else 0.0
    return min(criterion.at_most / value, MOST) if value > 0 else MOST


def _short(value: float) -> str:
    """Four significant digits, without an exponent."""
    if value == 0 or abs(value) >= 1000:
        return f"{value:.0f}"
    return f"{value:.4g}" if abs(value) >= 0.001 else f"{value:.6f}"
