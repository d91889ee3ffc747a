"""The whole course: one mission after another, and lane keeping in between."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np

from learning_autorace.barriers import between
from learning_autorace.calibration import Calibration
from learning_autorace.lane import LaneKeeper, rows_at

RED = (0, 150, 120), (8, 255, 255)  # hue 0..180, saturation, value: from, to
NEAR, DEEP = 0.15, 0.06  # m: where the red line is searched for
LINE = 0.15  # share of the view's width


class Finish:
    """Stops for good at the red line; never over."""

    name, done = "finish", False

    def __init__(self, calibration: Calibration):
        self._calibration, self._there = calibration, False

    def step(self, seen) -> tuple[float, float] | None:
        """A stop, or None: keep the lane."""
        band = seen.view[rows_at(self._calibration, NEAR, DEEP)]
        red = cv2.inRange(cv2.cvtColor(band, cv2.COLOR_BGR2HSV), *map(np.array, RED)) > 0
        self._there = self._there or red.any(axis=0).mean() > LINE
        return (0.0, 0.0) if self._there else None


class Course:
    """A list of missions. The first one commands, or the second, in case the first has nothing to
    do, such as an open bar. If neither commands, the robot keeps the lane."""

    def __init__(self, calibration: Calibration, missions: Sequence[type]):
        self._missions = [mission(calibration) for mission in missions]
        self._lane = LaneKeeper(calibration)

    @property
    def mission(self) -> str:
        """The name of the current or next mission; "lane" if none is left."""
        return self._missions[0].name if self._missions else "lane"

    def __call__(self, seen) -> tuple[float, float]:
        """Speed in m/s and turn rate in rad/s."""
        command = None
        for number, mission in enumerate(self._missions[:2]):
            command = mission.step(seen)
            if command is not None:
                self._missions = self._missions[number:]
                break
        self._missions = [each for each in self._missions if not each.done]
        if command and any(command):
            self._lane.reset()  # afterwards the robot is elsewhere
        aim = between(self._lane.look(seen.view), seen.points)
        return command or self._lane.steer(aim, seen.time)
