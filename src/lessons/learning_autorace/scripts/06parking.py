#!/usr/bin/env python3
"""Lesson 6: park in the free bay, and drive on.  第六课：停进空车位，再开出来。"""

import importlib
import math

import cv2
import numpy as np
from learning_autorace.ground import WHITE

BESIDE = 0.19, 0.36  # m to the left: where the broken lines of the entrance are seen
APART = 0.25  # m between those lines
IN = 0.947  # m from the lane's middle to the bays' centres
SIDEWAYS = 0.275  # m from the entrance's middle to a bay's centre
BAY = 0.16  # m, half a bay
LOOK, PARKED = 0.5, 1.5  # s
SPEED, TURN = 0.12, 0.7  # m/s, rad/s
NEAR_PLACE, NEAR_ANGLE = 0.008, 0.02  # m, rad


def way_in(view, calibration):
    """How far ahead of the base the middle of the car park's entrance is, m; None: not seen."""
    columns = [round((calibration.half_width - y) * calibration.px_per_m) for y in BESIDE[::-1]]
    hsv = cv2.cvtColor(view[:, columns[0]:columns[1]], cv2.COLOR_BGR2HSV)
    there = cv2.inRange(hsv, *map(np.array, WHITE)).mean(axis=1) > 50
    edges = np.flatnonzero(np.diff(np.concatenate(([False], there, [False])).astype(int)))
    lines = calibration.far - edges.reshape(-1, 2).mean(axis=1) / calibration.px_per_m
    return next(((far + near) / 2 for far in lines for near in lines
                 if abs(far - near - APART) < 0.03), None)


def free_side(points):
    """1: the left bay is free, -1: the right one; the robot is between them."""
    inside = np.abs(points[:, 0]) < BAY
    left = np.sum(inside & (np.abs(points[:, 1] - SIDEWAYS) < BAY))
    right = np.sum(inside & (np.abs(points[:, 1] + SIDEWAYS) < BAY))
    return 1 if left < right else -1


class Parking:
    """A list of moves (turn to a heading, drive a distance, wait), done one by one by odometry."""

    def __init__(self, calibration):
        self.calibration = calibration
        self.moves = None  # None: the entrance was not seen yet
        self.start = None  # s, x, y at the start of the move
        self.done = False

    def step(self, seen):
        """The current move's command, or None: keep the lane."""
        if self.moves is None:
            ahead = way_in(seen.view, self.calibration)
            if ahead is None:
                return None
            self.heading = seen.pose[2]  # the lane was straight so far
            self.into = self.heading + math.pi / 2
            self.moves = [("go", ahead), ("turn", self.into), ("go", IN), ("look", LOOK)]
        if not self.moves:
            self.done = True
            return None
        kind, value = self.moves[0]
        self.start = self.start or (seen.time, *seen.pose[:2])
        command = getattr(self, kind)(seen, value)
        if command is None:
            self.moves, self.start = self.moves[1:], None
        return command or (0.0, 0.0)

    def turn(self, seen, heading):
        """Turn on the spot to a heading, rad; None: it is there."""
        self.heading, left = heading, math.remainder(heading - seen.pose[2], math.tau)
        return None if abs(left) < NEAR_ANGLE else (0.0, max(-TURN, min(TURN, 2.0 * left)))

    def go(self, seen, way):
        """Drive along the heading of the last turn, backwards if `way` is negative."""
        heading = self.heading
        x, y = seen.pose[0] - self.start[1], seen.pose[1] - self.start[2]
        cos, sin = math.cos(heading), math.sin(heading)
        left, aside = way - (cos * x + sin * y), cos * y - sin * x
        speed = max(-SPEED, min(SPEED, 1.5 * left))
        turn = 2.0 * math.remainder(heading - seen.pose[2], math.tau)
        turn -= 4.0 * aside * math.copysign(1, speed)
        return None if abs(left) < NEAR_PLACE else (speed, max(-TURN, min(TURN, turn)))

    def wait(self, seen, seconds):
        """Stand this long; None: it is over."""
        return (0.0, 0.0) if seen.time < self.start[0] + seconds else None

    def look(self, seen, seconds):
        """Wait for a scan from here, then add the moves into the free bay and back out."""
        waits = self.wait(seen, seconds)
        if not waits:
            side = free_side(seen.points) * math.pi / 2
            self.moves += [("turn", self.into + side), ("go", SIDEWAYS), ("wait", PARKED),
                            ("go", -SIDEWAYS), ("turn", self.into), ("go", -IN),
                            ("turn", self.into - math.pi / 2)]
        return waits


def main():
    lane = importlib.import_module("02lane")  # an import statement takes no name with a digit first
    lane.run("autorace_parking", [Parking])


if __name__ == "__main__":
    main()
