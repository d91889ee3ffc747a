"""Where a robot may be after a motion, with errors of the odometry.

The models are those of S. Thrun, W. Burgard, D. Fox, "Probabilistic Robotics" (2005), 5.4, with
amcl's names, its five alphas and its treatment of driving backwards. amcl's older models ("diff",
"omni") use a variance as a standard deviation; robots are tuned with that, so it stays, and the
"-corrected" ones take the square root.

All models map `poses` (N, 3) of the particles, the odometry's poses `odom_before` and
`odom_after` (3,), `alphas` (5,) and normal draws `normals` (N, 3) to poses (N, 3). m, rad.

SLAM's uncertainty of a step is by gmapping's parameters, which are one guess for all robots, and as
learnt from the scans: where walls show the true step, the odometry's error is known, and later
steps, above all where no wall shows it, are taken as that uncertain.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from nav_algorithms.poses import compose, relative, wrap_angle

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


STILL = np.array([5e-4, 5e-4, 5e-4]) ** 2  # m^2, m^2, rad^2; the least variance of a step
CROSSWAYS = 0.3  # of srr: sideways drift while driving ahead
LEARNT = 0.1     # the least weight of one scan in what is learnt of the odometry, after many scans
BOUNDS = 0.01, 4.0  # of what is learnt, relative to the variance from the parameters
TOLD = 0.3       # share of a step's variance that the scan must remove for its error to count
MOVED = 0.01     # m and rad; a shorter step shows nothing


class StepSum:
    """The odometry's steps since the last scan that was used.

    `mean` (3,) is their sum in the robot's frame at that scan, `covariance` (3, 3) its
    uncertainty: each step's standard deviation grows with its length and turn, as in gmapping.
    """

    def __init__(self, srr: float, srt: float, str_: float, stt: float) -> None:
        """m per m driven, rad per m driven, m per rad turned, rad per rad turned."""
        self._srr, self._srt, self._str, self._stt = srr, srt, str_, stt
        self.scale = np.ones(3)  # of the variances along, sideways and in turning
        self._learnt = np.ones(3)  # how often, plus once for the parameters
        self.clear()

    def clear(self) -> None:
        """Start again, after a scan was used."""
        self.mean = np.zeros(3)
        self.covariance = np.diag(STILL)
        self.distance = self.turn = 0.0

    def add(self, before: np.ndarray, after: np.ndarray) -> None:
        """The odometry's pose changed from `before` to `after`, (3,)."""
        step = relative(before, after)
        along, aside, turn = np.abs(step)
        deviations = np.array([
            self._srr * along + self._str * turn + CROSSWAYS * self._srr * aside,
            self._srr * aside + self._str * turn + CROSSWAYS * self._srr * along,
            self._stt * turn + self._srt * math.hypot(along, aside)])
        cos, sin = math.cos(self.mean[2]), math.sin(self.mean[2])
        turned = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
        carried = np.eye(3)  # Jacobian: how an error of the turn so far moves this step
        carried[:2, 2] = -sin * step[0] - cos * step[1], cos * step[0] - sin * step[1]
        self.covariance = (carried @ self.covariance @ carried.T
                           + turned @ np.diag(self.scale * deviations**2) @ turned.T)
        self.mean = compose(self.mean, step)
        self.distance += math.hypot(along, aside)
        self.turn += turn

    def learn(self, error: np.ndarray, posterior: np.ndarray) -> None:
        """The scan shows that the sum is wrong by `error` (3,), with covariance `posterior` (3, 3).

        Both in the frame of `mean`. Driving and turning are learnt separately.
        """
        prior = np.diag(self.covariance)
        told = 1.0 - np.diag(posterior) / prior
        counts = told > TOLD
        # The match is between odometry and walls; divided by `told` it is at the walls.
        shares = (error / np.where(counts, told, 1.0)) ** 2 / prior * self.scale
        for part, moved in ((slice(0, 2), self.distance), (slice(2, 3), self.turn + self.distance)):
            if moved > MOVED and counts[part].any():
                seen = min(shares[part][counts[part]].mean(), BOUNDS[1])
                self._learnt[part] += 1
                rate = np.maximum(LEARNT, 1.0 / self._learnt[part])
                self.scale[part] += rate * (seen - self.scale[part])
        self.scale = np.clip(self.scale, *BOUNDS)
