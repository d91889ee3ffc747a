"""A house from above, in pixels: cells, true walls, paths, goals, the robot."""

from __future__ import annotations

import cv2
import numpy as np

from evaluation.picture import FLOOR, TEXT, draw_line, write_text
from nav_algorithms.grid import FREE, OCCUPIED, OccupancyGrid
from nav_algorithms.poses import transform_points

CLEAR, WALL, TRUE_WALL = (66, 58, 54), (235, 232, 228), (120, 190, 60)  # BGR
GOAL, MISSED, ROBOT = (70, 200, 250), (60, 60, 240), (60, 60, 240)
OCCUPIED_FROM = 50  # percent
HEAD = np.array([(0.22, 0.0), (-0.16, 0.15), (-0.08, 0.0), (-0.16, -0.15)])  # m, an arrow head
SHIFT = 4  # cv2 draws between pixels when coordinates are given in sixteenths


class HouseMap:
    """Draws what lies within a rectangle of the world, low to high (x, y), m; y points up."""

    def __init__(self, low: np.ndarray, high: np.ndarray, width_px: int):
        self._low, self._high = np.asarray(low, float), np.asarray(high, float)
        self.px_per_m = width_px / (self._high[0] - self._low[0])
        self.width_px = width_px
        self.height_px = round((self._high[1] - self._low[1]) * self.px_per_m)

    def to_px(self, points: np.ndarray) -> np.ndarray:
        """World points (N, 2) as pixel coordinates (N, 2), float."""
        points = np.asarray(points, float).reshape(-1, 2)
        return (points - (self._low[0], self._high[1])) * (self.px_per_m, -self.px_per_m)

    def draw_cells(self, grid: OccupancyGrid | None, grid_in_world: np.ndarray) -> np.ndarray:
        """A new picture (rows, columns, 3) with the grid's cells; unknown is the floor's colour."""
        size = self.width_px, self.height_px
        if grid is None:
            return np.full((*size[::-1], 3), FLOOR, np.uint8)
        cells = np.full((*grid.cells.shape, 3), FLOOR, np.uint8)
        cells[(grid.cells >= FREE) & (grid.cells < OCCUPIED_FROM)] = CLEAR
        cells[grid.cells >= OCCUPIED_FROM] = WALL
        # Pixel (0, 0) of the cells has its middle half a cell within the grid.
        corners = np.array([(0.0, 0.0), (100.0, 0.0), (0.0, 100.0)])
        points = (corners + 0.5) * grid.resolution + grid.origin
        there = self.to_px(transform_points(np.asarray(grid_in_world), points)) - 0.5
        turn = cv2.getAffineTransform(corners.astype(np.float32), there.astype(np.float32))
        return cv2.warpAffine(cells, turn, size, flags=cv2.INTER_NEAREST, borderValue=FLOOR)

    def draw_true_walls(self, image: np.ndarray, walls: OccupancyGrid, thick_px: int) -> None:
        """The outline of the true walls, in the world's frame."""
        mask = OccupancyGrid(np.where(walls.cells == OCCUPIED, OCCUPIED, -1).astype(np.int8),
                             walls.resolution, walls.origin)
        drawn = (self.draw_cells(mask, np.zeros(3)) == WALL).all(axis=2).astype(np.uint8)
        outlines, _ = cv2.findContours(drawn, cv2.RETR_LIST, cv2.CHAIN_APPROX_NONE)
        cv2.drawContours(image, outlines, -1, TRUE_WALL, thick_px, cv2.LINE_AA)

    def draw_path(self, image: np.ndarray, points: np.ndarray, colour: tuple,
                  thick_px: int) -> None:
        """A line through points (N, 2) of the world."""
        if len(points) > 1:
            draw_line(image, self.to_px(points), colour, thick_px)

    def draw_dots(self, image: np.ndarray, points: np.ndarray, colour: tuple) -> None:
        """Points (N, 2) of the world, 3 px wide."""
        for x, y in np.round(self.to_px(points)).astype(int).tolist():
            cv2.rectangle(image, (x - 1, y - 1), (x + 1, y + 1), colour, -1)

    def draw_goal(self, image: np.ndarray, pose: np.ndarray, name: str, colour: tuple,
                  fine: int = 1) -> None:
        """A ring with the heading, and the goal's name beside it."""
        ends = transform_points(np.asarray(pose, float), np.array([(0.16, 0.0), (0.4, 0.0)]))
        x, y = self.to_px(np.asarray(pose)[:2])[0]
        radius = round(0.16 * self.px_per_m)
        cv2.circle(image, (round(x), round(y)), radius, colour, 2 * fine, cv2.LINE_AA)
        draw_line(image, self.to_px(ends), colour, 2 * fine)
        write_text(image, name, (round(x) + radius + 3 * fine, round(y) - radius), 12 * fine, TEXT)

    def draw_robot(self, image: np.ndarray, pose: np.ndarray) -> None:
        """A red arrow head with its reference point at the pose (3,) in the world."""
        corners = self.to_px(transform_points(np.asarray(pose, float), HEAD))
        fixed = np.round(corners * (1 << SHIFT)).astype(np.int32)
        cv2.fillPoly(image, [fixed], ROBOT, cv2.LINE_AA, SHIFT)
        cv2.polylines(image, [fixed], True, (255, 255, 255), 1, cv2.LINE_AA, SHIFT)
