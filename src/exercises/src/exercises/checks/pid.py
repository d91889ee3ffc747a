"""A steering law on a robot that pulls to one side: Driver().steer(offset_px, time)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from exercises.finding import Finding, at_most
from exercises.program import load, numbers, part

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


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """No steady-state error (the purpose of I) and no oscillation (that of D)."""
    seen = offsets(part(load(file), "Driver()")().steer)
    last = seen[-2 * RATE:] if len(seen) == int(SECONDS * RATE) else seen
    yield at_most("line beside the image's middle, mean of the last 2 s",
                  float(np.abs(last).mean()), limits["left_px"], " px")
    yield at_most("swing to the other side", float(max(0.0, -seen.min())), limits["swing_px"],
                  " px")
