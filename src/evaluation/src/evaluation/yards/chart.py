"""trials.png: time, air and difficulty of every drive."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from evaluation.picture import chart
from evaluation.yards.results import CROSSINGS, REACHED, YARDS, Drive

COLOURS = {REACHED: "#1b6ca8", "called reached": "#16a085", "contact": "#c0392b",
           "walked into": "#8e44ad", "given up": "#c9782f", "late": "#7a8b99"}  # fmt: skip

# Set, what is along, across, and their values.
PANELS: tuple[tuple[str, str, str, Callable[[Drive], float], Callable[[Drive], float]], ...] = (
    (YARDS, "yard", "time by straight-line time",
     lambda drive: drive.seed, lambda drive: drive.time / drive.straight_time),
    (YARDS, "closest obstacle along the shortest way, cells", "time by straight-line time",
     lambda drive: drive.drawn["closest_obstacle"],
     lambda drive: drive.time / drive.straight_time),
    (YARDS, "yard", "least air, cm",
     lambda drive: drive.seed, lambda drive: (drive.to_obstacles or 0.0) * 100),
    (CROSSINGS, "crossing", "least air to the person, cm",
     lambda drive: drive.seed, lambda drive: (drive.to_person or 0.0) * 100),
)  # fmt: skip


def write_chart(drives: Sequence[Drive], path: Path) -> None:
    """Four panels; the colour says how a drive ended."""
    with chart(path, 2, 2) as grid:
        for axes, (kind, along, across, x, y) in zip(grid.flat, PANELS, strict=True):
            _draw(axes, [drive for drive in drives if drive.set == kind], x, y)
            axes.set_xlabel(along, fontsize=9)
            axes.set_ylabel(across, fontsize=9)


def _draw(axes: object, drives: Sequence[Drive], x: Callable[[Drive], float],
          y: Callable[[Drive], float]) -> None:
    for outcome, colour in COLOURS.items():
        found = [drive for drive in drives if drive.outcome == outcome]
        if found:
            marker = "o" if outcome == REACHED else "x"
            axes.plot([x(drive) for drive in found], [y(drive) for drive in found], marker,
                      color=colour, label=f"{outcome}: {len(found)}")
    if drives:
        axes.legend(fontsize=8)
    axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))
