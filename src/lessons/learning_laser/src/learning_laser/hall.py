"""A hall with columns, generated from a seed: every gap is wide enough for the waffle."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

LENGTH, WIDTH = 10.0, 3.0  # m; it begins 1 m behind the start, and its middle is the start's x axis
FINISH = 8.0  # m along the hall
FIRST, LAST = 1.2, 7.2  # m along the hall, of the columns' centres
RADIUS, HEIGHT, WALL = 0.15, 0.5, 0.1  # m
GAP = 0.7  # m of space between two columns, and between a column and a wall
COLUMNS, TRIES = 12, 500
LASER, SEES = -0.064, 3.5  # m: the waffle's laser ahead of its axle; its range
ANGLES = np.radians(np.arange(360.0))  # rad, of its beams
PERIOD, CLEAR = 0.2, 0.21  # s between scans; m, radius of the circle round the waffle's body


def columns(seed: int) -> np.ndarray:
    """(N, 2) m, the centres of the hall's columns; the same for the same seed."""
    random = np.random.default_rng(seed)
    side = WIDTH / 2 - RADIUS - GAP
    found: list[np.ndarray] = []
    for place in random.uniform((FIRST, -side), (LAST, side), (TRIES, 2)):
        if len(found) < COLUMNS and all(
                np.hypot(*(place - other)) >= 2 * RADIUS + GAP for other in found):
            found.append(place)
    return np.array(found)


def scan(pose: tuple[float, float, float], columns: np.ndarray) -> np.ndarray:
    """(360,) m: the laser's ranges with the axle at x, y (m), yaw (rad); inf beyond SEES."""
    x, y, yaw = pose
    x, y = x + LASER * np.cos(yaw), y + LASER * np.sin(yaw)
    rays = np.stack([np.cos(ANGLES + yaw), np.sin(ANGLES + yaw)], axis=1)
    to = columns - (x, y)
    along = rays @ to.T
    inside = RADIUS**2 - (to**2).sum(axis=1) + along**2
    hits = np.where((inside > 0) & (along > 0), along - np.sqrt(np.maximum(inside, 0)), np.inf)
    with np.errstate(divide="ignore", invalid="ignore"):  # beams along a wall
        sides = (np.sign(rays[:, 1]) * WIDTH / 2 - y) / rays[:, 1]
        ends = (np.where(rays[:, 0] > 0, LENGTH - 1, -1.0) - x) / rays[:, 0]
    ranges = np.fmin(hits.min(axis=1, initial=np.inf), np.fmin(sides, ends))
    return np.where(ranges < SEES, ranges, np.inf)


def drive(command: Callable[[np.ndarray, np.ndarray], tuple[float, float]], seed: int,
          limit: float) -> tuple[float | None, float]:
    """Drives a robot without slip through hall `seed` by command(angles, ranges) -> m/s, rad/s.

    Returns the time (s) to the finish, None if it exceeds `limit`, and the least clearance (m).
    """
    places, pose, least = columns(seed), (0.0, 0.0, 0.0), math.inf
    for step in range(round(limit / PERIOD)):
        ranges = scan(pose, places)
        seen = np.isfinite(ranges)
        speed, turn = command(ANGLES[seen], ranges[seen])
        x, y, yaw = pose
        pose = (x + PERIOD * speed * math.cos(yaw), y + PERIOD * speed * math.sin(yaw),
                yaw + PERIOD * turn)
        middle = np.array([x + LASER * math.cos(yaw), y + LASER * math.sin(yaw)])
        least = min(least, WIDTH / 2 - abs(middle[1]) - CLEAR,
                    np.hypot(*(places - middle).T).min() - RADIUS - CLEAR)
        if pose[0] > FINISH:
            return step * PERIOD, least
    return None, least


def world(seed: int) -> str:
    """The text of the hall's world file."""
    end, middle, half = LENGTH - 1, LENGTH / 2 - 1, (WIDTH + WALL) / 2
    walls = [(middle, half, LENGTH, WALL), (middle, -half, LENGTH, WALL),
             (-1 - WALL / 2, 0, WALL, WIDTH), (end + WALL / 2, 0, WALL, WIDTH)]
    boxes = "".join(
        _part(f"wall_{number}", x, y, f"<box><size>{long:g} {wide:g} {HEIGHT}</size></box>")
        for number, (x, y, long, wide) in enumerate(walls))
    shape = f"<cylinder><radius>{RADIUS}</radius><length>{HEIGHT}</length></cylinder>"
    rounds = "".join(_part(f"column_{number}", x, y, shape)
                     for number, (x, y) in enumerate(columns(seed)))
    return ('<?xml version="1.0"?>\n'
            f"<!-- Made by: rosrun learning_laser make_hall.py {seed} -->\n"
            '<sdf version="1.6">\n<world name="default">\n'
            "<scene><shadows>0</shadows></scene>\n"
            "<include><uri>model://sun</uri></include>\n"
            "<include><uri>model://ground_plane</uri></include>\n"
            f'<model name="hall">\n<static>true</static>\n<link name="hall">\n{boxes}{rounds}'
            "</link>\n</model>\n</world>\n</sdf>\n")


def _part(name: str, x: float, y: float, shape: str) -> str:
    pose = f"<pose>{x:.3f} {y:.3f} {HEIGHT / 2} 0 0 0</pose><geometry>{shape}</geometry>"
    return f'<collision name="{name}">{pose}</collision>\n<visual name="{name}">{pose}</visual>\n'
