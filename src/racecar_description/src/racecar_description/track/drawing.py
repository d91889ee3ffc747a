"""Finds the middle line of the closed road in a drawing, in px (x right, y down), or the fault."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from racecar_description.track.errors import DrawingError, Mark, TrackError

MOST_PX, LEAST_PX = 1600, 64  # longest side after scaling; least side of a usable picture
PAPER_PATCH = 0.15  # share of the longer side: roads are narrower, shadows on paper are wider
CONTRASTS = (50, 30)  # least grey levels of 255: road to paper, road to a stain
MOST_COLOUR_DISTANCE = 60  # in CIE Lab, between the given colour and the road's average
LEAST_ROAD, LEAST_INFIELD = 0.001, 0.003  # shares of the picture; smaller parts are specks
SPUR, RAGGED = 3.0, 0.35  # half widths: reach of a side road at least; spikes at a ragged edge
NAMED_COLOURS = {  # RGB
    "black": "#141414", "grey": "#808080", "gray": "#808080", "white": "#ffffff",
    "red": "#d21e23", "orange": "#f0821e", "yellow": "#f5dc28", "green": "#28963c",
    "blue": "#2346be", "purple": "#7d2d96", "brown": "#784b28", "pink": "#f082aa"}


@dataclass(frozen=True)
class MidLine:
    """(n, 2) points along the road, in order, and the road's half width (n,) there; px."""

    points: np.ndarray
    half_width: np.ndarray


class Fault(Exception):
    """Why one way to read a drawing gives no road."""

    def __init__(self, text: str, *marks: Mark):
        super().__init__(text)
        self.marks = list(marks)


def read_picture(path: Path) -> np.ndarray:
    """The picture as BGR uint8 on white, oriented by its EXIF data, at most MOST_PX a side.

    TrackError if it is missing or unreadable, DrawingError if it is too small.
    """
    try:
        data = np.frombuffer(path.read_bytes(), np.uint8)
        picture = cv2.imdecode(data, cv2.IMREAD_UNCHANGED) if data.size else None
        if picture is not None and picture.shape[2:] == (4,):
            opaque = picture[..., 3:] / np.iinfo(picture.dtype).max
            light = picture[..., :3] * (255 / np.iinfo(picture.dtype).max)
            picture = np.round(light * opaque + 255 * (1 - opaque)).astype(np.uint8)
        elif picture is not None:
            picture = cv2.imdecode(data, cv2.IMREAD_COLOR)  # as a phone was held
    except OSError as error:
        raise TrackError(f"{path}: {error.strerror}") from error
    except cv2.error:
        picture = None
    if picture is None:
        what = "is not a picture that can be read" if data.size else "is empty"
        raise TrackError(f"{path}: {what}; save it as PNG or JPEG")
    height, width = picture.shape[:2]
    if min(height, width) < LEAST_PX:
        raise DrawingError(f"{path}: is too small ({width}x{height} px); {LEAST_PX} px a side "
                           "at least", picture)
    shrink = min(1.0, MOST_PX / max(height, width))
    size = (round(width * shrink), round(height * shrink))
    return cv2.resize(picture, size, interpolation=cv2.INTER_AREA)


def parse_colour(text: str) -> tuple[int, int, int]:
    """RGB of a colour's name or #rrggbb; ValueError lists the possibilities."""
    digits = NAMED_COLOURS.get(text.lower(), text)
    try:
        red, green, blue = bytes.fromhex(digits[1:] if digits.startswith("#") else "")
    except ValueError:
        names = ", ".join(NAMED_COLOURS)
        raise ValueError(f"not a colour: {text!r}; use '#rrggbb' or one of {names}") from None
    return red, green, blue


def find_mid_line(picture: np.ndarray, colour: str | None) -> MidLine:
    """The middle of the road, which is dark or has the given colour; Fault if there is none.

    Tried are all dark parts and the darkest of them alone (ink on a stain), each with small gaps
    closed, as it is, and with larger gaps closed. A crossing is the fault that tells most.
    """
    faults: list[Fault] = []
    for mask in _masks(picture, colour):
        largest = max(2, round(0.01 * max(mask.shape)))
        for radius in dict.fromkeys((min(max(1, round(_width(mask) / 4)), largest), 0, largest)):
            try:
                return _closed_road(cv2.morphologyEx(mask, cv2.MORPH_CLOSE, _disc(radius)))
            except Fault as fault:
                faults.append(fault)
    if not faults:
        raise Fault(f"nothing {colour or 'dark'} in it; draw the road in a dark colour, or name "
                    "its colour: --road red, --road '#1e90ff'")
    raise next((fault for fault in faults if "crosses" in str(fault)), faults[0])


