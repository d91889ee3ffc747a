"""The shortest way from one angle to another."""

from __future__ import annotations

import math

TURN = 2.0 * math.pi


def shortest_angular_distance(start: float, to: float) -> float:
    """The turn that leads from one angle to the other, in (-pi, pi], rad."""
    turn = math.fmod(to - start, TURN)
    if turn <= -math.pi:
        return turn + TURN
    return turn - TURN if turn > math.pi else turn
