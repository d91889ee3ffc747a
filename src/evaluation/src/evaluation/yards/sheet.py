"""yards.png and crossings.png: every drive's way, seen from above."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np

from evaluation.picture import PAPER, TEXT, tile_sheet, write_text
from evaluation.yards.crossing import APPROACH, PERSON_RADIUS, Crossing
from evaluation.yards.results import CROSSINGS, YARDS, Drive
from evaluation.yards.yard import APRON, CELL, RADIUS, SIZE, draw_yard, places

COLUMNS, SCALE, CAPTION_PX, GAP_PX = 5, 64, 20, 6  # SCALE: px/m
WIDTH_M, HEIGHT_M = (SIZE + 2 * APRON) * CELL, SIZE * CELL
LEFT_M, HIGH_M = -APRON * CELL, SIZE * CELL / 2  # of a yard's picture
CROSSING_LEFT_M, CROSSING_WIDTH_M = -0.2, 5.4
OBSTACLE, SHORTEST, PERSON = (150, 140, 130), (190, 220, 190), (200, 150, 170)  # BGR
WAYS = ((168, 108, 27), (47, 140, 201), (80, 143, 58))  # a colour for each repeat
FAILED = (43, 57, 192)
SHIFT = 4  # bits of a pixel's fraction that OpenCV is given


def write_sheets(drives: Sequence[Drive], out: Path) -> list[str]:
    """Write them below `out`; returns their names."""
    written = []
    for kind, draw in ((YARDS, _yard_tile), (CROSSINGS, _crossing_tile)):
        groups: dict[int, list[Drive]] = {}
        for drive in drives:
            if drive.set == kind:
                groups.setdefault(drive.seed, []).append(drive)
        if groups:
            tiles = [draw(group, out) for group in groups.values()]
            cv2.imwrite(str(out / f"{kind}.png"), tile_sheet(tiles, COLUMNS, GAP_PX))
            written.append(f"{kind}.png")
    return written


class _Tile:
    """A picture of a piece of ground, under a caption."""

    def __init__(self, left: float, width: float, high: float, height: float):
        self._left, self._high = left, high
        self.image = np.full((round(height * SCALE) + CAPTION_PX, round(width * SCALE), 3), PAPER,
                             np.uint8)

    def pixels(self, points: np.ndarray) -> np.ndarray:
        """Pixels with SHIFT bits of fraction."""
        x = (points[:, 0] - self._left) * SCALE
        y = (self._high - points[:, 1]) * SCALE + CAPTION_PX
        return np.round(np.stack((x, y), axis=1) * (1 << SHIFT)).astype(np.int32)

    def line(self, points: np.ndarray, colour: tuple, width: int = 1) -> None:
        """Through points (N, 2), m."""
        cv2.polylines(self.image, [self.pixels(points)], False, colour, width, cv2.LINE_AA, SHIFT)

    def disc(self, point: np.ndarray, radius: float, colour: tuple) -> None:
        """About a point (2,), m."""
        centre = tuple(self.pixels(point[None])[0].tolist())
        cv2.circle(self.image, centre, round(radius * SCALE * (1 << SHIFT)), colour, -1,
                   cv2.LINE_AA, SHIFT)

    def ways(self, drives: list[Drive], out: Path) -> None:
        """What was driven, with a dot where it did not come to its goal."""
        for drive in drives:
            path = out / "drives" / f"{drive.name}.json"
            if path.exists():
                way = np.array(json.loads(path.read_text()))[:, 1:3]
                self.line(way, WAYS[drive.repeat % len(WAYS)])
                if not drive.reached:
                    self.disc(way[-1], 0.08, FAILED)

    def caption(self, drives: list[Drive]) -> None:
        """How the drives ended."""
        said = ", ".join(f"{each.time:.0f} s" if each.reached else each.outcome for each in drives)
        good = all(each.reached for each in drives)
        write_text(self.image, f"{drives[0].seed}: {said}", (4, CAPTION_PX - 6), 9,
                   TEXT if good else FAILED)


def _yard_tile(drives: list[Drive], out: Path) -> np.ndarray:
    yard = draw_yard(drives[0].seed)
    tile = _Tile(LEFT_M, WIDTH_M, HIGH_M, HEIGHT_M)
    tile.line(places(yard.path), SHORTEST, 3)
    for centre in yard.cylinders:
        tile.disc(centre, RADIUS, OBSTACLE)
    tile.ways(drives, out)
    tile.caption(drives)
    return tile.image


def _crossing_tile(drives: list[Drive], out: Path) -> np.ndarray:
    tile = _Tile(CROSSING_LEFT_M, CROSSING_WIDTH_M, HIGH_M, HEIGHT_M)
    walk = Crossing(**drives[0].drawn)
    direction = np.array([np.cos(walk.heading), np.sin(walk.heading)])
    begin = np.array(walk.begin[:2])
    tile.line(np.array([begin, begin + 2 * APPROACH * direction]), PERSON,
              round(2 * PERSON_RADIUS * SCALE))
    tile.ways(drives, out)
    tile.caption(drives)
    return tile.image
