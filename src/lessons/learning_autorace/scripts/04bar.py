#!/usr/bin/env python3
"""Lesson 4: wait at the level crossing until its bar opens.  第四课：栏杆放下时等待。"""

import importlib
import math

import cv2
import numpy as np
from learning_autorace.ground import to_pixel

RED = (0, 150, 16), (6, 255, 255)  # hue 0..180, saturation, value: from, to; it may be in shade
LONG = 0.12  # m, length of the bar's red part
LYING = 1.8  # width / height, at least
STOP = 0.35  # m from the camera
PASSED = 0.6  # m, driven since the bar was last seen


def bar_distance(image, calibration):
    """Distance of a closed bar from the camera, m; None: there is none."""
    height, width = image.shape[:2]
    columns, rows = to_pixel(np.ones(4), np.array([0.6, -0.6, 0.0, 0.0]),
                             np.array([0.0, 0.0, 0.25, -0.25]), width, height, calibration)
    left, right, top, bottom = (max(int(each), 0) for each in (*columns[:2], *rows[2:]))
    part = image[top:bottom, left:right]
    if not part.size:
        return None
    hsv = cv2.cvtColor(part, cv2.COLOR_BGR2HSV)
    found = []
    for _, _, wide, high, area in cv2.connectedComponentsWithStats(cv2.inRange(hsv, *RED))[2][1:]:
        if wide > LYING * high and area > 0.5 * wide * high and wide > width / 50:
            rad = wide * 2 / width * calibration.divisor * math.tan(
                calibration.hfov / 2 / calibration.divisor)  # near the middle of the image
            found.append(LONG / rad)
    return min(found, default=None)


class Bar:
    """Stops at a closed bar; over when the robot has driven on for PASSED without seeing one."""

    def __init__(self, calibration):
        self.calibration = calibration
        self.last = None  # where the robot stopped at it
        self.done = False

    def step(self, seen):
        """A stop, or None: keep the lane."""
        distance = bar_distance(seen.image, self.calibration)
        if distance is not None and distance < STOP:
            self.last = seen.pose[:2]
            return 0.0, 0.0
        self.done = self.last is not None and math.dist(self.last, seen.pose[:2]) > PASSED
        return None


def main():
    lane = importlib.import_module("02lane")  # an import statement takes no name with a digit first
    lane.run("autorace_bar", [Bar])


if __name__ == "__main__":
    main()
