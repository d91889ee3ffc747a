#!/usr/bin/env python3
"""Draws how avoid_obstacles.py evaluates a scan: images/strips.png."""

import importlib
from pathlib import Path

import cv2
import numpy as np
from learning_laser import hall

lesson = importlib.import_module("avoid_obstacles")  # beside this script
PLACE = 0.9, 0.1, 0.0  # the axle's x, y, m, and yaw, rad, in hall 0
SCALE, LEFT, TOP = 160, -0.5, 1.6  # px per metre; m, the image's upper left corner
SIZE = 960, 512  # px
WHITE, GREY, BLUE, PALE, GREEN, RED = (
    (255, 255, 255), (130, 130, 130), (200, 110, 30), (235, 210, 190), (60, 160, 60), (50, 50, 210))


def to_pixels(points):
    """(N, 2) m in the hall to px."""
    across, down = SCALE * (points[..., 0] - LEFT), SCALE * (TOP - points[..., 1])
    return np.rint(np.stack([across, down], axis=-1)).astype(int)


def strip(laser, direction, length):
    """(4, 2) m, the corners of a strip as wide as the robot."""
    ahead = np.array([np.cos(direction), np.sin(direction)])
    aside = lesson.HALF_WIDTH * np.array([-ahead[1], ahead[0]])
    return np.array([laser + aside, laser - aside, laser - aside + length * ahead,
                     laser + aside + length * ahead])


def main():
    columns, yaw = hall.columns(0), PLACE[2]
    laser = np.array(PLACE[:2]) + hall.LASER * np.array([np.cos(yaw), np.sin(yaw)])
    ranges = hall.scan(PLACE, columns)
    seen = np.isfinite(ranges)
    free = lesson.free_lengths(hall.ANGLES[seen], ranges[seen])
    best = np.argmax(free * np.cos(lesson.HEADINGS))
    picture = np.full((SIZE[1], SIZE[0], 3), WHITE, np.uint8)
    for i in range(0, len(free), 3):
        cv2.fillPoly(picture, [to_pixels(strip(laser, yaw + lesson.HEADINGS[i], free[i]))], PALE)
    for i, colour in ((len(free) // 2, RED), (best, GREEN)):
        corners = to_pixels(strip(laser, yaw + lesson.HEADINGS[i], free[i]))
        cv2.polylines(picture, [corners], True, colour, 3, cv2.LINE_AA)
    for side in (hall.WIDTH / 2, -hall.WIDTH / 2):
        ends = to_pixels(np.array([[LEFT, side], [LEFT + 9, side]]))
        cv2.line(picture, ends[0].tolist(), ends[1].tolist(), GREY, 5)
    for column in to_pixels(columns).tolist():
        cv2.circle(picture, column, round(hall.RADIUS * SCALE), GREY, -1, cv2.LINE_AA)
    turned = hall.ANGLES[seen] + yaw
    beams = laser + ranges[seen, None] * np.stack([np.cos(turned), np.sin(turned)], axis=1)
    for point in to_pixels(beams).tolist():
        cv2.circle(picture, point, 3, BLUE, -1, cv2.LINE_AA)
    cv2.circle(picture, to_pixels(laser).tolist(), 8, BLUE, -1, cv2.LINE_AA)
    path = Path(__file__).resolve().parents[1] / "images" / "strips.png"
    cv2.imwrite(str(path), picture)
    print(path)


if __name__ == "__main__":
    main()