def _masks(picture: np.ndarray, colour: str | None) -> Iterator[np.ndarray]:
    """0 or 1 a pixel, by Otsu's threshold, and by another one within what the first found."""
    difference = _darkness(picture) if colour is None else _likeness(picture, parse_colour(colour))
    least = 0 if colour is None else 255 - MOST_COLOUR_DISTANCE
    chosen = np.ones(difference.shape, bool)
    for contrast in CONTRASTS:
        threshold, _ = cv2.threshold(difference[chosen][None], 0, 255, cv2.THRESH_OTSU)
        marked, rest = chosen & (difference > threshold), chosen & (difference <= threshold)
        if not marked.any() or not rest.any():
            return
        inside, outside = difference[marked].mean(), difference[rest].mean()
        if inside - outside < contrast or inside < least:
            return
        if marked.mean() >= LEAST_ROAD:
            yield marked.astype(np.uint8)
        chosen = marked


def _darkness(picture: np.ndarray) -> np.ndarray:
    """0 (as bright as the paper around, whatever shadow lies there) to 255 (black)."""
    grey = cv2.medianBlur(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY), 3)
    threshold, _ = cv2.threshold(grey, 0, 255, cv2.THRESH_OTSU)
    dark = grey <= threshold
    if (dark.mean() > 0.6 and not dark.all() and _surrounds_all(dark)
            and grey[~dark].mean() - grey[dark].mean() >= CONTRASTS[0]):
        raise Fault("what is dark is the paper, not the road; name the road's colour: "
                    "--road white")
    small = cv2.resize(grey, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA)
    side = round(PAPER_PATCH * max(small.shape)) // 2
    paper = cv2.GaussianBlur(cv2.dilate(small, _disc(side)), (0, 0), max(side, 1) / 2)
    paper = cv2.resize(paper, grey.shape[::-1], interpolation=cv2.INTER_LINEAR)
    return np.clip(255 * (1 - grey / np.maximum(paper, 1.0)), 0, 255).astype(np.uint8)


def _likeness(picture: np.ndarray, colour: tuple[int, int, int]) -> np.ndarray:
    """255 (this colour) minus the distance in CIE Lab; light counts half but for greys."""
    lab = cv2.cvtColor(picture.astype(np.float32) / 255, cv2.COLOR_BGR2LAB)
    wanted = cv2.cvtColor(np.array([[colour[::-1]]], np.float32) / 255, cv2.COLOR_BGR2LAB)
    of_light = 1.0 if np.hypot(*wanted[0, 0, 1:]) < 15 else 0.5
    distance = np.linalg.norm((lab - wanted) * (of_light, 1, 1), axis=2)
    return cv2.medianBlur(np.clip(255 - distance, 0, 255).astype(np.uint8), 3)


