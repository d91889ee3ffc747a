#!/usr/bin/env python3
"""Lesson 3: stop at red and yellow, go at green.  第三课：红灯停，绿灯行。"""

import importlib
import math

import cv2
import numpy as np
from learning_autorace.ground import to_pixel

# A lit lamp: hue 0..180 from, to; its colour is the brightest and most saturated of all.
HUES = {"red": (0, 6), "yellow": (25, 35), "green": (50, 70)}
LEAST = 200, 200  # saturation, value
LEAST_AREA = 60  # px of an image 320 px wide: the light is nearer than 0.8 m
ROUND = 0.6, 1.6  # width / height
LEFT, RIGHT = math.radians(60), math.radians(10)  # beside the lane, ahead of the robot
HIGHEST, LOWEST = math.radians(55), math.radians(20)  # above and below the horizon


def window(width, height, calibration):
    """Rows and columns of the image that can show a light that is still ahead."""
    forward, left, up = np.cos([LEFT, RIGHT, HIGHEST, LOWEST]), np.zeros(4), np.zeros(4)
    left[:2] = math.sin(LEFT), -math.sin(RIGHT)
    up[2:] = math.sin(HIGHEST), -math.sin(LOWEST)
    columns, rows = to_pixel(forward, left, up, width, height, calibration)
    return slice(max(int(rows[2]), 0), int(rows[3])), slice(int(columns[0]), int(columns[1]))


def lit_lamp(image, calibration):
    """The largest round blob of a lamp's colour: red, yellow, green, or None."""
    hsv = cv2.cvtColor(image[window(image.shape[1], image.shape[0], calibration)],
                       cv2.COLOR_BGR2HSV)
    least_area = LEAST_AREA * (image.shape[1] / 320) ** 2
    found = {}
    for colour, (low, high) in HUES.items():
        mask = cv2.inRange(hsv, (low, *LEAST), (high, 255, 255))
        for _, _, width, height, area in cv2.connectedComponentsWithStats(mask)[2][1:]:
            if area > least_area and ROUND[0] < width / height < ROUND[1]:
                found[colour] = max(area, found.get(colour, 0))
    return max(found, key=found.get, default=None)


class TrafficLight:
    """Stops the robot while red or yellow is lit; over once green was seen and passed."""

    def __init__(self, calibration):
        self.calibration, self.green = calibration, False
        self.done = False

    def step(self, seen):
        """A stop, or None: keep the lane."""
        lamp = lit_lamp(seen.image, self.calibration)
        self.done = self.green and lamp is None
        self.green = lamp == "green" or (self.green and lamp is None)
        return (0.0, 0.0) if lamp in ("red", "yellow") else None


def main():
    lane = importlib.import_module("02lane")  # an import statement takes no name with a digit first
    lane.run("autorace_traffic_light", [TrafficLight])


if __name__ == "__main__":
    main()
