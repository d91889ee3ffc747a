"""The construction site: barriers in the lane, left and right in turn, seen by the laser."""

from __future__ import annotations

import numpy as np

REACH = 0.38  # m ahead of the base
LENGTH = 0.10  # m of robot behind the base
BESIDE = 0.16  # m to either side of the lane's middle
CLEAR = 0.12  # m from the robot's middle


def between(aim: float, points: np.ndarray) -> float:
    """The lane's middle, m to the left, shifted so that the robot clears the barriers beside it.

    `points` (N, 2): of the laser, m, x ahead and y left of the base.
    """
    aside = points[(points[:, 0] > -LENGTH) & (points[:, 0] < REACH), 1]
    left = aside[(aside > aim) & (aside < aim + BESIDE)]
    right = aside[(aside <= aim) & (aside > aim - BESIDE)]
    most, least = left.min(initial=np.inf) - CLEAR, right.max(initial=-np.inf) + CLEAR
    if least > most:
        return (least + most) / 2
    return min(max(aim, least), most)
