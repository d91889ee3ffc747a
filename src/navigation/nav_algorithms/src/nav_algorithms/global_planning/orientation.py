"""The yaw of a robot along a path: GlobalPlanner's orientation_mode."""

from __future__ import annotations

import numpy as np

from nav_algorithms.poses import wrap_angle

NONE, FORWARD, INTERPOLATE, FORWARD_THEN_INTERPOLATE, BACKWARD, LEFTWARD, RIGHTWARD = range(7)
_TURN = {FORWARD: 0.0, BACKWARD: np.pi, LEFTWARD: np.pi / 2, RIGHTWARD: -np.pi / 2}


def directions(points: np.ndarray, window: int) -> np.ndarray:
    """Direction of travel at each of the points (N, 2), rad (N,): from `window` before to after."""
    at, last = np.arange(len(points)), len(points) - 1
    along = points[np.minimum(at + window, last)] - points[np.maximum(at - window, 0)]
    return np.arctan2(along[:, 1], along[:, 0])


def _interpolated(begin: float, end: float, count: int) -> np.ndarray:
    """`count` angles evenly from one to the other, the short way round."""
    return wrap_angle(begin + np.linspace(0.0, 1.0, count) * wrap_angle(end - begin))


def orient(path: np.ndarray, mode: int, window: int = 1) -> np.ndarray:
    """The path (N, 3) with yaws by `mode`; its first and last pose keep theirs.

    NONE: yaw 0 between them. FORWARD_THEN_INTERPOLATE: along the path, and over its last part,
    if that turns the same way round, evenly to the goal's yaw. Raises ValueError for other modes.
    """
    if mode not in range(7):
        raise ValueError(f"orientation_mode is 0 to 6, not {mode}")
    found = np.array(path, float)
    if len(found) < 3:
        return found
    begin, end = found[0, 2], found[-1, 2]
    if mode in _TURN:
        found[:, 2] = wrap_angle(directions(found[:, :2], window) + _TURN[mode])
    elif mode == INTERPOLATE:
        found[:, 2] = _interpolated(begin, end, len(found))
    elif mode == FORWARD_THEN_INTERPOLATE:
        found[:, 2] = directions(found[:, :2], window)
        turns = wrap_angle(np.diff(found[:-1, 2]))
        sign = np.sign(wrap_angle(end - found[-2, 2]))
        against = np.nonzero(turns * sign < -1e-3)[0]
        first = int(against[-1]) + 1 if len(against) else 0
        found[first:, 2] = _interpolated(found[first, 2], end, len(found) - first)
    else:
        found[:, 2] = 0.0
    found[0, 2], found[-1, 2] = begin, end
    return found
