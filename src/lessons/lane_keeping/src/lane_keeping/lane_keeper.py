"""Keeps the lane, image by image: detects, decides, and names the state."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import cv2
import numpy as np

from lane_keeping.binarise import line_mask
from lane_keeping.crossing import Crossing, Zebra, find_people, find_zebra
from lane_keeping.image_watch import FrozenWatch, is_blank
from lane_keeping.lane import Plan
from lane_keeping.methods import method_called
from lane_keeping.road_view import RoadView, road_view
from lane_keeping.settings import Settings

LANE, PERSON, LOST, SEARCHING, STOPPED, BLANK, FROZEN = (
    "lane", "person", "lost", "searching", "stopped", "blank image", "frozen image",
)


@dataclass(frozen=True)
class Decision:
    """The command for one image, and the reasons."""

    state: str
    speed: float = 0.0  # m/s
    turn: float = 0.0  # rad/s, left positive
    plan: Plan | None = None
    view: RoadView | None = None
    zebra: Zebra | None = None
    people: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))  # m, ahead and left


class LaneKeeper:
    """Keeps the state between images: the last plan, the crossing ahead, the last image."""

    def __init__(self, settings: Settings):
        self.settings = settings
        self._find = method_called(settings.method)
        self._crossing = Crossing(settings)
        self._frozen = FrozenWatch(settings.frozen_time)
        self._plan: Plan | None = None
        self._planned = -math.inf  # s, when it was made
        self.last = Decision(STOPPED)

    def step(self, image: np.ndarray, stamp: float, now: float | None = None) -> Decision:
        """The decision for a BGR image (h, w, 3) uint8.

        stamp: s, when it was taken; now: s, when it came, for a camera whose stamps do not advance.
        """
        stamp = stamp or now or 0.0  # 0: the camera sets no stamp
        moving = self.last.speed != 0 or self.last.turn != 0
        if is_blank(image, self.settings.blank_contrast):
            self.last = Decision(BLANK)
        elif self._frozen.see(image, stamp if now is None else now, moving):
            self.last = Decision(FROZEN)
        else:
            self.last = self._drive(image, stamp)
        return self.last

    def stand(self) -> None:
        """The robot was stopped from outside."""
        self.last = Decision(STOPPED)

    def _drive(self, image: np.ndarray, stamp: float) -> Decision:
        view = road_view(self.settings, image.shape[1], image.shape[0])
        found = self._find(line_mask(image, self.settings), view, self.settings)
        if found is not None or stamp < self._planned:
            self._plan, self._planned = found, stamp
        zebra = find_zebra(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY), view)
        people = find_people(image, view)
        limit = self._crossing.limit(
            zebra, people, _lane_left(self._plan, view), stamp, self.last.speed
        )
        state, speed, turn = self._follow(stamp, found is not None)
        if state == LANE and self._crossing.occupied:
            state = PERSON
        if limit < speed:
            speed, turn = limit, turn * (limit / speed)
        return Decision(state, speed, turn, found, view, self._crossing.zebra, people)

    def _follow(self, stamp: float, fresh: bool) -> tuple[str, float, float]:
        """State, speed and turn rate for the last plan; `fresh`: it is from this image."""
        settings, plan, age = self.settings, self._plan, stamp - self._planned
        if fresh:
            return LANE, plan.speed, plan.turn
        too_long = age > settings.lost_time + settings.search_time
        if plan is None or too_long or age == 0:  # 0: stamps do not advance
            return STOPPED, 0.0, 0.0
        if age <= settings.lost_time:
            return LOST, min(plan.speed, settings.bend_speed), plan.turn
        return SEARCHING, 0.0, math.copysign(settings.search_turn, -plan.error)


def _lane_left(plan: Plan | None, view: RoadView):
    """How far left of the robot's axis the lane's centre is, m, by distance ahead, m."""
    if plan is None:
        return lambda ahead: 0.0
    curve, row = plan.lane.centre.curve, plan.target[1]
    rows = np.array([max(plan.lane.centre.rows[0], view.rows * 0.1), row])
    far, near = view.to_ground(np.stack([np.polyval(curve, rows), rows], axis=1))
    slope = (far[1] - near[1]) / max(far[0] - near[0], 0.1)
    return lambda ahead: near[1] + slope * (ahead - near[0])
