"""What was measured: the median of several runs, with the least and the greatest of them."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Figure:
    """Names are dotted, from the general to the special: `ratio.tiny.1920x1080`."""

    name: str
    unit: str
    median: float
    min: float
    max: float
    runs: tuple[float, ...]


def figure(name: str, unit: str, runs: Iterable[float]) -> Figure:
    """The figure of at least one run; ValueError if there is none or one is no finite number."""
    values = tuple(float(value) for value in runs)
    if not values or not all(math.isfinite(value) for value in values):
        raise ValueError(f"{name}: no median of the runs {list(values)}")
    return Figure(name, unit, statistics.median(values), min(values), max(values), values)


def ratio(name: str, numerator: Iterable[float], denominator: Iterable[float]) -> Figure:
    """How many times as much, run by run: the runs that were taken side by side are compared."""
    return figure(name, "x", [a / b for a, b in zip(numerator, denominator, strict=True)])
