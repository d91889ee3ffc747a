"""One picture with the paths of all laps of a follower, from each lap's path.png."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np

from evaluation.picture import PAPER, TEXT, tile_sheet, write_text
from evaluation.race_trials.results import Lap

COLUMNS, WIDTH_PX, HEIGHT_PX, CAPTION_PX, GAP_PX = 5, 440, 330, 34, 8
FAILED = (90, 90, 240)  # BGR


def write_path_sheet(laps: Sequence[Lap], out: Path) -> Path:
    """Write OUT/paths_<follower>.png with a tile for each of the follower's laps."""
    path = out / f"paths_{Path(laps[0].follower).stem}.png"
    cv2.imwrite(str(path), tile_sheet([_tile(lap, out) for lap in laps], COLUMNS, GAP_PX))
    return path


def _tile(lap: Lap, out: Path) -> np.ndarray:
    """The path as large as fits, under a caption."""
    tile = np.full((HEIGHT_PX + CAPTION_PX, WIDTH_PX, 3), PAPER, np.uint8)
    figures = f"{lap.mean_speed:.2f} m/s, RMS {lap.rms_lateral * 100:.1f} cm"
    caption = f"{lap.track}, seed {lap.seed}: {lap.outcome}, {figures}"
    write_text(tile, caption, (4, CAPTION_PX - 12), 10, TEXT if lap.within_limits else FAILED)
    picture = cv2.imread(str(out / lap.folder / "path.png"))
    if picture is not None:
        scale = min(WIDTH_PX / picture.shape[1], HEIGHT_PX / picture.shape[0])
        small = cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
        tile[CAPTION_PX : CAPTION_PX + small.shape[0], : small.shape[1]] = small[:HEIGHT_PX]
    return tile
