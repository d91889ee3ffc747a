"""Reads a drawing and separates the road's pixels from the paper's, in one or two ways."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np

from racecar_description.track.errors import DrawingError, Fault, TrackError

MOST_PX, LEAST_PX = 1600, 64  # longest side after scaling; least side of a usable picture
PAPER_PATCH = 0.15  # share of the longer side: roads are narrower, shadows on paper are wider
LEAST_CONTRAST = 50  # grey levels between road and paper, of 255
LEAST_STAIN_CONTRAST = 30  # the same between a road and a stain
MOST_DARK = 0.6  # share of the picture: more is a dark background
GREY_CHROMA = 15  # in CIE Lab: colours with less are distinguished by lightness
MOST_COLOUR_DISTANCE = 60  # in CIE Lab, between the given colour and the road's average
LEAST_ROAD = 0.001  # share of the picture
PAPER_IS_DARK = Fault(
    "blank", "what is dark is the paper, not the road; name the road's colour: --road white"
)

NAMED_COLOURS = {  # RGB
    "black": (20, 20, 20),
    "grey": (128, 128, 128),
    "gray": (128, 128, 128),
    "white": (255, 255, 255),
    "red": (210, 30, 35),
    "orange": (240, 130, 30),
    "yellow": (245, 220, 40),
    "green": (40, 150, 60),
    "blue": (35, 70, 190),
    "purple": (125, 45, 150),
    "brown": (120, 75, 40),
    "pink": (240, 130, 170),
}


def read_picture(path: Path) -> np.ndarray:
    """The picture as BGR uint8 on white, oriented by its EXIF data, at most MOST_PX a side.

    TrackError if it is missing or unreadable, DrawingError if it is too small.
    """
    try:
        data = np.frombuffer(path.read_bytes(), np.uint8)
    except OSError as error:
        raise TrackError(f"{path}: {error.strerror}") from error
    picture = _decode(data) if data.size else None
    if picture is None:
        what = "is not a picture that can be read" if data.size else "is empty"
        raise TrackError(f"{path}: {what}; save it as PNG or JPEG")
    height, width = picture.shape[:2]
    if min(height, width) < LEAST_PX:
        size = f"{width}x{height} px"
        raise DrawingError(
            f"{path}: is too small ({size}); {LEAST_PX} px a side at least", picture
        )
    shrink = MOST_PX / max(height, width)
    if shrink < 1:
        size = (round(width * shrink), round(height * shrink))
        picture = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
    return picture


def _decode(data: np.ndarray) -> np.ndarray | None:
    try:
        picture = cv2.imdecode(data, cv2.IMREAD_UNCHANGED)
        if picture is None or picture.ndim != 3 or picture.shape[2] != 4:
            return cv2.imdecode(data, cv2.IMREAD_COLOR)  # applies a phone's orientation
    except cv2.error:
        return None
    if picture.dtype == np.uint16:
        picture = (picture // 257).astype(np.uint8)
    opaque = picture[..., 3:].astype(float) / 255
    return np.round(picture[..., :3] * opaque + 255 * (1 - opaque)).astype(np.uint8)


def parse_colour(text: str) -> tuple[int, int, int]:
    """RGB of a colour's name or #rrggbb; ValueError lists the possibilities."""
    if text.lower() in NAMED_COLOURS:
        return NAMED_COLOURS[text.lower()]
    digits = text.removeprefix("#")
    if len(digits) == 6 and text.startswith("#"):
        try:
            return tuple(bytes.fromhex(digits))
        except ValueError:
            pass
    raise ValueError(f"not a colour: {text!r}; use '#rrggbb' or one of {', '.join(NAMED_COLOURS)}")


def road_masks(picture: np.ndarray, colour: str | None) -> list[np.ndarray] | Fault:
    """Boolean masks of possible roads, the likeliest first; a Fault if there are none.

    The road is dark, or has the given colour. If there are two kinds of dark parts (ink and
    coffee), the second mask has the darker one.
    """
    if colour is None and _on_dark_ground(picture):
        return PAPER_IS_DARK
    difference = _darkness(picture) if colour is None else _likeness(picture, parse_colour(colour))
    least = 0 if colour is None else 255 - MOST_COLOUR_DISTANCE
    masks = [mask for mask in _split(difference, least) if mask.mean() >= LEAST_ROAD]
    if masks:
        return masks
    hint = "draw the road in a dark colour, or name its colour: --road red, --road '#1e90ff'"
    return Fault("blank", f"nothing {colour or 'dark'} in it; {hint}")


def surrounds_all(mask: np.ndarray) -> bool:
    """Whether it covers most of all four borders of the picture, as a background does."""
    return all(side.mean() > 0.8 for side in (mask[0], mask[-1], mask[:, 0], mask[:, -1]))


def _on_dark_ground(picture: np.ndarray) -> bool:
    grey = cv2.medianBlur(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY), 3)
    dark = grey <= _otsu(grey)
    if not MOST_DARK < dark.mean() < 1 or not surrounds_all(dark):
        return False
    return bool(grey[~dark].mean() - grey[dark].mean() >= LEAST_CONTRAST)


def _darkness(picture: np.ndarray) -> np.ndarray:
    """0 (as bright as the surrounding paper) to 255 (black): ignores shadows on a photo."""
    grey = cv2.medianBlur(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY), 3)
    small = cv2.resize(grey, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA)
    side = round(PAPER_PATCH * max(small.shape)) | 1
    paper = cv2.dilate(small, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side)))
    paper = cv2.GaussianBlur(paper, (0, 0), side / 4)
    paper = cv2.resize(paper, grey.shape[::-1], interpolation=cv2.INTER_LINEAR).astype(float)
    return np.clip(255 * (1 - grey / np.maximum(paper, 1)), 0, 255).astype(np.uint8)


def _likeness(picture: np.ndarray, colour: tuple[int, int, int]) -> np.ndarray:
    """255 (exactly this colour) minus the distance in CIE Lab.

    Lightness counts half, because pens and light vary, unless the colour is a grey.
    """
    lab = cv2.cvtColor(picture.astype(np.float32) / 255, cv2.COLOR_BGR2LAB)
    wanted = cv2.cvtColor(np.array([[colour[::-1]]], np.float32) / 255, cv2.COLOR_BGR2LAB)
    grey = np.hypot(*wanted[0, 0, 1:]) < GREY_CHROMA
    apart = (lab - wanted) * (1.0 if grey else 0.5, 1, 1)
    distance = np.sqrt((apart**2).sum(axis=2))
    return cv2.medianBlur(np.clip(255 - distance, 0, 255).astype(np.uint8), 3)


def _split(difference: np.ndarray, least: float) -> Iterator[np.ndarray]:
    """Masks by Otsu's threshold, then by another one within the first; both above `least`."""
    chosen = np.ones(difference.shape, bool)
    for contrast in (LEAST_CONTRAST, LEAST_STAIN_CONTRAST):
        threshold = _otsu(difference[chosen])
        marked, rest = chosen & (difference > threshold), chosen & (difference <= threshold)
        if not marked.any() or not rest.any():
            return
        inside, outside = difference[marked].mean(), difference[rest].mean()
        if inside - outside < contrast or inside < least:
            return
        yield marked
        chosen = marked


def _otsu(values: np.ndarray) -> float:
    threshold, _ = cv2.threshold(values.reshape(1, -1), 0, 255, cv2.THRESH_OTSU)
    return threshold
