#!/usr/bin/env python3
"""Lesson 7: all missions, from start to finish.  第七课：跑完全程。"""

import importlib

import cv2
import numpy as np
from learning_autorace.ground import rows_at

RED = (0, 150, 120), (8, 255, 255)  # hue 0..180, saturation, value: from, to
NEAR, DEEP = 0.15, 0.06  # m: where the red line is searched for
LINE = 0.15  # share of the view's width


class Finish:
    """Stops for good at the red line; never over.  在红线前停下，不再起步。"""

    done = False

    def __init__(self, calibration):
        self.calibration, self.there = calibration, False

    def step(self, seen):
        """A stop, or None: keep the lane."""
        band = seen.view[rows_at(self.calibration, NEAR, DEEP)]
        red = cv2.inRange(cv2.cvtColor(band, cv2.COLOR_BGR2HSV), *map(np.array, RED)) > 0
        self.there = self.there or red.any(axis=0).mean() > LINE
        return (0.0, 0.0) if self.there else None


def main():
    # In the course's order; each is in its lesson's file.  按赛道顺序，各在各课的文件里
    lessons = {"03traffic_light": "TrafficLight", "06parking": "Parking", "04bar": "Bar",
               "05tunnel": "Tunnel"}
    missions = [getattr(importlib.import_module(file), name) for file, name in lessons.items()]
    importlib.import_module("02lane").run("autorace_course", [*missions, Finish])


if __name__ == "__main__":
    main()
