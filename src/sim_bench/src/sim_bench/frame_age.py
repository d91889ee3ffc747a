"""How old a frame is when a callback gets it, from what one process saw on the wall clock.

A frame's stamp is the simulated moment at which it was taken. When that moment was on the wall is
found from /clock: within half a second around the stamp simulated time goes on at an even pace, and
a /clock message can only come late, never early. So the moment was due where the lower hull of the
arrivals has it: the earliest that any two messages around it allow. Where the simulator itself
was behind that, its lateness counts to the frame's age: the error is on the long side. What even
the quickest message needs on its way, well below a millisecond, is not in it.
"""

from __future__ import annotations

import bisect
from collections.abc import Sequence

import numpy as np

WINDOW = 0.5  # s, simulated, to either side of a frame's stamp


def frame_ages(
    frames: Sequence[tuple[float, float]], clock: Sequence[tuple[float, float]]
) -> list[float]:
    """Age (s, wall) of each frame that has /clock on both sides.

    Both are (wall, simulated) in s, in the order of arrival: a callback's start and the image's
    stamp; a message's arrival and its time.
    """
    simulated = [moment for _, moment in clock]
    ages = []
    for wall, stamp in frames:
        first = bisect.bisect_left(simulated, stamp - WINDOW)
        here = bisect.bisect_right(simulated, stamp)
        last = bisect.bisect_right(simulated, stamp + WINDOW)
        if first < here < last:
            ages.append(wall - _due(np.array(clock[first:here]), np.array(clock[here:last]), stamp))
    return ages


def real_time_factor(clock: Sequence[tuple[float, float]]) -> float:
    """Simulated seconds a wall second between the first and the last message."""
    (first_wall, first), (last_wall, last) = clock[0], clock[-1]
    return (last - first) / (last_wall - first_wall)


def _due(before: np.ndarray, after: np.ndarray, stamp: float) -> float:
    """The lower hull's wall time at a simulated moment; rows are (wall, simulated) around it."""
    share = (stamp - before[:, None, 1]) / (after[None, :, 1] - before[:, None, 1])
    return float(np.min(before[:, None, 0] * (1 - share) + after[None, :, 0] * share))
