#!/usr/bin/env python3
"""Lesson 3: stop at red and yellow, go at green.  第三课：红灯停，绿灯行。"""

from learning_autorace.course import Course
from learning_autorace.node import run
from learning_autorace.traffic_light import TrafficLight

if __name__ == "__main__":
    run("autorace_traffic_light", lambda calibration: Course(calibration, [TrafficLight]))
