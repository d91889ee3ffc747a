#!/usr/bin/env python3
"""Lesson 5: drive through the tunnel by laser.  第五课：用激光雷达穿过隧道。"""

from learning_autorace.course import Course
from learning_autorace.node import run
from learning_autorace.tunnel import Tunnel

if __name__ == "__main__":
    run("autorace_tunnel", lambda calibration: Course(calibration, [Tunnel]))
