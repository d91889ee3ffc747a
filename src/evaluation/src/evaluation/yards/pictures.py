"""trials.png: time, gap and difficulty; yards.png, crossings.png: every path from above."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from evaluation.colours import CAR, FAINT, GOOD, lap_colour
from evaluation.picture import chart, write_tiles
from evaluation.trial.report import grouped
from evaluation.yards.outcomes import CROSSINGS, REACHED, YARDS, Drive
from trial_worlds.crossing import APPROACH, PERSON_RADIUS, Crossing
from trial_worlds.yard import APRON, CELL, RADIUS, SIZE, draw_yard, places

YARD = (-APRON * CELL, (SIZE + APRON) * CELL, -SIZE * CELL / 2, SIZE * CELL / 2)  # m: x, y
ROOM = (-0.2, 5.2, *YARD[2:])
TILE_WIDTH, CAPTION = 3.4, 0.25  # inches
COLOURS = {REACHED: "#1b6ca8", "called reached": "#16a085", "contact": "#c0392b",
           "walked into": "#8e44ad", "given up": "#c9782f", "late": "#7a8b99"}

# Set, labels of x and y axis, and their values.
PANELS: tuple[tuple[str, str, str, Callable[[Drive], float], Callable[[Drive], float]], ...] = (
    (YARDS, "yard", "time by straight-line time",
     lambda drive: drive.seed, lambda drive: drive.time / drive.straight_time),
    (YARDS, "closest obstacle along the shortest way, cells", "time by straight-line time",
     lambda drive: drive.drawn["closest_obstacle"],
     lambda drive: drive.time / drive.straight_time),
    (YARDS, "yard", "least air, cm",
     lambda drive: drive.seed, lambda drive: (drive.to_obstacles or 0.0) * 100),
    (CROSSINGS, "crossing", "least air to the person, cm",
     lambda drive: drive.seed, lambda drive: (drive.to_person or 0.0) * 100))


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


def write_sheets(drives: Sequence[Drive], out: Path) -> list[str]:
    """Write yards.png and crossings.png below `out`; returns their names."""
    written = []
    sets = grouped(drives, lambda drive: drive.set)
    for kind, edges, ground in ((YARDS, YARD, _draw_yard), (CROSSINGS, ROOM, _draw_walk)):
        def draw(axes: object, group: list[Drive], edges=edges, ground=ground) -> tuple[str, bool]:
            axes.set(xlim=edges[:2], ylim=edges[2:])
            ground(axes, group[0])
            return _draw_ways(axes, group, out)

        if kind in sets:
            groups = list(grouped(sets[kind], lambda drive: drive.seed).values())
            height = TILE_WIDTH * (edges[3] - edges[2]) / (edges[1] - edges[0]) + CAPTION
            write_tiles(out / f"{kind}.png", groups, draw, (TILE_WIDTH, height))
            written.append(f"{kind}.png")
    return written


def _draw_yard(axes: object, drive: Drive) -> None:
    """Draw the columns and the shortest path."""
    from matplotlib.collections import EllipseCollection

    yard = draw_yard(drive.seed)
    round_things = np.full(len(yard.cylinders), 2 * RADIUS)
    axes.add_collection(EllipseCollection(
        round_things, round_things, 0 * round_things, units="xy", facecolors=FAINT,
        offsets=yard.cylinders, offset_transform=axes.transData))
    axes.plot(*places(yard.path).T, color=GOOD, linewidth=3, alpha=0.4)


def _draw_walk(axes: object, drive: Drive) -> None:
    """Draw the strip that the person walks through."""
    walk = Crossing(**drive.drawn)
    begin, yaw = np.array(walk.begin[:2]), walk.heading
    ends = np.array([begin, begin + 2 * APPROACH * np.array([np.cos(yaw), np.sin(yaw)])])
    aside = PERSON_RADIUS * np.array([-np.sin(yaw), np.cos(yaw)])
    axes.fill(*np.concatenate([ends + aside, ends[::-1] - aside]).T, color=lap_colour(3), alpha=0.5)


def _draw_ways(axes: object, drives: list[Drive], out: Path) -> tuple[str, bool]:
    """Draw the paths, with a dot where one missed its goal; returns the caption and success."""
    for drive in drives:
        path = out / "drives" / f"{drive.name}.json"
        if path.exists():
            way = np.array(json.loads(path.read_text()))[:, 1:3]
            axes.plot(*way.T, color=lap_colour(drive.repeat), linewidth=1)
            if not drive.reached:
                axes.plot(*way[-1], "o", color=CAR, markersize=4)
    said = ", ".join(f"{each.time:.0f} s" if each.reached else each.outcome for each in drives)
    return f"{drives[0].seed}: {said}", all(each.reached for each in drives)
