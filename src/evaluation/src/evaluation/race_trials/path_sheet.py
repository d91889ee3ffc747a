"""One picture with the paths of all laps of a follower, from each lap's path.png."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

import cv2

from evaluation.picture import write_tiles
from evaluation.race_trials.results import Lap

TILE = (4.4, 3.6)  # inches


def write_path_sheet(laps: Sequence[Lap], out: Path) -> Path:
    """Write OUT/paths_<follower>.png with a tile for each of the follower's laps."""
    path = out / f"paths_{Path(laps[0].follower).stem}.png"
    write_tiles(path, laps, partial(_draw, out), TILE)
    return path


def _draw(out: Path, axes: object, lap: Lap) -> tuple[str, bool]:
    """The lap's path, and how it went."""
    picture = cv2.imread(str(out / lap.folder / "path.png"), cv2.IMREAD_REDUCED_COLOR_2)
    if picture is not None:
        axes.imshow(picture[..., ::-1])
    figures = f"{lap.mean_speed:.2f} m/s, RMS {lap.rms_lateral * 100:.1f} cm"
    return f"{lap.track}, seed {lap.seed}: {lap.outcome}, {figures}", lap.within_limits
