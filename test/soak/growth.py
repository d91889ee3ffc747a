"""Checks that the sampled figures are flat after the warm-up; makes a table and a picture."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from pathlib import Path

from samples import CLOCK, Sample

from evaluation.picture import chart
from evaluation.report import grouped, table
from run_session.failure import RunError

WARM_UP = 600.0  # s, wall; of shorter runs a third
SHARE = 5  # the first and the last fifth after the warm-up are compared
MOST_GROWTH = 0.02
LEAST = {"memory": 2.0, "descriptors": 2.0, "threads": 2.0}  # MiB, count: less is no growth
MOST_DRIFT = 0.02  # relative, of pace and rate
SLOWEST = 0.005  # m/s, mean of the last part; a robot that stands causes no load
LONGEST_REST = 90.0  # s, wall, for which a robot may stand between two goals
CLOCK_FIGURES = {"pace": statistics.median, "rate": statistics.median, "speed": statistics.fmean}


def judge(samples: Sequence[Sample]) -> tuple[str, bool]:
    """The table, and whether anything grows, the robot stands, or simulated time changes pace.

    RunError if there are too few samples.
    """
    if _ends([each for each in samples if each.name == CLOCK], "pace") is None:
        raise RunError("too few samples to say whether anything grows: let it run on")
    rows, changes = [("process", "", "first", "last", "change", "")], False
    for name, found in grouped(samples, lambda each: each.name).items():
        for kind in CLOCK_FIGURES if name == CLOCK else LEAST:
            parts = _ends(found, kind)
            if parts is None:
                continue
            first, last = parts
            change = (last - first) / first if first else 0.0
            verdict = _verdict(kind, first, last, change)
            changes |= bool(verdict)
            rows.append((name, kind, f"{first:.2f}", f"{last:.2f}", f"{change:+.1%}", verdict))
    return table(rows, left=(0, 1, 5)), changes


def _verdict(kind: str, first: float, last: float, change: float) -> str:
    """The fault in a figure; "" if there is none."""
    if kind == "speed":
        return "" if last >= SLOWEST else "STANDS"
    if kind in CLOCK_FIGURES:
        return "CHANGES" if abs(change) > MOST_DRIFT or not last else ""
    return "CHANGES" if change > MOST_GROWTH and last - first >= LEAST[kind] else ""


def _ends(found: Sequence[Sample], kind: str) -> tuple[float, float] | None:
    """A figure of the first and the last part after the warm-up; None of too few samples."""
    end = found[-1].time if found else 0.0
    seen = [each for each in found if each.time >= min(WARM_UP, end / 3)]
    part = len(seen) // SHARE
    if not part:
        return None
    if kind == "speed":  # a part in which only a rest falls says nothing
        part = max(part, sum(each.time > end - LONGEST_REST for each in seen))
    values = [getattr(each, kind) for each in seen]
    figure = CLOCK_FIGURES.get(kind, statistics.median)
    return figure(values[:part]), figure(values[-part:])


def draw(samples: Sequence[Sample], path: Path) -> None:
    """Memory, descriptors and threads of each process, and the pace of time, over hours."""
    with chart(path, 2, 2, sharex=True) as axes:
        for panel, kind in zip(axes.flat, (*LEAST, "pace"), strict=True):
            for name, found in grouped(samples, lambda each: each.name).items():
                if (name == CLOCK) == (kind == "pace"):
                    panel.plot([each.time / 3600 for each in found],
                               [getattr(each, kind) for each in found], label=name)
            panel.set_title("memory, MiB" if kind == "memory" else kind)
        axes.flat[0].legend(fontsize="xx-small")
        for panel in axes[1]:
            panel.set_xlabel("h")
