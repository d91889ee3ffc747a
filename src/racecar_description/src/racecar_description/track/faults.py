"""Finds why a blot is not one closed road: open ends, a crossing, or a side road."""

from __future__ import annotations

import cv2
import numpy as np

from racecar_description.track.errors import Fault, Mark
from racecar_description.track.mid_line import MidLine

COARSE_PX = 240  # longer side of the scaled picture in which paths along the road are searched
SPUR = 3.0  # half widths from the road's middle that a side road reaches at least
RAGGED = 0.35  # half widths: thinner spikes at the edge are not side roads


def open_fault(mask: np.ndarray) -> Fault:
    """There is no ring: marks both ends of each large part."""
    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8))
    areas = stats[1:, cv2.CC_STAT_AREA]
    if count == 1 or areas.max() < 0.001 * mask.size:
        return Fault("open", "no closed road: only specks; draw the road as one thick closed line")
    large = [i + 1 for i in np.argsort(-areas)[:4] if areas[i] >= 0.2 * areas.max()]
    ends = [end for i in large for end in _far_ends(labels == i)]
    marks = tuple(Mark(x, y, "open end") for x, y in ends)
    places = " and ".join(f"({x:.0f}, {y:.0f})" for x, y in ends[:4])
    return Fault("open", f"no closed road: it is open at {places} px; join the ends", marks)


def _far_ends(blot: np.ndarray) -> list[tuple[float, float]]:
    """The two points of a blot that are farthest apart along it (x, y in px)."""
    shrink = min(1.0, COARSE_PX / max(blot.shape))
    size = [max(1, round(side * shrink)) for side in blot.shape[::-1]]
    coarse = cv2.resize(blot.astype(np.float32), size, interpolation=cv2.INTER_AREA) > 0.2
    seed = np.argwhere(coarse)[0] if coarse.any() else np.array([0, 0])
    first = _farthest(coarse, seed)
    second = _farthest(coarse, first)
    scale = np.array(blot.shape) / coarse.shape
    return [tuple(((end + 0.5) * scale - 0.5)[::-1]) for end in (first, second)]


def _farthest(mask: np.ndarray, start: np.ndarray) -> np.ndarray:
    """The pixel (row, column) that a flood fill from `start` reaches last."""
    reached = np.zeros(mask.shape, np.uint8)
    reached[tuple(start)] = 1
    allowed, last = mask.astype(np.uint8), np.asarray(start)
    square = np.ones((3, 3), np.uint8)
    while True:
        grown = cv2.dilate(reached, square) & allowed
        new = np.argwhere(grown > reached)
        if not len(new):
            return last
        last = new[np.argmin(((new - new.mean(axis=0)) ** 2).sum(axis=1))]
        reached = grown


def crossing_fault(road: np.ndarray, infields: list[np.ndarray]) -> Fault:
    """There are two or more infields: marks where three regions are nearest to each other."""
    outside = ~road
    for infield in infields:
        outside &= ~infield
    distances = np.array([_distance_to(region) for region in (outside, *infields)])
    third = np.sort(distances, axis=0)[2]
    third[~road] = np.inf
    marks = []
    least = third.min()
    while third.min() < 1.5 * least + 2 and len(marks) < 4:
        y, x = np.unravel_index(np.argmin(third), third.shape)
        marks.append(Mark(float(x), float(y), "crossing"))
        rows, columns = np.ogrid[: road.shape[0], : road.shape[1]]
        third[(rows - y) ** 2 + (columns - x) ** 2 < (4 * least + 4) ** 2] = np.inf
    places = " and ".join(f"({mark.x_px:.0f}, {mark.y_px:.0f})" for mark in marks)
    text = f"the road crosses itself or forks at {places} px; draw one loop without crossings"
    return Fault("crossing", text, tuple(marks))


def spur_fault(road: np.ndarray, mid_line: MidLine) -> Fault | None:
    """A dead-end side road: marks where it leaves the road; None if there is none."""
    half = float(np.median(mid_line.half_width))
    radius = max(1, round(RAGGED * half))
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1, 2 * radius + 1))
    solid = cv2.morphologyEx(road.astype(np.uint8), cv2.MORPH_OPEN, disc).astype(bool)
    line = np.zeros(road.shape, bool)
    columns, rows = np.round(mid_line.points).astype(int).T
    line[rows.clip(0, road.shape[0] - 1), columns.clip(0, road.shape[1] - 1)] = True
    away = _distance_to(line)
    count, labels = cv2.connectedComponents((solid & (away > 1.6 * half)).astype(np.uint8))
    marks = []
    for i in range(1, count):
        part = labels == i
        if away[part].max() >= SPUR * half:
            y, x = np.argwhere(part & (away < away[part].min() + 2)).mean(axis=0)
            marks.append(Mark(float(x), float(y), "fork"))
    if not marks:
        return None
    places = " and ".join(f"({mark.x_px:.0f}, {mark.y_px:.0f})" for mark in marks[:4])
    text = f"the road forks at {places} px; take the side road away"
    return Fault("crossing", text, tuple(marks[:4]))


def _distance_to(region: np.ndarray) -> np.ndarray:
    """The distance of each pixel to the region, px."""
    if not region.any():
        return np.full(region.shape, np.inf, np.float32)
    return cv2.distanceTransform((~region).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
