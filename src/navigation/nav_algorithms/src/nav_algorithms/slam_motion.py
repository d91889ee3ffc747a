"""The uncertainty of an odometry step, by gmapping's parameters, and as learnt from the scans.

gmapping's parameters are one guess for all robots. Where walls show the true step, the odometry's
error is known, and later steps, above all where no wall shows it, are taken as that uncertain.
"""

from __future__ import annotations

import math

import numpy as np

from nav_algorithms.poses import compose, relative

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
