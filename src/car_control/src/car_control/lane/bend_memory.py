"""Remembers the line's curvature: what was seen ahead is below the car a moment later.

The camera sees no road nearer than just before the front wheels. The curvature from the rear axle
to there was seen a moment ago; only the distance driven since has to be known.
"""

from __future__ import annotations

import numpy as np

STEP = 0.05  # m, integration step
LEAST = 0.01  # m between two entries, at least
BEHIND = 0.5  # m that are kept


class BendMemory:
    """Curvatures (1/m, left positive) at places ahead of the rear axle, in m along the line."""

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        self._places: list[float] = []  # m from where the memory starts, ascending
        self._curvatures: list[float] = []
        self._driven = 0.0

    def drive(self, way: float) -> None:
        """The car has moved forward by `way` m."""
        self._driven += way
        while len(self._places) > 1 and self._places[1] < self._driven - BEHIND:
            del self._places[0], self._curvatures[0]

    def see(self, ahead: float, curvature: float) -> None:
        """The line has this curvature `ahead` m from here; older values beyond are dropped."""
        place = self._driven + ahead
        while self._places and self._places[-1] > place - LEAST:
            del self._places[-1], self._curvatures[-1]
        self._places.append(place)
        self._curvatures.append(curvature)

    def curvature(self, ahead: np.ndarray | float) -> np.ndarray:
        """The curvature at these places ahead; beyond the last known one, its value; else 0."""
        if not self._places:
            return np.zeros(np.shape(ahead))
        return np.interp(np.add(ahead, self._driven), self._places, self._curvatures)

    def shape(self, length: float) -> np.ndarray:
        """(n, 3) x, y (m) and heading (rad) of the line, as if the car stood on it."""
        way = np.arange(0.0, length + STEP, STEP)
        heading = np.concatenate([[0.0], np.cumsum(self.curvature(way[:-1] + STEP / 2)) * STEP])
        middle = (heading[1:] + heading[:-1]) / 2
        x = np.concatenate([[0.0], np.cumsum(np.cos(middle)) * STEP])
        y = np.concatenate([[0.0], np.cumsum(np.sin(middle)) * STEP])
        return np.stack([x, y, heading], axis=1)
