"""Poses that a lost robot may have: on free cells, some of them where its latest scan fits.

Drawing poses from sensor data instead of anywhere is S. Lenser and M. Veloso's "Sensor resetting
localization for poorly modelled mobile robots" (2000). In a house, one in tens of thousands of
random poses is near enough to the true one, and a few hundred per draw would take long.
"""

from __future__ import annotations

import numpy as np

from nav_algorithms.grid import FREE, OccupancyGrid
from nav_algorithms.sensor_models import LaserModel, Scan

TRIED = 60_000    # poses that a scan is compared with: in a house one every 10 degrees and 0.1 m^2
BEAMS = 60        # of that scan, at most: enough for so rough a comparison, and more cost CPU
SHARPNESS = 12.0  # exponent of the weights: above 1 because amcl's weights hardly distinguish poses


class Places:
    """The free cells of one map."""

    def __init__(self, grid: OccupancyGrid, random: np.random.Generator) -> None:
        """In a map without free cells, all cells that are not occupied count as free."""
        free = grid.cells == FREE
        self._corners = np.argwhere(free if free.any() else grid.cells <= FREE)[:, ::-1]
        if not len(self._corners):
            self._corners = np.zeros((1, 2))
        self._resolution, self._origin = grid.resolution, grid.origin
        self._random = random

    def draw(self, count: int) -> np.ndarray:
        """Poses (count, 3), m and rad, uniformly distributed over the free cells."""
        cells = self._corners[self._random.integers(len(self._corners), size=count)]
        points = (cells + self._random.random((count, 2))) * self._resolution + self._origin
        return np.column_stack((points, self._random.uniform(-np.pi, np.pi, count)))

    def draw_fitting(self, count: int, share: float, scan: Scan, model: LaserModel) -> np.ndarray:
        """Poses (count, 3) in random order, `share` of them where the scan fits well."""
        fitting = int(count * share)
        anywhere = self.draw(count - fitting)
        if not fitting:
            return anywhere
        tried = self.draw(TRIED)
        few = scan.thinned(-(-len(scan.ranges) // BEAMS))
        logs = SHARPNESS * model.compare(tried, few).logs
        chances = np.exp(logs - logs.max())
        chosen = self._random.choice(TRIED, fitting, p=chances / chances.sum())
        return self._random.permutation(np.concatenate((anywhere, tried[chosen])))
