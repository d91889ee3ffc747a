"""Compares the figures with acceptance.yaml, and names the bottleneck of those that miss it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from node_basics.records import read_yaml

from run_session.failure import RunError
from run_session.files import find_package
from sim_bench.figures import Figure


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
    return [
        Verdict(criterion, figures[criterion.figure], tuple(
            replace(one, name=name) for name, one in figures.items()
            if criterion.bound_by and name.startswith(criterion.bound_by)),
            _limit(criterion, figures))
        for criterion in criteria()
        if criterion.figure in figures
    ]


def _limit(criterion: Criterion, figures: Mapping[str, Figure]) -> float | None:
    if isinstance(criterion.limit, float):
        return criterion.limit
    return figures[criterion.limit].median if criterion.limit in figures else None
