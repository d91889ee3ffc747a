"""How uncertain a step of the odometry is, in gmapping's terms, and as the scans show it.

gmapping's parameters are one guess for all robots. Where walls tell the true step, the odometry's
error is seen, and later steps, above all those where no wall tells, are as uncertain as it showed.
"""

from __future__ import annotations

import math

import numpy as np

from nav_algorithms.poses import compose, relative

STILL = np.array([5e-4, 5e-4, 5e-4]) ** 2  # m^2, m^2, rad^2; what a step is uncertain by at least
CROSSWAYS = 0.3  # of srr: drift aside while driving ahead
LEARNT = 0.1     # share of what is believed of the odometry that one scan renews, once many came
BOUNDS = 0.01, 4.0  # of what is learnt, as a share of the variance that the parameters give
TOLD = 0.3       # share of a step's variance that the scan must take away for its error to count
MOVED = 0.01     # m and rad; a shorter step shows nothing


class StepSum:
    """The odometry's steps since the last scan that was used.

    `mean` (3,) is their sum in the robot's frame at that scan, `covariance` (3, 3) how uncertain
    it is: each step has a deviation that grows with its length and turn, as in gmapping.
    """

    def __init__(self, srr: float, srt: float, str_: float, stt: float) -> None:
        """m a m driven, rad a m driven, m a rad turned, rad a rad turned."""
        self._srr, self._srt, self._str, self._stt = srr, srt, str_, stt
        self.scale = np.ones(3)  # of the variances along, aside and in turning
        self._learnt = np.ones(3)  # how often, and once for the parameters
        self.clear()

    def clear(self) -> None:
        """A scan was used."""
        self.mean = np.zeros(3)
        self.covariance = np.diag(STILL)
        self.distance = self.turn = 0.0

    def add(self, before: np.ndarray, after: np.ndarray) -> None:
        """The odometry's pose went from `before` to `after`, (3,)."""
        step = relative(before, after)
        along, aside, turn = np.abs(step)
        deviations = np.array([
            self._srr * along + self._str * turn + CROSSWAYS * self._srr * aside,
            self._srr * aside + self._str * turn + CROSSWAYS * self._srr * along,
            self._stt * turn + self._srt * math.hypot(along, aside)])
        cos, sin = math.cos(self.mean[2]), math.sin(self.mean[2])
        turned = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
        carried = np.eye(3)  # what a turn so far does to where this step leads
        carried[:2, 2] = -sin * step[0] - cos * step[1], cos * step[0] - sin * step[1]
        self.covariance = (carried @ self.covariance @ carried.T
                           + turned @ np.diag(self.scale * deviations**2) @ turned.T)
        self.mean = compose(self.mean, step)
        self.distance += math.hypot(along, aside)
        self.turn += turn

    def learn(self, error: np.ndarray, posterior: np.ndarray) -> None:
        """The scan says that the sum is off by `error` (3,), with covariance `posterior` (3, 3).

        Both in the frame of `mean`. Driving and turning are learnt apart.
        """
        prior = np.diag(self.covariance)
        told = 1.0 - np.diag(posterior) / prior
        counts = told > TOLD
        # The match lies between odometry and walls; divided by `told` it lies at the walls.
        shares = (error / np.where(counts, told, 1.0)) ** 2 / prior * self.scale
        for part, moved in ((slice(0, 2), self.distance), (slice(2, 3), self.turn + self.distance)):
            if moved > MOVED and counts[part].any():
                seen = min(shares[part][counts[part]].mean(), BOUNDS[1])
                self._learnt[part] += 1
                rate = np.maximum(LEARNT, 1.0 / self._learnt[part])
                self.scale[part] += rate * (seen - self.scale[part])
        self.scale = np.clip(self.scale, *BOUNDS)
