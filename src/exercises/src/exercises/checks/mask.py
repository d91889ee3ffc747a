"""A mask for one colour: white_mask(image), on stripes of white, yellow and asphalt."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np

from exercises.finding import Finding, at_least, at_most
from exercises.program import load, mask_of, part

SIZE = 120, 90  # px, rows and columns of each stripe
STRIPES = {  # hue 0..180, saturation and value 0..255: bounds, as in the course's light
    "white": ((0, 0, 140), (180, 25, 255)),
    "yellow": ((24, 150, 120), (34, 255, 255)),
    "asphalt": ((0, 0, 20), (180, 40, 80)),
}


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """White must be kept, yellow and asphalt removed, by shares of a stripe's pixels."""
    white_mask = part(load(file), "white_mask(image)")
    for name, (low, high) in STRIPES.items():
        pixels = np.random.default_rng(0).integers(low, high, (*SIZE, 3), np.uint8, endpoint=True)
        picture = cv2.cvtColor(pixels, cv2.COLOR_HSV2BGR)
        share = mask_of(white_mask(picture), SIZE, "white_mask(image)").mean()
        said = f"share of {name} pixels in the mask"
        yield (at_least(said, share, limits["kept_share"]) if name == "white"
               else at_most(said, share, limits["taken_share"]))
