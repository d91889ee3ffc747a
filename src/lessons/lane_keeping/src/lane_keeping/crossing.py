"""Zebra crossings: the bars and the people on them, found in the image, and the speed limit there.

A person counts as crossing within the lines and up to `kerb` beside them, and as waiting up to
`waiting` beside them. Once the front is over the zebra's edge, only those between the lines count:
people on the kerb wait until the robot has passed.

Road, lines and zebra have no colour, lawn and trees are green or brown; any other strong colour is
clothing. Only the part below the horizon is searched for it: on flat ground that is what is below
the lens's height, people's legs.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np

from lane_keeping.road_view import RoadView
from lane_keeping.settings import Settings

NEAR, FAR, ASIDE = 0.45, 2.7, 0.7  # m covered by the view: ahead of the axle, and to either side
PX_PER_M = 80
NARROWEST_BAR, WIDEST_BAR = 0.05, 0.2  # m
LEAST_LENGTH = 0.2  # m, of a bar and of a crossing
CONTRAST = 0.15  # least share by which a bar is brighter than the road
LEAST_BARS = 3  # side by side


@dataclass(frozen=True)
class Zebra:
    """Where a crossing starts and ends, in m ahead of the axle."""

    near: float
    far: float

    @property
    def reaches_robot(self) -> bool:
        """Whether it starts at the view's near end: then its near edge was not seen."""
        return self.near < NEAR + 2 / PX_PER_M


def from_above(grey: np.ndarray, view: RoadView) -> np.ndarray | None:
    """The road's brightness seen from above, far rows first, left columns first.

    grey: (h, w) uint8, the whole image. NEAR, FAR, ASIDE and PX_PER_M define the view. None if the
    camera cannot see it.
    """
    size = (round(2 * ASIDE * PX_PER_M), round((FAR - NEAR) * PX_PER_M))
    ground = np.array([[FAR, ASIDE], [FAR, -ASIDE], [NEAR, ASIDE], [NEAR, -ASIDE]])
    there = np.array([[0, 0], [size[0], 0], [0, size[1]], size], np.float32)
    here = view.to_picture(ground).astype(np.float32)
    if not np.isfinite(here).all():
        return None
    turn = cv2.getPerspectiveTransform(here, there)
    return cv2.warpPerspective(grey, turn, size, borderMode=cv2.BORDER_REPLICATE)


def bars(road: np.ndarray) -> np.ndarray:
    """255 where the road is brighter than beside it, in strips along the road."""
    across = np.ones((1, round(WIDEST_BAR * PX_PER_M)), np.uint8)
    level = cv2.morphologyEx(road, cv2.MORPH_OPEN, across)
    mask = cv2.compare(road, cv2.convertScaleAbs(level, alpha=1 + CONTRAST, beta=4), cv2.CMP_GT)
    smallest = np.ones((round(LEAST_LENGTH * PX_PER_M), round(NARROWEST_BAR * PX_PER_M)), np.uint8)
    return cv2.morphologyEx(mask, cv2.MORPH_OPEN, smallest)


def find_zebra(grey: np.ndarray, view: RoadView) -> Zebra | None:
    """The nearest crossing ahead, or None."""
    road = from_above(grey, view)
    if road is None:
        return None
    mask = bars(road) > 0
    begins = mask & ~np.pad(mask, ((0, 0), (1, 0)))[:, :-1]
    striped = np.count_nonzero(begins, axis=1) >= LEAST_BARS
    edges = np.flatnonzero(np.diff(np.concatenate([[0], striped, [0]])))
    least = LEAST_LENGTH * PX_PER_M
    runs = [(a, b) for a, b in zip(edges[::2], edges[1::2]) if b - a >= least]
    if not runs:
        return None
    begin, end = runs[-1]
    return Zebra(near=FAR - end / PX_PER_M, far=FAR - begin / PX_PER_M)


SHRINK = 2  # only every second pixel is used
SATURATION, VALUE = 110, 35  # of 255, at least
BROWN_TO_GREEN = (8, 90)  # OpenCV's hue, 0..180: lawn, leaves, trunks
BROWN_VALUE = 140  # brighter and not green is orange or yellow, not brown
GREEN_HUE = 32
LEAST_HEIGHT, LEAST_WIDTH = 0.2, 0.05  # m
FARTHEST = 4.0  # m


def clothing(image: np.ndarray) -> np.ndarray:
    """(h, w, 3) BGR to a mask: 255 where the colour is strong and neither green nor brown."""
    hue, saturation, value = cv2.split(cv2.cvtColor(image, cv2.COLOR_BGR2HSV))
    natural = (hue >= BROWN_TO_GREEN[0]) & (hue <= BROWN_TO_GREEN[1])
    natural &= (value < BROWN_VALUE) | (hue >= GREEN_HUE)
    strong = (saturation >= SATURATION) & (value >= VALUE)
    return np.where(strong & ~natural, 255, 0).astype(np.uint8)