def _closed_road(mask: np.ndarray) -> MidLine:
    """The middle of the largest part with one large hole; Fault says why there is none."""
    contours, tree = cv2.findContours(mask, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    holes: dict[int, list[np.ndarray]] = {}
    for contour, (_, _, _, parent) in zip(contours, tree[0]):
        if parent >= 0 and cv2.contourArea(contour) >= LEAST_INFIELD * mask.size:
            holes.setdefault(parent, []).append(contour)
    rings = [i for i in holes if not _surrounds_all(_filled(mask, contours[i]))]
    if not rings:
        raise _open_fault(mask, [c for c, row in zip(contours, tree[0]) if row[3] < 0])
    outer = max(rings, key=lambda i: cv2.contourArea(contours[i]))
    infields = [_filled(mask, hole, edge=False) for hole in holes[outer]]
    outside = ~_filled(mask, contours[outer])
    if len(infields) > 1:
        raise _crossing_fault([outside, *infields])
    mid_line = _mid_line(infields[0], outside)
    _check_for_side_roads(~(outside | infields[0]), mid_line)
    return mid_line


def _mid_line(infield: np.ndarray, outside: np.ndarray) -> MidLine:
    """The line midway between infield and outside: the contour of what is nearer to the infield."""
    to_infield, to_outside = _distance_to(infield), _distance_to(outside)
    ahead = cv2.GaussianBlur(to_infield - to_outside, (0, 0), 1.0)
    inner = (infield | (~outside & (to_infield < to_outside))).astype(np.uint8)
    contours, _ = cv2.findContours(inner, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    x, y = max(contours, key=cv2.contourArea).reshape(-1, 2).T
    slope = np.column_stack([cv2.Sobel(ahead, cv2.CV_32F, *axis, scale=1 / 8)[y, x]
                             for axis in ((1, 0), (0, 1))])
    step = slope * (ahead[y, x] / np.maximum((slope**2).sum(axis=1), 0.5))[:, None]
    # Both distances are to pixel centres, half a pixel beyond the road's edge.
    return MidLine(np.column_stack((x, y)) - np.clip(step, -1, 1),
                   (to_infield[y, x] + to_outside[y, x] - 1) / 2)


def _open_fault(mask: np.ndarray, outlines: list[np.ndarray]) -> Fault:
    """The ends of a stroke are where its outline turns back, two widths on to either side."""
    areas = [cv2.contourArea(outline) for outline in outlines]
    if max(areas) < LEAST_ROAD * mask.size:
        return Fault("no closed road: only specks; draw the road as one thick closed line")
    marks, reach = [], round(2 * _width(mask))
    for outline, area in sorted(zip(outlines, areas), key=lambda pair: -pair[1])[:4]:
        if area >= 0.2 * max(areas):
            around, quarter = outline[:, 0], len(outline) // 4
            across = np.hypot(*(np.roll(around, -reach, axis=0) - np.roll(around, reach, axis=0)).T)
            one = int(np.argmin(across))
            other = one + quarter + int(np.argmin(np.roll(across, -one)[quarter:-quarter]))
            marks += [Mark(*map(float, around[i % len(around)]), "open end") for i in (one, other)]
    return Fault(f"no closed road: it is open at {_places(marks)} px; join the ends", *marks)


def _crossing_fault(regions: list[np.ndarray]) -> Fault:
    """There are several infields: three regions of the outside and them meet at a crossing."""
    third = np.sort([_distance_to(region) for region in regions], axis=0)[2]
    third[np.any(regions, axis=0)] = np.inf
    marks, least = [], third.min()
    while third.min() < 1.5 * least + 2 and len(marks) < 4:
        y, x = np.unravel_index(np.argmin(third), third.shape)
        marks.append(Mark(float(x), float(y), "crossing"))
        cv2.circle(third, (int(x), int(y)), round(4 * least + 4), float("inf"), cv2.FILLED)
    return Fault(f"the road crosses itself or forks at {_places(marks)} px; draw one loop without "
                 "crossings", *marks)


def _check_for_side_roads(road: np.ndarray, mid_line: MidLine) -> None:
    """Fault where a part of the road that is no ragged edge leads away from its middle."""
    half = float(np.median(mid_line.half_width))
    solid = cv2.morphologyEx(road.astype(np.uint8), cv2.MORPH_OPEN, _disc(round(RAGGED * half)))
    line = cv2.polylines(np.zeros(road.shape, np.uint8), [mid_line.points.round().astype(int)],
                         isClosed=True, color=1)
    away = _distance_to(line > 0)
    count, labels = cv2.connectedComponents(solid & (away > 1.6 * half))
    parts = [labels == i for i in range(1, count)]
    forks = [np.argwhere(part & (away < away[part].min() + 2)).mean(axis=0)
             for part in parts if away[part].max() >= SPUR * half]
    if marks := [Mark(float(x), float(y), "fork") for y, x in forks[:4]]:
        raise Fault(f"the road forks at {_places(marks)} px; take the side road away", *marks)


def _width(mask: np.ndarray) -> float:
    """px; a long stroke's area is half its outline times its width."""
    contours, _ = cv2.findContours(mask, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    return 2.0 * mask.sum() / max(sum(cv2.arcLength(contour, True) for contour in contours), 1.0)


def _filled(mask: np.ndarray, contour: np.ndarray, edge: bool = True) -> np.ndarray:
    """What a contour encloses, with or without its own pixels."""
    filled = cv2.drawContours(np.zeros_like(mask), [contour], 0, 1, cv2.FILLED)
    return (filled if edge else cv2.drawContours(filled, [contour], 0, 0, 1)).astype(bool)


def _surrounds_all(mask: np.ndarray) -> bool:
    """Whether it covers most of all four borders of the picture, as a background does."""
    return all(side.mean() > 0.8 for side in (mask[0], mask[-1], mask[:, 0], mask[:, -1]))


def _disc(radius: int) -> np.ndarray:
    return cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1, 2 * radius + 1))


def _distance_to(region: np.ndarray) -> np.ndarray:
    """The distance of each pixel to the region, px."""
    return cv2.distanceTransform((~region).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)


def _places(marks: list[Mark]) -> str:
    return " and ".join(f"({mark.x_px:.0f}, {mark.y_px:.0f})" for mark in marks[:4])
