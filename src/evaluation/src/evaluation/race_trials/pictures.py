"""trials.png: RMS and speed of every lap, with the limits; paths_FOLLOWER.png: all its paths."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import cv2

from evaluation.picture import chart, write_tiles
from evaluation.race_trials.outcomes import Lap
from evaluation.trial.report import grouped

COLOURS = ("#1b6ca8", "#c9782f", "#7a8b99", "#3a8f5c")
LIMIT_COLOUR = "#c0392b"
TILE = (4.4, 3.6)  # inches, of a path

# Label, value, limit, and which side of the limit is good.
ROWS: tuple[tuple[str, Callable[[Lap], float], float, str], ...] = (
    ("RMS beside the line, cm", lambda lap: lap.rms_lateral * 100, Lap.most_rms * 100, "at most"),
    ("mean speed, m/s", lambda lap: lap.mean_speed, Lap.least_speed, "at least"),
)


def write_chart(laps: Sequence[Lap], path: Path) -> None:
    """A column for each set of laps; a cross marks a lap that was not completed."""
    sets = grouped(laps, lambda lap: lap.set)
    with chart(path, len(ROWS), len(sets), sharey="row") as grid:
        for column, (name, found) in enumerate(sets.items()):
            for axes, (label, value, limit, side) in zip(grid[:, column], ROWS, strict=True):
                _draw(axes, found, value)
                axes.axhline(limit, color=LIMIT_COLOUR, linewidth=1, label=f"{side} {limit:g}")
                axes.set_ylabel(label, fontsize=9)
            grid[0, column].set_title(name, fontsize=10)
            grid[-1, column].set_xlabel("seed", fontsize=9)
        for axes in grid[:, 0]:  # the rest of the row shares it
            axes.set_ylim(bottom=0)
        grid[0, 0].legend(fontsize=8)


def _draw(axes: object, laps: Sequence[Lap], value: Callable[[Lap], float]) -> None:
    seeds = sorted({lap.seed for lap in laps})
    followers = list(dict.fromkeys(lap.follower for lap in laps))
    for (follower, closed), found in grouped(laps, lambda lap: (lap.follower, lap.closed)).items():
        axes.plot([seeds.index(lap.seed) for lap in found], [value(lap) for lap in found],
                  "o" if closed else "x", label=f"{follower}{'' if closed else ', not closed'}",
                  color=COLOURS[followers.index(follower) % len(COLOURS)])
    axes.set_xticks(range(len(seeds)), [str(seed) for seed in seeds])
    axes.margins(y=0.1)


def write_path_sheet(laps: Sequence[Lap], out: Path) -> Path:
    """Write OUT/paths_<follower>.png with a tile for each of the follower's laps."""
    path = out / f"paths_{Path(laps[0].follower).stem}.png"
    write_tiles(path, laps, partial(_draw_path, out), TILE)
    return path


def _draw_path(out: Path, axes: object, lap: Lap) -> tuple[str, bool]:
    """Draw the lap's path; returns its caption, and whether it was within the limits."""
    picture = cv2.imread(str(out / lap.folder / "path.png"), cv2.IMREAD_REDUCED_COLOR_2)
    if picture is not None:
        axes.imshow(picture[..., ::-1])
    figures = f"{lap.mean_speed:.2f} m/s, RMS {lap.rms_lateral * 100:.1f} cm"
    return f"{lap.track}, seed {lap.seed}: {lap.outcome}, {figures}", lap.within_limits
