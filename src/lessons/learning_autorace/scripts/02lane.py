#!/usr/bin/env python3
"""Lesson 2: keep the lane, yellow on the left, white on the right.  第二课：沿车道行驶。"""

from learning_autorace.course import Course
from learning_autorace.node import run

if __name__ == "__main__":
    run("autorace_lane", lambda calibration: Course(calibration, []))
