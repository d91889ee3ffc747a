"""lanes.png: each method's RMS and speed, lap by lap, and its time for a picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from evaluation.lane.results import LaneDrive
from evaluation.picture import chart
from evaluation.trial.table import grouped

COLOUR, FAILED, LIMIT = "#1b6ca8", "#c0392b", "#7a8b99"


def write_chart(drives: Sequence[LaneDrive], times: Mapping[str, float], path: Path) -> None:
    """Three panels, a row for each method; a lap that was not closed is a red cross."""
    methods = grouped(drives, lambda drive: drive.method)
    with chart(path, 1, 3, sharey=True) as ((rms, speed, time),):
        for number, (method, found) in enumerate(methods.items()):
            for drive in found:
                marker, colour = ("o", COLOUR) if drive.closed else ("x", FAILED)
                rms.plot(drive.rms_lateral * 100, number, marker, color=colour)
                speed.plot(drive.mean_speed, number, marker, color=colour)
            time.barh(number, times.get(method, 0.0), height=0.5, color=COLOUR)
        rms.axvline(LaneDrive.most_rms * 100, color=LIMIT, linewidth=1)
        speed.axvline(LaneDrive.least_speed, color=LIMIT, linewidth=1)
        for axes, title in ((rms, "RMS from the lane's middle, cm"), (speed, "mean speed, m/s"),
                            (time, "processor time, ms a picture")):
            axes.set_xlim(0, 1.05 * axes.get_xlim()[1])
            axes.set_title(title, fontsize=10)
        rms.set_yticks(range(len(methods)), methods)
        rms.invert_yaxis()
        rms.set_xlabel("o lap closed   x not closed   grey: limit", fontsize=9)
