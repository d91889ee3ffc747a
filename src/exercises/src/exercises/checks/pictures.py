"""Functions of a picture, on drawn ones: a mask, a lamp, a line."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np

from exercises.finding import Finding, Mistake, at_least, at_most, holds
from exercises.program import load, mask_of, numbers, part

SIZE = 120, 90  # px, rows and columns of each stripe
STRIPES = {  # hue 0..180, saturation and value 0..255: bounds, as in the course's light
    "white": ((0, 0, 140), (180, 25, 255)),
    "yellow": ((24, 150, 120), (34, 255, 255)),
    "asphalt": ((0, 0, 20), (180, 40, 80)),
}


def mask(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """A mask for one colour: white_mask(image), on stripes of white, yellow and asphalt.

    White must be kept, yellow and asphalt removed, by shares of a stripe's pixels.
    """
    white_mask = part(load(file), "white_mask(image)")
    for name, (low, high) in STRIPES.items():
        pixels = np.random.default_rng(0).integers(low, high, (*SIZE, 3), np.uint8, endpoint=True)
        picture = cv2.cvtColor(pixels, cv2.COLOR_HSV2BGR)
        share = mask_of(white_mask(picture), SIZE, "white_mask(image)").mean()
        said = f"share of {name} pixels in the mask"
        yield (at_least(said, share, limits["kept_share"]) if name == "white"
               else at_most(said, share, limits["taken_share"]))


LAMP_WIDTH, LAMP_HEIGHT, LAMP_ASPHALT = 320, 240, (60, 60, 60)  # px, px, BGR
LAMPS = {"red": (0, 0, 255), "yellow": (0, 255, 255), "green": (0, 255, 0)}  # BGR
RADIUS, LINE = (6, 12), 14  # px: range of a lamp's radius; width of a line
LAMP_CALL = "lit_lamp(picture)"


def street(random: np.random.Generator, lamp: str | None) -> np.ndarray:
    """An image with a vertical yellow line, a red bar across it, and the lamp above, if any."""
    picture = np.full((LAMP_HEIGHT, LAMP_WIDTH, 3), LAMP_ASPHALT, np.uint8)
    column, row = random.integers(40, LAMP_WIDTH - 40), random.integers(110, 130)
    cv2.rectangle(picture, (column, 150), (column + LINE, LAMP_HEIGHT), LAMPS["yellow"], -1)
    cv2.rectangle(picture, (60, row), (LAMP_WIDTH - 60, row + LINE), LAMPS["red"], -1)
    if lamp:
        place = int(random.integers(30, LAMP_WIDTH - 30)), int(random.integers(30, 80))
        cv2.circle(picture, place, int(random.integers(*RADIUS)), LAMPS[lamp], -1)
    return picture


def lamp(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """Which lamp is lit: lit_lamp(picture), on drawn images of lamps, lines and a bar.

    It must name the lit lamp despite other coloured objects, and none if none is lit.
    """
    lit_lamp, random = part(load(file), LAMP_CALL), np.random.default_rng(0)
    each = round(limits["pictures"])
    right = {lamp: sum(lit_lamp(street(random, lamp)) == lamp for _ in range(each))
             for lamp in (*LAMPS, None)}
    nothing = right.pop(None)
    yield at_least("pictures of a lamp, a line and a bar, in which it names the lamp",
                   sum(right.values()), len(LAMPS) * each)
    yield at_least("pictures of a line and a bar, in which it sees no lamp", nothing, each)


LINE_WIDTH, LINE_HEIGHT, HORIZON = 640, 360, 200  # px
YELLOW, LINE_ASPHALT = (0, 230, 230), (45, 45, 45)  # BGR
BAND = slice(5 * LINE_HEIGHT // 6, 5 * LINE_HEIGHT // 6 + 20)  # rows, as in lesson 5
LINE_CALL = "find_line(image)"


def bend(near: float, swing: float) -> np.ndarray:
    """An image of a line that starts at column `near` and is `swing` px aside at the horizon."""
    rows = np.arange(HORIZON, LINE_HEIGHT)
    far = (LINE_HEIGHT - rows) / (LINE_HEIGHT - HORIZON)
    middle, half = near + swing * far**2, 3 + 15 * (1 - far)
    sides = [np.stack([middle + side * half, rows], axis=1) for side in (1, -1)]
    picture = np.full((LINE_HEIGHT, LINE_WIDTH, 3), LINE_ASPHALT, np.uint8)
    outline = np.rint(np.concatenate([sides[0], sides[1][::-1]])).astype(np.int32)
    return cv2.fillPoly(picture, [outline], YELLOW)


def line(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """The line's column near the robot: find_line(image), on drawn bends.

    It must return the line's column in the near rows, whatever is far away.
    """
    find_line, random = part(load(file), LINE_CALL), np.random.default_rng(0)
    errors, misplaced = [], 0
    for near, swing in random.uniform((150, -300), (490, 300), (round(limits["pictures"]), 2)):
        picture = bend(near, swing)
        answer = find_line(picture.copy())
        if answer is None:
            raise Mistake(f"{LINE_CALL} answered None for a line at column {near:.0f}")
        columns = np.nonzero((picture[BAND] == YELLOW).all(axis=2))[1]
        column, row = numbers(answer, 2, LINE_CALL)
        errors.append(abs(column - columns.mean()))
        misplaced += not BAND.start <= row < BAND.stop
    yield at_most("largest error of the column, in bends", max(errors), limits["error_px"], " px")
    yield at_most(f"answers with a row outside of {BAND.start} to {BAND.stop - 1}", misplaced, 0)
    far_only = bend(320.0, 0.0)
    far_only[5 * LINE_HEIGHT // 8:] = LINE_ASPHALT
    answer = find_line(far_only)
    yield holds("a line that is far away only", repr(answer), "None", answer is None)
