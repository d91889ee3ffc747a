#!/usr/bin/env python3
"""Lesson 6: park in the free bay, and drive on.  第六课：停进空车位，再开出来。"""

from learning_autorace.course import Course
from learning_autorace.node import run
from learning_autorace.parking import Parking

if __name__ == "__main__":
    run("autorace_parking", lambda calibration: Course(calibration, [Parking]))
