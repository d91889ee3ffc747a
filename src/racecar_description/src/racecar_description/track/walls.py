"""Walls along both edges of the road, as few straight boxes, and their map."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np

from racecar_description.track.circuit import Circuit

GAP = 0.1  # m, between the asphalt and a wall
THICKNESS, HEIGHT = 0.08, 0.25  # m
STRAIGHTENED = 0.03  # m, largest distance of a straight wall from the curve it follows
CELL = 0.01  # m, cell size of the raster on which walls are traced
LEAST_ISLAND = 0.3  # m, of an infield: smaller ones have no room for a wall
MAP_CELL = 0.05  # m
FREE, UNKNOWN, OCCUPIED = 254, 205, 0  # grey levels of map_server


@dataclass(frozen=True)
class Box:
    """A wall's centre, its heading (rad) and its length; m, world frame."""

    x: float
    y: float
    heading: float
    length: float


@dataclass(frozen=True)
class GridMap:
    """An image for map_server, top row first, and the place of its lower left corner."""

    image: np.ndarray
    x: float
    y: float


def trace_walls(course: Circuit) -> list[np.ndarray]:
    """Closed polygons (n, 2), the centre lines of the walls."""
    raster = _Raster(course)
    inside = raster.band(course.half_road + GAP + THICKNESS / 2)
    contours, _ = cv2.findContours(inside, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    polygons = []
    for contour in contours:
        if cv2.arcLength(contour, True) * CELL >= 2 * math.pi * LEAST_ISLAND:
            polygon = cv2.approxPolyDP(contour, STRAIGHTENED / CELL, True).reshape(-1, 2)
            polygons.append(raster.to_world(polygon))
    return polygons


def wall_boxes(polygons: list[np.ndarray]) -> list[Box]:
    """A box for each side, a little longer, so that corners have no gap."""
    boxes = []
    for polygon in polygons:
        for (ax, ay), (bx, by) in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
            length = math.hypot(bx - ax, by - ay) + THICKNESS / 4
            heading = math.atan2(by - ay, bx - ax)
            values = ((ax + bx) / 2, (ay + by) / 2, heading, length)
            boxes.append(Box(*(round(float(value), 4) for value in values)))
    return boxes


def grid_map(course: Circuit, polygons: list[np.ndarray]) -> GridMap:
    """Free where the car can be, occupied where walls are, unknown beyond."""
    raster = _Raster(course)
    inside = raster.band(course.half_road + (GAP if polygons else 0.0))
    walls = np.zeros_like(inside)
    for polygon in polygons:
        points = raster.to_px(polygon)
        cv2.polylines(walls, [points], True, 255, round(THICKNESS / CELL))
    step = round(MAP_CELL / CELL)
    size = [-(-side // step) for side in inside.shape]
    padded = [
        np.pad(picture, [(size[i] * step - picture.shape[i], 0) if i == 0 else
                         (0, size[i] * step - picture.shape[i]) for i in (0, 1)])
        for picture in (inside, walls)
    ]
    free, wall = (
        cv2.resize(picture, tuple(size[::-1]), interpolation=cv2.INTER_AREA) for picture in padded
    )
    image = np.full(size, UNKNOWN, np.uint8)
    image[free > 127] = FREE
    image[wall > 90] = OCCUPIED
    return GridMap(image, raster.low_x, raster.low_y)


class _Raster:
    """A raster image of the road's surroundings, CELL m per pixel; up is the world's +y."""

    def __init__(self, course: Circuit):
        self._points = course.line.points()
        margin = course.half_road + GAP + THICKNESS + 0.1
        low = np.floor((self._points.min(axis=0) - margin) / MAP_CELL) * MAP_CELL
        high = np.ceil((self._points.max(axis=0) + margin) / MAP_CELL) * MAP_CELL
        self.low_x, self.low_y = (round(float(value), 6) for value in low)
        self._size = np.round((high - low) / CELL).astype(int)

    def band(self, reach: float) -> np.ndarray:
        """255 within reach (m) of the centre line, else 0."""
        picture = np.zeros(self._size[::-1], np.uint8)
        thick = round(2 * reach / CELL)
        cv2.polylines(picture, [self.to_px(self._points)], True, 255, thick)
        return picture

    def to_px(self, points: np.ndarray) -> np.ndarray:
        """The pixels that contain world points."""
        columns = (points[:, 0] - self.low_x) / CELL
        rows = self._size[1] - (points[:, 1] - self.low_y) / CELL
        return np.round(np.column_stack((columns, rows)) - 0.5).astype(np.int32)

    def to_world(self, pixels: np.ndarray) -> np.ndarray:
        """Pixel centres as world points."""
        x = self.low_x + (pixels[:, 0] + 0.5) * CELL
        y = self.low_y + (self._size[1] - pixels[:, 1] - 0.5) * CELL
        return np.column_stack((x, y))
