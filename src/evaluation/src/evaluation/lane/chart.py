"""lanes.png: each method's RMS and speed, lap by lap, and its time for a picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

from matplotlib import pyplot
from matplotlib.axes import Axes

from evaluation.lane.results import LEAST_SPEED, MOST_RMS, LaneDrive

COLOUR, FAILED, LIMIT = "#1b6ca8", "#c0392b", "#7a8b99"
DOTS_PER_INCH, SIZE = 110, (12.0, 4.2)  # inches


def write_chart(drives: Sequence[LaneDrive], times: Mapping[str, float], path: Path) -> None:
    """Three panels, a row for each method; a lap that was not closed is a red cross."""
    methods = list(dict.fromkeys(drive.method for drive in drives))
    sheet, panels = pyplot.subplots(1, 3, figsize=SIZE, sharey=True)
    for number, method in enumerate(methods):
        for drive in (each for each in drives if each.method == method):
            marker, colour = ("o", COLOUR) if drive.closed else ("x", FAILED)
            panels[0].plot(drive.rms_lateral * 100, number, marker, color=colour)
            panels[1].plot(drive.mean_speed, number, marker, color=colour)
        panels[2].barh(number, times.get(method, 0.0), height=0.5, color=COLOUR)
    panels[0].axvline(MOST_RMS * 100, color=LIMIT, linewidth=1)
    panels[1].axvline(LEAST_SPEED, color=LIMIT, linewidth=1)
    titles = ("RMS from the lane's middle, cm", "mean speed, m/s", "processor time, ms a picture")
    for axes, title in zip(panels, titles, strict=True):
        _finish(axes, title)
    panels[0].set_yticks(range(len(methods)), methods)
    panels[0].invert_yaxis()
    sheet.suptitle("o lap closed   x not closed   grey: limit", fontsize=9)
    sheet.tight_layout()
    sheet.savefig(path, dpi=DOTS_PER_INCH)
    pyplot.close(sheet)


def _finish(axes: Axes, title: str) -> None:
    axes.set_xlim(0, 1.05 * axes.get_xlim()[1])
    axes.set_title(title, fontsize=10)
    axes.tick_params(labelsize=8, length=0)
    axes.grid(axis="x", alpha=0.3)
