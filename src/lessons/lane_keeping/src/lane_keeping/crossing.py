"""Limits the speed at a zebra crossing: stops for people who are on it or step onto it.

A person counts as crossing within the lines and up to `kerb` beside them, and as waiting up to
`waiting` beside them. Once the front is over the zebra's edge, only those between the lines count:
people on the kerb wait until the robot has passed.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from lane_keeping.settings import Settings
from lane_keeping.zebra import Zebra

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
