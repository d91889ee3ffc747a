#!/usr/bin/env python3
"""Lesson 4: wait at the level crossing until its bar opens.  第四课：栏杆放下时等待。"""

from learning_autorace.bar import Bar
from learning_autorace.course import Course
from learning_autorace.node import run

if __name__ == "__main__":
    run("autorace_bar", lambda calibration: Course(calibration, [Bar]))
