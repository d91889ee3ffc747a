"""The surface that turtles draw on: metres to pixels, lines, the colour at a place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SIDE_PX = 500
PX_PER_M = 45  # upstream's metre is the height of its turtle's image
SIDE = (SIDE_PX - 1) / PX_PER_M  # m, 11.0889
Color = tuple[int, int, int]  # red, green, blue, 0 to 255 each
Place = tuple[float, float]  # m, from the bottom left corner

_ON_EDGE_PX = 1e-6  # so that rounding does not decide about pixels just on a line's edge


@dataclass(frozen=True)
class Pen:
    """What a turtle leaves behind; upstream's first pen."""

    color: Color = (179, 184, 255)
    width_px: int = 3
    on: bool = True


def to_px(place: Place) -> np.ndarray:
    """(2,) column and row, as floats; rows count downwards."""
    return np.array([place[0] * PX_PER_M, (SIDE - place[1]) * PX_PER_M])


class Canvas:
    """pixels: (500, 500, 3) uint8 RGB, without the turtles; `changes` counts what is drawn."""

    def __init__(self, background: Color) -> None:
        self.changes = 0
        self.pixels = np.empty((SIDE_PX, SIDE_PX, 3), np.uint8)
        self.fill(background)

    def fill(self, background: Color) -> None:
        self.pixels[:] = background
        self.changes += 1

    def line(self, start: Place, end: Place, pen: Pen) -> None:
        """As broad as the pen and as much longer, as Qt draws; not smoothed: one colour only."""
        if not pen.on:
            return
        near, far = sorted((to_px(start), to_px(end)), key=lambda point: np.abs(point).max())
        length = float(np.hypot(*(far - near)))
        ahead = (far - near) / length if length else np.array([1.0, 0.0])
        columns, rows = (self._reached(near[axis], far[axis], pen.width_px) for axis in (0, 1))
        x = np.arange(columns.start, columns.stop) - near[0]
        y = np.arange(rows.start, rows.stop)[:, None] - near[1]
        half = pen.width_px / 2 + _ON_EDGE_PX
        along, across = ahead[0] * x + ahead[1] * y + half, ahead[0] * y - ahead[1] * x + half
        inked = ((along >= 0) & (along < length + pen.width_px)
                 & (across >= 0) & (across < pen.width_px))
        self.pixels[rows, columns][inked] = pen.color
        self.changes += 1

    def color_at(self, place: Place) -> Color:
        """At a place within the pond, both ends of it included."""
        column, row = np.rint(to_px(place)).astype(int)
        red, green, blue = self.pixels[row, column]
        return int(red), int(green), int(blue)

    def _reached(self, one: float, other: float, width_px: int) -> slice:
        """The rows or columns of the surface that a line between these two can touch."""
        low, high = sorted((one, other))
        first = int(min(max(low - width_px, 0), SIDE_PX))
        return slice(first, max(first, int(min(high + width_px + 1, SIDE_PX))))
