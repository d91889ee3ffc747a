"""Finds the closed road among a mask's blots, or says why there is none."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from racecar_description.track.drawing import surrounds_all
from racecar_description.track.errors import Fault
from racecar_description.track.faults import crossing_fault, open_fault, spur_fault
from racecar_description.track.mid_line import MidLine, find_mid_line

LEAST_INFIELD = 0.003  # share of the picture; smaller holes are specks, dashes, letters
LARGEST_CLOSING = 0.01  # radius as share of the longer side: gaps of up to twice this are closed
FILLING = 0.25  # radius as share of the road's width: bright lines painted on the road are filled
@dataclass(frozen=True)
class Road:
    """A closed road: boolean masks of the road and of its infield, and its middle line."""

    road: np.ndarray
    infield: np.ndarray
    mid_line: MidLine


def find_road(masks: list[np.ndarray]) -> Road | Fault:
    """The closed road in the likeliest mask that has one; a Fault if none has."""
    faults = []
    for mask in masks:
        for radius_px in _closings(mask):
            found = _closed_road(_close(mask, radius_px))
            if isinstance(found, Road):
                return found
            faults.append(found)
    crossings = [fault for fault in faults if fault.kind == "crossing"]
    return (crossings or faults)[0]


def _closings(mask: np.ndarray) -> list[int]:
    """Radii (px) for closing gaps: first the usual one, then none, then the largest."""
    largest = max(2, round(LARGEST_CLOSING * max(mask.shape)))
    usual = int(np.clip(round(FILLING * _stroke_width(mask)), 1, largest))
    return list(dict.fromkeys((usual, 0, largest)))


def _stroke_width(mask: np.ndarray) -> float:
    """The stroke's width, px: a long stroke's area is half its outline times its width."""
    contours, _ = cv2.findContours(mask.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    outline = sum(cv2.arcLength(contour, True) for contour in contours)
    return 2.0 * float(mask.sum()) / max(outline, 1.0)


def _close(mask: np.ndarray, radius_px: int) -> np.ndarray:
    if radius_px == 0:
        return mask
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius_px + 1, 2 * radius_px + 1))
    return cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_CLOSE, disc).astype(bool)


def _closed_road(mask: np.ndarray) -> Road | Fault:
    inside = [blot for blot in _blots(mask) if not surrounds_all(blot)]  # not a table round it
    rings = [ring for ring in map(_ring, inside) if ring[1]]
    if not rings:
        return open_fault(mask)
    road, infields = max(rings, key=lambda ring: _enclosed(*ring))
    if len(infields) > 1:
        return crossing_fault(road, infields)
    found = Road(road, infields[0], find_mid_line(road, infields[0]))
    return spur_fault(found.road, found.mid_line) or found


def _blots(mask: np.ndarray) -> list[np.ndarray]:
    """The connected parts that are large enough to enclose anything, as masks."""
    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8))
    boxes = stats[:, cv2.CC_STAT_WIDTH] * stats[:, cv2.CC_STAT_HEIGHT]
    return [labels == i for i in range(1, count) if boxes[i] >= LEAST_INFIELD * mask.size]


def _ring(blot: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
    """A blot with its small holes filled, and its large holes."""
    count, labels, stats, _ = cv2.connectedComponentsWithStats(
        np.pad(~blot, 1, constant_values=True).astype(np.uint8), connectivity=4
    )
    labels = labels[1:-1, 1:-1]
    filled, infields = blot.copy(), []
    outside = labels[0, 0] if not blot[0, 0] else None
    for i in range(1, count):
        hole = labels == i
        if i == outside or _on_border(hole):
            continue
        if stats[i, cv2.CC_STAT_AREA] >= LEAST_INFIELD * blot.size:
            infields.append(hole)
        else:
            filled |= hole
    return filled, infields


def _on_border(mask: np.ndarray) -> bool:
    return bool(mask[0].any() or mask[-1].any() or mask[:, 0].any() or mask[:, -1].any())


def _enclosed(road: np.ndarray, infields: list[np.ndarray]) -> int:
    return int(road.sum()) + sum(int(infield.sum()) for infield in infields)
