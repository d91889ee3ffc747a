"""Functions that drive, on a robot without slip and no simulator."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from learning_laser import hall

from exercises.finding import Finding, at_least, at_most, near
from exercises.program import load, numbers, part

CHASE_STEP = 0.1  # s, as in the lesson's loop
CHASE_CALL = "follow(x, y)"


def chase(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """One turtle follows another at a distance: follow(x, y).

    It must come to the given distance, stop, never be nearer, never drive backwards.
    """
    follow = part(load(file), CHASE_CALL)
    target, (x, y, yaw), apart, speed = (5.5, 5.5), (1.0, 1.0, math.pi), [], 0.0
    for _ in range(round(limits["seconds"] / CHASE_STEP)):
        way, bearing = math.hypot(target[0] - x, target[1] - y), math.atan2(target[1] - y,
                                                                          target[0] - x) - yaw
        apart.append(way)
        command = follow(way * math.cos(bearing), way * math.sin(bearing))
        speed, turn = numbers((command.linear.x, command.angular.z), 2, CHASE_CALL)
        x, y = x + CHASE_STEP * speed * math.cos(yaw), y + CHASE_STEP * speed * math.sin(yaw)
        yaw += CHASE_STEP * turn
    yield near("distance at the end", apart[-1], limits["distance"], limits["tolerance"], " m")
    yield at_least("least distance", min(apart), limits["distance"] - limits["tolerance"], " m")
    yield near("speed at the end", speed, 0.0, 0.05, " m/s")
    too_near = float(follow(limits["distance"] / 2, 0.0).linear.x)
    yield near("speed at half that distance", too_near, 0.0, 0.01, " m/s")


PULL = 0.15  # rad/s to the left, besides the command
SPEED, AHEAD, PX_PER_M = 0.3, 0.3, 2700.0  # m/s; m from the axle to the rows; px (of 1920)
RATE, LATE, SECONDS = 30, 6, 20.0  # images per second; delay in images; duration, s
SIDEWAYS = 0.1  # m to the left of the line at the start


def offsets(steer) -> np.ndarray:
    """The line's offset to the right of the image's middle, px, in each image (N,)."""
    left, heading, waiting, found = SIDEWAYS, 0.0, [0.0] * LATE, []
    for picture in range(int(SECONDS * RATE)):
        found.append(PX_PER_M * (left + AHEAD * math.sin(heading)))
        waiting.append(*numbers(steer(found[-1], picture / RATE), 1, "steer(offset_px, time)"))
        heading += (waiting.pop(0) + PULL) / RATE
        left += SPEED * math.sin(heading) / RATE
        if not abs(heading) < 1.5:  # it has turned round
            break
    return np.array(found)


def pid(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """A steering law on a robot that pulls to one side: Driver().steer(offset_px, time).

    No steady-state error (the purpose of I) and no oscillation (that of D).
    """
    seen = offsets(part(load(file), "Driver()")().steer)
    last = seen[-2 * RATE:] if len(seen) == int(SECONDS * RATE) else seen
    yield at_most("line beside the image's middle, mean of the last 2 s",
                  float(np.abs(last).mean()), limits["left_px"], " px")
    yield at_most("swing to the other side", float(max(0.0, -seen.min())), limits["swing_px"],
                  " px")


WIDTH, HEIGHT, HFOV = 640, 480, 1.3962634  # px, px, rad: as my_robot's camera
RADIUS, TALL, LENS = 0.2, 0.6, 0.25  # m: the cylinder's size, and the camera's height
RED, FLOOR, STOP_STEP = (20, 20, 200), (150, 150, 150), 0.2  # BGR, BGR, s
FOCAL = WIDTH / 2 / math.tan(HFOV / 2)  # px
STOP_CALL = "drive(picture)"


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


def stop(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """Stopping before a red cylinder: drive(picture), on drawn images, for a car without slip.

    From 4 m away, turned by 20 degrees, it must drive up and stop at the right distance.
    """
    drive = part(load(file), STOP_CALL)
    x, y, yaw, apart, speed, turn = -4.0, 0.0, math.radians(20), [], 0.0, 0.0
    for _ in range(round(limits["seconds"] / STOP_STEP)):
        bearing = math.atan2(-y, -x) - yaw
        apart.append(math.hypot(x, y))
        picture = view(apart[-1] * math.cos(bearing), apart[-1] * math.sin(bearing))
        speed, turn = numbers(drive(picture), 2, STOP_CALL)
        x, y = x + STOP_STEP * speed * math.cos(yaw), y + STOP_STEP * speed * math.sin(yaw)
        yaw += STOP_STEP * turn
    yield near("distance to the cylinder's axis at the end", apart[-1], limits["distance"],
               limits["tolerance"], " m")
    yield at_least("least distance", min(apart), limits["distance"] - limits["tolerance"], " m")
    yield near("speed at the end", speed, 0.0, 0.02, " m/s")
    degrees = math.degrees(math.remainder(bearing, 2 * math.pi))
    yield near("bearing at the end", degrees, 0.0, 5.0, "°")


HALLS_CALL = "command(angles, ranges)"


def halls(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """Driving by laser through halls with columns: command(angles, ranges).

    It must reach the finish in each hall without touching anything.
    """
    command = part(load(file), HALLS_CALL)
    drives = [hall.drive(lambda *scan: numbers(command(*scan), 2, HALLS_CALL), seed,
                         limits["seconds"]) for seed in range(round(limits["halls"]))]
    yield at_least("halls with the finish reached", sum(time is not None for time, _ in drives),
                   limits["halls"])
    yield at_least("least clearance of the robot's body", min(air for _, air in drives), 0.0, " m")
