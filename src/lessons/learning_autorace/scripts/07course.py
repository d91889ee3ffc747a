#!/usr/bin/env python3
"""Lesson 7: all missions, from start to finish.  第七课：跑完全程。"""

from learning_autorace.bar import Bar
from learning_autorace.course import Course, Finish
from learning_autorace.node import run
from learning_autorace.parking import Parking
from learning_autorace.traffic_light import TrafficLight
from learning_autorace.tunnel import Tunnel

MISSIONS = TrafficLight, Parking, Bar, Tunnel, Finish  # in the course's order  按赛道顺序

if __name__ == "__main__":
    run("autorace_course", lambda calibration: Course(calibration, MISSIONS))
