"""Where a robot may be after a motion, with errors of the odometry.

The models are those of S. Thrun, W. Burgard, D. Fox, "Probabilistic Robotics" (2005), 5.4, with
amcl's names, its five alphas and its treatment of driving backwards. amcl's older models ("diff",
"omni") use a variance as a standard deviation; robots are tuned with that, so it stays, and the
"-corrected" ones take the square root.

All models map `poses` (N, 3) of the particles, the odometry's poses `odom_before` and
`odom_after` (3,), `alphas` (5,) and normal draws `normals` (N, 3) to poses (N, 3). m, rad.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from nav_algorithms.poses import wrap_angle

TURN_ONLY = 0.01  # m; the direction of a shorter step is noise: the robot turned in place


def sample_diff(poses: np.ndarray, odom_before: np.ndarray, odom_after: np.ndarray,
                alphas: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """amcl's "diff": turn, drive, turn."""
    return _turn_drive_turn(poses, odom_before, odom_after, alphas, normals, np.asarray)


def sample_diff_corrected(poses: np.ndarray, odom_before: np.ndarray, odom_after: np.ndarray,
                          alphas: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """amcl's "diff-corrected": turn, drive, turn."""
    return _turn_drive_turn(poses, odom_before, odom_after, alphas, normals, np.sqrt)


def sample_omni(poses: np.ndarray, odom_before: np.ndarray, odom_after: np.ndarray,
                alphas: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """amcl's "omni": drive, drift sideways, turn."""
    a1, a2, a3, a4, a5 = alphas
    return _drive_aside_turn(poses, odom_before, odom_after, (a3, a1, a4, a2, a1, a5), normals,
                             np.asarray)


def sample_omni_corrected(poses: np.ndarray, odom_before: np.ndarray, odom_after: np.ndarray,
                          alphas: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """amcl's "omni-corrected": drive, drift sideways, turn."""
    a1, a2, a3, a4, a5 = alphas
    return _drive_aside_turn(poses, odom_before, odom_after, (a3, a4, a1, a2, a4, a5), normals,
                             np.sqrt)


MODELS: dict[str, Callable[..., np.ndarray]] = {
    "diff": sample_diff, "omni": sample_omni,
    "diff-corrected": sample_diff_corrected, "omni-corrected": sample_omni_corrected}


def _turn_drive_turn(poses: np.ndarray, before: np.ndarray, after: np.ndarray, alphas: np.ndarray,
                     normals: np.ndarray, deviation: Callable[[float], float]) -> np.ndarray:
    a1, a2, a3, a4, _ = alphas
    across, up, turn = after[0] - before[0], after[1] - before[1], after[2] - before[2]
    drive = np.hypot(across, up)
    first = wrap_angle(np.arctan2(up, across) - before[2]) if drive >= TURN_ONLY else 0.0
    second = wrap_angle(turn - first)
    # Driving backwards is not a turn by 180 degrees, and not noisier than driving forwards.
    first_size, second_size = _from_straight(first), _from_straight(second)
    firsts = first - normals[:, 0] * deviation(a1 * first_size**2 + a2 * drive**2)
    drives = drive - normals[:, 1] * deviation(
        a3 * drive**2 + a4 * first_size**2 + a4 * second_size**2)
    seconds = second - normals[:, 2] * deviation(a1 * second_size**2 + a2 * drive**2)
    return np.column_stack((poses[:, 0] + drives * np.cos(poses[:, 2] + firsts),
                            poses[:, 1] + drives * np.sin(poses[:, 2] + firsts),
                            wrap_angle(poses[:, 2] + firsts + seconds)))


def _from_straight(turn: float) -> float:
    """The difference of a turn from 0 or from half a turn, whichever is less, rad."""
    return min(abs(wrap_angle(turn)), abs(wrap_angle(turn - np.pi)))


def _drive_aside_turn(poses: np.ndarray, before: np.ndarray, after: np.ndarray,
                      alphas: tuple[float, ...], normals: np.ndarray,
                      deviation: Callable[[float], float]) -> np.ndarray:
    """`alphas`: of drive and turn for the drive, of turn and drive for the turn and the drift."""
    across, up = after[0] - before[0], after[1] - before[1]
    drive, turn = np.hypot(across, up), wrap_angle(after[2] - before[2])
    bearings = poses[:, 2] + wrap_angle(np.arctan2(up, across) - before[2])
    drives = drive + normals[:, 0] * deviation(alphas[0] * drive**2 + alphas[1] * turn**2)
    turns = turn + normals[:, 1] * deviation(alphas[2] * turn**2 + alphas[3] * drive**2)
    asides = normals[:, 2] * deviation(alphas[4] * turn**2 + alphas[5] * drive**2)
    cos, sin = np.cos(bearings), np.sin(bearings)
    return np.column_stack((poses[:, 0] + drives * cos + asides * sin,
                            poses[:, 1] + drives * sin - asides * cos,
                            wrap_angle(poses[:, 2] + turns)))
