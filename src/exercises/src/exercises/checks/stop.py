"""Stopping before a red cylinder: drive(picture), on drawn images, for a car without slip."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from exercises.finding import Finding, at_least, near
from exercises.program import load, numbers, part

WIDTH, HEIGHT, HFOV = 640, 480, 1.3962634  # px, px, rad: as my_robot's camera
RADIUS, TALL, LENS = 0.2, 0.6, 0.25  # m: the cylinder's size, and the camera's height
RED, FLOOR, STEP = (20, 20, 200), (150, 150, 150), 0.2  # BGR, BGR, s
FOCAL = WIDTH / 2 / math.tan(HFOV / 2)  # px
CALL = "drive(picture)"


def view(ahead: float, left: float) -> np.ndarray:
    """The BGR image of a cylinder whose axis is `ahead`, `left` (m) of the camera."""
    picture = np.full((HEIGHT, WIDTH, 3), FLOOR, np.uint8)
    if ahead > RADIUS:
        near_side = ahead - RADIUS
        columns = WIDTH / 2 - FOCAL * (left + RADIUS * np.array([1, -1])) / ahead
        rows = HEIGHT / 2 - FOCAL * (np.array([TALL, 0.0]) - LENS) / near_side
        (first, last), (top, bottom) = (np.rint(np.maximum(each, 0)).astype(int)
                                        for each in (columns, rows))
        picture[top:bottom, first:last] = RED
    return picture


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """From 4 m away, turned by 20 degrees, it must drive up and stop at the right distance."""
    drive = part(load(file), CALL)
    x, y, yaw, apart, speed, turn = -4.0, 0.0, math.radians(20), [], 0.0, 0.0
    for _ in range(round(limits["seconds"] / STEP)):
        bearing = math.atan2(-y, -x) - yaw
        apart.append(math.hypot(x, y))
        picture = view(apart[-1] * math.cos(bearing), apart[-1] * math.sin(bearing))
        speed, turn = numbers(drive(picture), 2, CALL)
        x, y = x + STEP * speed * math.cos(yaw), y + STEP * speed * math.sin(yaw)
        yaw += STEP * turn
    yield near("distance to the cylinder's axis at the end", apart[-1], limits["distance"],
               limits["tolerance"], " m")
    yield at_least("least distance", min(apart), limits["distance"] - limits["tolerance"], " m")
    yield near("speed at the end", speed, 0.0, 0.02, " m/s")
    degrees = math.degrees(math.remainder(bearing, 2 * math.pi))
    yield near("bearing at the end", degrees, 0.0, 5.0, "°")
