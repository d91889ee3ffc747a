"""Drawn pictures of a red cylinder before a grey room, as a level camera sees it."""

import math

import cv2
import numpy as np

SIZE = (240, 320)  # rows, columns
HFOV = 1.3962634   # rad
CAMERA_HEIGHT, RADIUS, HEIGHT = 0.25, 0.2, 0.6  # m
RED, ORANGE = (0, 0, 200), (0, 60, 220)  # BGR


def focal():
    """px."""
    return SIZE[1] / 2 / math.tan(HFOV / 2)


def room():
    """Nothing red in it."""
    picture = np.full((*SIZE, 3), (178, 178, 178), np.uint8)
    picture[SIZE[0] // 2:] = (110, 110, 110)
    return picture


def draw_cylinder(picture, distance, bearing, colour=RED, height=HEIGHT):
    """Add one at this distance (m, of its axis) and bearing (rad to the left)."""
    half = math.asin(RADIUS / distance)
    middle, depth = SIZE[1] / 2, (distance - RADIUS) * math.cos(bearing)
    left = middle - focal() * math.tan(bearing + half)
    right = middle - focal() * math.tan(bearing - half)
    top = SIZE[0] / 2 - focal() * (height - CAMERA_HEIGHT) / depth
    bottom = SIZE[0] / 2 + focal() * CAMERA_HEIGHT / depth
    corners = (round(left), round(top)), (round(right) - 1, round(bottom) - 1)
    cv2.rectangle(picture, *corners, colour, -1)
    return picture


def cylinder(distance, bearing, colour=RED):
    """The room with a cylinder in it."""
    return draw_cylinder(room(), distance, bearing, colour)
