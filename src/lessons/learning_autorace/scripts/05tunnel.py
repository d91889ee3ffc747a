#!/usr/bin/env python3
"""Lesson 5: drive through the tunnel by laser.  第五课：用激光雷达穿过隧道。

It has no lines: follow the wall on the right to the exit.  里面没有线，沿右墙走到出口。
"""

import importlib
import math

import numpy as np
from learning_autorace.ground import WHITE, YELLOW, find_line

WALL = 0.21  # m, wanted distance on the right
FRONT = 0.34  # m: turn left if less is free ahead
SPEED, TURN = 0.12, 0.8  # m/s, rad/s
KP, KD = 5.0, 1.5  # rad/s per m of distance, and per rad of heading to the wall
BEFORE = 4  # images without a lane before it counts as a tunnel
EXIT = 3  # images with both lines before it is over


def distance(points, towards, width=0.35):
    """The least distance, m, in a sector of `width` rad around a direction, rad to the left."""
    if not len(points):
        return math.inf
    angles = np.arctan2(points[:, 1], points[:, 0]) - towards
    near = np.abs(np.arctan2(np.sin(angles), np.cos(angles))) < width / 2
    return float(np.hypot(*points[near].T).min(initial=math.inf))


def along_wall(points):
    """Speed in m/s and turn rate in rad/s that keep the wall at WALL on the right."""
    ahead = points[(points[:, 0] > 0) & (np.abs(points[:, 1]) < 0.12), 0].min(initial=math.inf)
    if ahead < FRONT:
        return 0.0 if ahead < 0.2 else SPEED / 2, TURN
    side, before = distance(points, -math.pi / 2), distance(points, -math.pi / 4, 0.2)
    if not math.isfinite(side):
        return SPEED, 0.0
    heading = min(before, 1.0) * math.cos(math.pi / 4) - side  # > 0: away from the wall
    turn = KP * (WALL - side) - KD * heading * 2
    return SPEED, max(-TURN, min(TURN, turn))


class Tunnel:
    """From where the lane ends to where it starts again."""

    def __init__(self, calibration):
        self.calibration = calibration
        self.inside, self.count = False, 0
        self.done = False

    def step(self, seen):
        """Follow the wall, or None: keep the lane."""
        half = self.calibration.lane_width / 2
        lines = [find_line(seen.view, colour, side * half, self.calibration) is not None
                 for colour, side in ((YELLOW, 1), (WHITE, -1))]
        wall = distance(seen.points, -math.pi / 2) < 2 * WALL
        turned = all(lines) if self.inside else (not any(lines) and wall)
        self.count = self.count + 1 if turned else 0
        if self.count > (EXIT if self.inside else BEFORE):
            self.inside, self.done, self.count = not self.inside, self.inside, 0
        return along_wall(seen.points) if self.inside else None


def main():
    lane = importlib.import_module("02lane")  # an import statement takes no name with a digit first
    lane.run("autorace_tunnel", [Tunnel])


if __name__ == "__main__":
    main()
