"""The line's curvature by way driven: what was seen ahead is beneath the car a moment later.

The camera sees nothing nearer than the road before the front wheels. How the line bends from the
rear axle to there was seen a moment ago; only the way driven since has to be known.
"""

from __future__ import annotations

import numpy as np

STEP = 0.05  # m, of the integration
LEAST = 0.01  # m between two entries
BEHIND = 0.5  # m that are kept


class BendMemory:
    """Curvatures (1/m, left positive) at places ahead of the rear axle, in m along the line."""

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        self._places: list[float] = []  # m from where the memory began, ascending
        self._curvatures: list[float] = []
        self._driven = 0.0

    def drive(self, way: float) -> None:
        """The car has moved `way` m on."""
        self._driven += way
        while len(self._places) > 1 and self._places[1] < self._driven - BEHIND:
            del self._places[0], self._curvatures[0]

    def see(self, ahead: float, curvature: float) -> None:
        """The line bends so `ahead` m from here; what was thought of places beyond is forgotten."""
        place = self._driven + ahead
        while self._places and self._places[-1] > place - LEAST:
            del self._places[-1], self._curvatures[-1]
        self._places.append(place)
        self._curvatures.append(curvature)

    def curvature(self, ahead: np.ndarray | float) -> np.ndarray:
        """At these places ahead; beyond what is known: as at its end. 0 if nothing is known."""
        if not self._places:
            return np.zeros(np.shape(ahead))
        return np.interp(np.add(ahead, self._driven), self._places, self._curvatures)

    def shape(self, length: float) -> np.ndarray:
        """(n, 3) x, y (m) and heading (rad): how the line would lie if the car stood on it."""
        way = np.arange(0.0, length + STEP, STEP)
        heading = np.concatenate([[0.0], np.cumsum(self.curvature(way[:-1] + STEP / 2)) * STEP])
        middle = (heading[1:] + heading[:-1]) / 2
        x = np.concatenate([[0.0], np.cumsum(np.cos(middle)) * STEP])
        y = np.concatenate([[0.0], np.cumsum(np.sin(middle)) * STEP])
        return np.stack([x, y, heading], axis=1)
