"""Lesson 2: keep between the yellow line on the left and the white one on the right."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from learning_autorace.calibration import Calibration

YELLOW = (18, 90, 90), (38, 255, 255)  # hue 0..180, saturation, value: from, to
WHITE = (0, 0, 140), (180, 60, 255)
AHEAD, BAND = 0.20, 0.02  # m: where the lane is searched for, and over what depth
WIDEST = 0.10  # m: anything wider is not a line along the lane
NEAR_EXPECTED = 0.13  # m
SPEED, SLOW = 0.15, 0.06  # m/s
KP, KD = 1.0, 0.05  # gain on the arc to the aim; s
MOST_TURN = 1.5  # rad/s


@dataclass(frozen=True)
class Lane:
    """The lines' positions AHEAD of the base, m to the left; None: not seen."""

    yellow: float | None
    white: float | None

    def centre(self, width: float) -> float | None:
        """The middle between them, or half a lane beside the only one seen."""
        middles = [line + side * width / 2 for line, side in ((self.yellow, -1), (self.white, 1))
                   if line is not None]
        return sum(middles) / len(middles) if middles else None


def rows_at(calibration: Calibration, ahead: float, deep: float) -> slice:
    """The view's rows between two distances ahead."""
    top = round((calibration.far - ahead - deep / 2) * calibration.px_per_m)
    return slice(max(top, 0), top + round(deep * calibration.px_per_m))


def find_line(view: np.ndarray, colour: tuple, expected: float, calibration: Calibration
              ) -> float | None:
    """The position, m to the left, of the line of this colour that is nearest to `expected`."""
    band = view[rows_at(calibration, AHEAD, BAND)]
    hsv = cv2.cvtColor(band, cv2.COLOR_BGR2HSV)
    there = cv2.inRange(hsv, *map(np.array, colour)).mean(axis=0) > 60
    edges = np.flatnonzero(np.diff(np.concatenate(([False], there, [False])).astype(int)))
    found = []
    for begin, end in edges.reshape(-1, 2):
        middle = calibration.half_width - (begin + end) / 2 / calibration.px_per_m
        if (1 < end - begin <= WIDEST * calibration.px_per_m
                and abs(middle - expected) < NEAR_EXPECTED):
            found.append(middle)
    return min(found, key=lambda middle: abs(middle - expected), default=None)


def find_lane(view: np.ndarray, expected: float, calibration: Calibration) -> Lane:
    """Both lines of the lane whose middle is expected there, m to the left."""
    half = calibration.lane_width / 2
    return Lane(find_line(view, YELLOW, expected + half, calibration),
                find_line(view, WHITE, expected - half, calibration))


class LaneKeeper:
    """PD control on the position of the lane's middle."""

    def __init__(self, calibration: Calibration):
        self._calibration = calibration
        self.reset()

    def reset(self) -> None:
        """Forget the lane: assume that it is straight ahead."""
        self.centre, self.unseen = 0.0, 0  # m; number of images without a lane
        self._last: tuple[float, float] | None = None  # m, s

    def look(self, view: np.ndarray) -> float:
        """The lane's middle AHEAD, m to the left; the last one if it is not seen."""
        centre = find_lane(view, self.centre, self._calibration).centre(
            self._calibration.lane_width)
        self.unseen = 0 if centre is not None else self.unseen + 1
        self.centre = self.centre if centre is None else centre
        return self.centre

    def steer(self, aim: float, time: float) -> tuple[float, float]:
        """Speed in m/s and turn rate in rad/s towards an aim, m to the left, at this time in s."""
        change = 0.0
        if self._last and time > self._last[1]:
            change = (aim - self._last[0]) / (time - self._last[1])
        self._last = aim, time
        speed = SPEED if self.unseen < 5 else SLOW
        turn = speed * 2 * (KP * aim + KD * change) / (AHEAD ** 2 + aim ** 2)
        return speed, max(-MOST_TURN, min(MOST_TURN, turn))
