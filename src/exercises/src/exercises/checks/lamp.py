"""Which lamp is lit: lit_lamp(picture), on drawn images of lamps, lines and a bar."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np

from exercises.finding import Finding, at_least
from exercises.program import load, part

WIDTH, HEIGHT, ASPHALT = 320, 240, (60, 60, 60)  # px, px, BGR
LAMPS = {"red": (0, 0, 255), "yellow": (0, 255, 255), "green": (0, 255, 0)}  # BGR
RADIUS, LINE = (6, 12), 14  # px: range of a lamp's radius; width of a line
CALL = "lit_lamp(picture)"


def street(random: np.random.Generator, lamp: str | None) -> np.ndarray:
    """An image with a vertical yellow line, a red bar across it, and the lamp above, if any."""
    picture = np.full((HEIGHT, WIDTH, 3), ASPHALT, np.uint8)
    column, row = random.integers(40, WIDTH - 40), random.integers(110, 130)
    cv2.rectangle(picture, (column, 150), (column + LINE, HEIGHT), LAMPS["yellow"], -1)
    cv2.rectangle(picture, (60, row), (WIDTH - 60, row + LINE), LAMPS["red"], -1)
    if lamp:
        place = int(random.integers(30, WIDTH - 30)), int(random.integers(30, 80))
        cv2.circle(picture, place, int(random.integers(*RADIUS)), LAMPS[lamp], -1)
    return picture


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """It must name the lit lamp despite other coloured objects, and none if none is lit."""
    lit_lamp, random = part(load(file), CALL), np.random.default_rng(0)
    each = round(limits["pictures"])
    right = {lamp: sum(lit_lamp(street(random, lamp)) == lamp for _ in range(each))
             for lamp in (*LAMPS, None)}
    nothing = right.pop(None)
    yield at_least("pictures of a lamp, a line and a bar, in which it names the lamp",
                   sum(right.values()), len(LAMPS) * each)
    yield at_least("pictures of a line and a bar, in which it sees no lamp", nothing, each)
