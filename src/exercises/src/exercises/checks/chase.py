"""One turtle follows another at a distance: follow(x, y)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

from exercises.finding import Finding, at_least, near
from exercises.program import load, numbers, part

STEP = 0.1  # s, as in the lesson's loop
CALL = "follow(x, y)"


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """It must come to the given distance, stop, never be nearer, never drive backwards."""
    follow = part(load(file), CALL)
    target, (x, y, yaw), apart, speed = (5.5, 5.5), (1.0, 1.0, math.pi), [], 0.0
    for _ in range(round(limits["seconds"] / STEP)):
        way, bearing = math.hypot(target[0] - x, target[1] - y), math.atan2(target[1] - y,
                                                                          target[0] - x) - yaw
        apart.append(way)
        command = follow(way * math.cos(bearing), way * math.sin(bearing))
        speed, turn = numbers((command.linear.x, command.angular.z), 2, CALL)
        x, y = x + STEP * speed * math.cos(yaw), y + STEP * speed * math.sin(yaw)
        yaw += STEP * turn
    yield near("distance at the end", apart[-1], limits["distance"], limits["tolerance"], " m")
    yield at_least("least distance", min(apart), limits["distance"] - limits["tolerance"], " m")
    yield near("speed at the end", speed, 0.0, 0.05, " m/s")
    too_near = float(follow(limits["distance"] / 2, 0.0).linear.x)
    yield near("speed at half that distance", too_near, 0.0, 0.01, " m/s")
