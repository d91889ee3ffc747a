"""autorace.png: the ways of all drives over the course."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from turtlebot3_gazebo.making.lanes import beside
from turtlebot3_gazebo.making.race_worlds import BARRIERS, OBSTACLES, WALLS

from evaluation.autorace.judge import BAYS, HALF_LANE, WAY
from evaluation.colours import CAR, FAINT, LAPS, LINE, WHITE
from evaluation.picture import DPI, legend, map_sheet


def write_sheet(drives: Sequence, path: Path) -> None:
    """A line for each drive; those that failed end in a cross."""
    passed = sum(each.passed for each in drives)
    figure, axes = map_sheet("AutoRace 2020", f"{passed} of {len(drives)} drives passed",
                             (-2.1, -2.1), (2.1, 2.1))
    for side, colour in ((1, LINE), (-1, WHITE)):
        axes.plot(*np.array(beside(WAY, side * HALF_LANE)).T, color=colour, linewidth=3)
    for (x, y), yaw, length in WALLS.values():
        half = np.array((np.cos(yaw), np.sin(yaw))) * length / 2
        axes.plot((x - half[0], x + half[0]), (y - half[1], y + half[1]), color=FAINT, linewidth=6)
    axes.plot(*np.array(list(OBSTACLES.values())).T, "o", color=FAINT, markersize=20)
    axes.plot(*np.array(BARRIERS).T, "s", color=CAR, markersize=8, label="barriers")
    axes.plot(*np.array(list(BAYS.values())).T, "P", color=WHITE, markersize=12, label="bays")
    for number, drive in enumerate(drives):
        points = np.array(drive.path)
        axes.plot(*points.T, color=LAPS[number % len(LAPS)], linewidth=1.2)
        if not drive.passed:
            axes.plot(*points[-1], "x", color=CAR, markersize=14)
    legend(axes)
    figure.savefig(path, dpi=DPI)
