"""Paints a course as seen from above: lawn, asphalt, white edges, yellow centre line."""

from __future__ import annotations

import cv2
import numpy as np

from racecar_description.track.circuit import EDGE_LINE, VERGE, Circuit

MOST_PX, MOST_PX_PER_M = 4096, 256  # of the texture's longer side; px per metre
FINE = 2  # drawn larger, then shrunk, for smooth edges
SHIFT = 4  # cv2 draws with subpixel precision if coordinates are in sixteenths
MOWN = 0.5  # m, width of the lawn's stripes, which make the speed visible
START_LINE, CHECK = 0.3, 0.05  # m, length of the start line along the road; its squares' side

# RGB
LAWNS = ((62, 104, 58), (70, 114, 64))
ASPHALT, YELLOW, WHITE, BLACK = (52, 53, 56), (250, 205, 20), (235, 235, 235), (20, 20, 20)


def texture_scale(course: Circuit) -> float:
    """px per metre."""
    longest = max(course.plane.width, course.plane.height)
    return min(float(MOST_PX_PER_M), MOST_PX / longest)


def paint_course(course: Circuit, px_per_m: float) -> np.ndarray:
    """The plane's texture, RGB uint8: up is the world's +y, right is its +x."""
    canvas = _Canvas(course, px_per_m)
    points = course.line.points()
    half = course.half_road
    canvas.paint(canvas.band(points, 2 * half), ASPHALT)
    edge = course.lane_width + EDGE_LINE / 2
    outer, inner = (canvas.band(points, 2 * reach) for reach in (edge, edge - EDGE_LINE))
    canvas.paint(cv2.subtract(outer, inner), WHITE)
    for colour, squares in zip((WHITE, BLACK), _start_squares(course), strict=True):
        canvas.paint(canvas.quads(squares), colour)
    canvas.paint(canvas.band(points, course.line_width), YELLOW)
    return canvas.image


def _start_squares(course: Circuit) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Corners (4, 2) of the start line's white and black squares, between the edge lines."""
    x, y, heading = course.start
    forward = np.array((np.cos(heading), np.sin(heading)))
    left = np.array((-forward[1], forward[0]))
    reach = course.lane_width - EDGE_LINE / 2 - VERGE
    along = np.arange(round(START_LINE / CHECK)) * CHECK - START_LINE / 2
    across = np.arange(int(2 * reach / CHECK)) * CHECK
    across += -across[-1] / 2 - CHECK / 2
    squares = ([], [])
    for i, a in enumerate(along):
        for j, b in enumerate(across):
            corners = [(a, b), (a + CHECK, b), (a + CHECK, b + CHECK), (a, b + CHECK)]
            squares[(i + j) % 2].append(
                np.array([(x, y) + p * forward + q * left for p, q in corners])
            )
    return squares


class _Canvas:
    """The plane's texture while it is being painted."""

    def __init__(self, course: Circuit, px_per_m: float):
        plane = course.plane
        self._low = np.array((plane.x - plane.width / 2, plane.y + plane.height / 2))
        self._px_per_m = px_per_m
        width, height = round(plane.width * px_per_m), round(plane.height * px_per_m)
        self.image = np.empty((height, width, 3), np.uint8)
        x = (np.arange(width) + 0.5) / px_per_m
        lawns = np.array(LAWNS, np.uint8)
        self.image[:] = lawns[np.floor(x / MOWN).astype(int) % 2]

    def band(self, points: np.ndarray, width: float) -> np.ndarray:
        """How much of each pixel (0 to 255) is within width / 2 (m) of a closed line."""
        thick = max(1, round(width * self._px_per_m * FINE))
        fine = self._empty()
        cv2.polylines(fine, [self._fixed(points)], True, 255, thick, cv2.LINE_AA, SHIFT)
        return self._shrunk(fine)

    def quads(self, shapes: list[np.ndarray]) -> np.ndarray:
        """How much of each pixel (0 to 255) is in one of the shapes."""
        fine = self._empty()
        for shape in shapes:
            cv2.fillPoly(fine, [self._fixed(shape)], 255, cv2.LINE_AA, SHIFT)
        return self._shrunk(fine)

    def paint(self, cover: np.ndarray, colour: tuple[int, int, int]) -> None:
        """Blend a colour into the texture."""
        pixels, at = self.image.reshape(-1, 3), np.flatnonzero(cover)
        share = cover.reshape(-1)[at]
        pixels[at[share == 255]] = colour
        edge = share < 255
        at, share = at[edge], share[edge][:, None].astype(np.uint16)
        mixed = pixels[at] * (255 - share) + np.array(colour, np.uint16) * share
        pixels[at] = (mixed + 127) // 255

    def _empty(self) -> np.ndarray:
        height, width = self.image.shape[:2]
        return np.zeros((height * FINE, width * FINE), np.uint8)

    def _shrunk(self, fine: np.ndarray) -> np.ndarray:
        return cv2.resize(fine, self.image.shape[1::-1], interpolation=cv2.INTER_AREA)

    def _fixed(self, points: np.ndarray) -> np.ndarray:
        pixels = (points - self._low) * (1, -1) * self._px_per_m * FINE - 0.5
        return np.round(pixels * (1 << SHIFT)).astype(np.int32)
