"""The line's column near the robot: find_line(image), on drawn bends."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np

from exercises.errors import Mistake
from exercises.finding import Finding, at_most, holds
from exercises.program import load, numbers, part

WIDTH, HEIGHT, HORIZON = 640, 360, 200  # px
YELLOW, ASPHALT = (0, 230, 230), (45, 45, 45)  # BGR
BAND = slice(5 * HEIGHT // 6, 5 * HEIGHT // 6 + 20)  # rows, as in lesson 5
CALL = "find_line(image)"


def bend(near: float, swing: float) -> np.ndarray:
    """An image of a line that starts at column `near` and is `swing` px aside at the horizon."""
    rows = np.arange(HORIZON, HEIGHT)
    far = (HEIGHT - rows) / (HEIGHT - HORIZON)
    middle, half = near + swing * far**2, 3 + 15 * (1 - far)
    sides = [np.stack([middle + side * half, rows], axis=1) for side in (1, -1)]
    picture = np.full((HEIGHT, WIDTH, 3), ASPHALT, np.uint8)
    outline = np.rint(np.concatenate([sides[0], sides[1][::-1]])).astype(np.int32)
    return cv2.fillPoly(picture, [outline], YELLOW)


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """It must return the line's column in the near rows, whatever is far away."""
    find_line, random = part(load(file), CALL), np.random.default_rng(0)
    errors, misplaced = [], 0
    for near, swing in random.uniform((150, -300), (490, 300), (round(limits["pictures"]), 2)):
        picture = bend(near, swing)
        answer = find_line(picture.copy())
        if answer is None:
            raise Mistake(f"{CALL} answered None for a line at column {near:.0f}")
        columns = np.nonzero((picture[BAND] == YELLOW).all(axis=2))[1]
        column, row = numbers(answer, 2, CALL)
        errors.append(abs(column - columns.mean()))
        misplaced += not BAND.start <= row < BAND.stop
    yield at_most("largest error of the column, in bends", max(errors), limits["error_px"], " px")
    yield at_most(f"answers with a row outside of {BAND.start} to {BAND.stop - 1}", misplaced, 0)
    far_only = bend(320.0, 0.0)
    far_only[5 * HEIGHT // 8:] = ASPHALT
    answer = find_line(far_only)
    yield holds("a line that is far away only", repr(answer), "None", answer is None)