def find_people(image: np.ndarray, view: RoadView) -> np.ndarray:
    """(n, 2) m on the ground (ahead, left): the feet of all people in the BGR image."""
    horizon = max(round(view.horizon), 0)
    if horizon >= len(image):
        return np.empty((0, 2))
    below = np.ascontiguousarray(image[horizon::SHRINK, ::SHRINK])
    mask = cv2.morphologyEx(clothing(below), cv2.MORPH_CLOSE, np.ones((3, 3), np.uint8))
    count, _, boxes, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
    feet = [_feet(box, horizon - view.top, view) for box in boxes[1:count]]
    return np.array([one for one in feet if one is not None]).reshape(-1, 2)


def _feet(box: np.ndarray, horizon: int, view: RoadView) -> np.ndarray | None:
    """Where a blob stands, if it is upright and large enough to be a person; else None.

    box: left, top, width, height, area in px of the shrunken image; horizon: row in the region.
    """
    left, top, width, height = (box[:4] * SHRINK).astype(float)
    foot = np.array([left + width / 2, horizon + top + height])
    ground = view.to_ground(foot)
    away = ground[0] - view.forward
    if not 0 < away < FARTHEST:
        return None
    metres_a_px = np.hypot(away, view.lens_height) / view.focal
    if height * metres_a_px < LEAST_HEIGHT or width * metres_a_px < LEAST_WIDTH:
        return None
    return ground


MEMORY = 1.0  # s for which an unseen zebra is remembered, e.g. if hidden by a person's legs
AT_ZEBRA = 0.3  # m before and behind a zebra that still belong to it
BODY = 0.12  # m, half a person's width
SIGHT_WITHOUT_ZEBRA = 1.5  # m ahead of the axle
STANDING = 0.02  # m from the stopping point that is near enough


class Crossing:
    """Remembers the zebra ahead and when somebody was last on it; call it for each image."""

    def __init__(self, settings: Settings):
        self.settings = settings
        self._forget()

    def _forget(self) -> None:
        self.zebra: Zebra | None = None
        self._stamp = self._zebra_seen = self._person_seen = -math.inf  # s
        self._limit = math.inf

    def limit(
        self,
        zebra: Zebra | None,
        people: np.ndarray,
        lane_left: Callable[[float], float],
        stamp: float,
        speed: float,
    ) -> float:
        """The speed limit in m/s; infinite if there is nobody.

        people: (n, 2) m, ahead and left; lane_left: how far left the lane's centre line is (m), by
        distance ahead (m); speed: m/s driven since the last image.
        """
        self._remember(zebra, stamp, speed)
        crossing, slow = self._look_at(people, lane_left)
        if crossing < math.inf:
            self._person_seen = stamp
            self._limit = self._approach(crossing)
        elif stamp - self._person_seen > self.settings.clear_time:
            self._limit = math.inf
        return min(self._limit, slow)

    @property
    def occupied(self) -> bool:
        """Whether somebody is on the crossing ahead."""
        return self._limit < math.inf

    def _remember(self, zebra: Zebra | None, stamp: float, speed: float) -> None:
        if stamp < self._stamp:  # a simulation was reset
            self._forget()
        before, self._stamp = self._stamp, stamp
        if self.zebra is not None:
            way = speed * (stamp - before)
            self.zebra = Zebra(self.zebra.near - way, self.zebra.far - way)
        if zebra is not None:
            if zebra.reaches_robot and self.zebra is not None:  # its near edge is below the image
                zebra = Zebra(min(self.zebra.near, zebra.near), zebra.far)
            self.zebra, self._zebra_seen = zebra, stamp
        elif self.zebra is not None:
            behind = self.zebra.far < -AT_ZEBRA
            if behind or stamp - self._zebra_seen > MEMORY:
                self.zebra = None

    def _look_at(
        self, people: np.ndarray, lane_left: Callable[[float], float]
    ) -> tuple[float, float]:
        """Metres to the stopping point (infinite: none), and the speed past people waiting."""
        settings, half = self.settings, self.settings.lane_width / 2
        stand, slow = math.inf, math.inf
        for ahead, left in people:
            aside = abs(left - lane_left(ahead))
            if self._at_zebra(ahead):
                to_edge = self.zebra.near - settings.robot_front
                if aside <= half + (settings.kerb if to_edge > 0 else BODY):
                    stand = min(stand, to_edge - settings.zebra_gap)
                elif aside <= half + settings.waiting:
                    slow = settings.waiting_speed
            elif ahead < SIGHT_WITHOUT_ZEBRA and aside <= half + BODY:
                stand = min(stand, ahead - settings.robot_front - settings.person_gap)
        return stand, slow

    def _at_zebra(self, ahead: float) -> bool:
        zebra = self.zebra
        return zebra is not None and zebra.near - AT_ZEBRA < ahead < zebra.far + AT_ZEBRA

    def _approach(self, way: float) -> float:
        """The speed from which the robot can brake to a stop within `way`, m."""
        return math.sqrt(2 * self.settings.braking * way) if way > STANDING else 0.0
