"""A picture of a map with the paths that were driven on it."""

from pathlib import Path

import cv2
import numpy as np
from trial_venue import OUTLINE

from nav_algorithms.cells import UNKNOWN, OccupancyGrid
from nav_algorithms.poses import transform_points

PX_PER_CELL, MARGIN = 5, 6
GREY, BLACK, WHITE = (205, 205, 205), (0, 0, 0), (255, 255, 255)  # BGR
TRUE_WALL, DRIVEN, BACKWARDS, BELIEVED, GOAL = (
    (60, 170, 60), (200, 90, 20), (30, 30, 220), (230, 160, 60), (170, 0, 170))


def draw(path: Path, grid: OccupancyGrid, walls: OccupancyGrid, truth: np.ndarray,
         believed: np.ndarray, goals: list[np.ndarray]) -> None:
    """PNG: the map, true walls in green, the path driven in blue, backwards in red.

    `truth` (N, 5) and `believed` (M, 4) as in Record, `goals` poses (3,); all in the map's frame.
    """
    grid = _known(grid)
    shades = np.full((*grid.cells.shape, 3), WHITE, np.uint8)
    shades[grid.cells == UNKNOWN], shades[grid.cells >= 65] = GREY, BLACK
    image = np.kron(shades[::-1], np.ones((PX_PER_CELL, PX_PER_CELL, 1), np.uint8))
    px_per_m = PX_PER_CELL / grid.resolution

    def to_px(points: np.ndarray) -> np.ndarray:
        found = (np.atleast_2d(points) - grid.origin) * px_per_m
        return np.round(np.column_stack((found[:, 0], image.shape[0] - found[:, 1]))).astype(int)

    for x, y in to_px(walls.centres_of(np.argwhere(walls.cells >= 65))):
        cv2.circle(image, (int(x), int(y)), 1, TRUE_WALL, -1)
    for pose in goals:
        cv2.polylines(image, [to_px(transform_points(pose, OUTLINE)).astype(np.int32)], True,
                      GOAL, 2)
    cv2.polylines(image, [to_px(believed[:, 1:3]).astype(np.int32)], False, BELIEVED, 1)
    pixels = to_px(truth[:, 1:3])
    for begin, end, speed in zip(pixels, pixels[1:], truth[1:, 4]):
        cv2.line(image, tuple(map(int, begin)), tuple(map(int, end)),
                 DRIVEN if speed >= 0 else BACKWARDS, 2, cv2.LINE_AA)
    cv2.imwrite(str(path), image)


def _known(grid: OccupancyGrid) -> OccupancyGrid:
    """The part that anything is known of, and MARGIN cells round it."""
    rows, columns = np.nonzero(grid.cells != UNKNOWN)
    low = np.maximum((rows.min() - MARGIN, columns.min() - MARGIN), 0)
    cells = grid.cells[low[0]:rows.max() + MARGIN, low[1]:columns.max() + MARGIN]
    return OccupancyGrid(cells, grid.resolution, tuple(grid.origin + low[::-1] * grid.resolution))
