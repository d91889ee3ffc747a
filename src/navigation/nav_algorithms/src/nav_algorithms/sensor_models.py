"""How well a scan fits each particle: amcl's three laser models.

The formulas are those of S. Thrun, W. Burgard, D. Fox, "Probabilistic Robotics" (2005), 6.3 and
6.4, with amcl's names and its unusual sum: a beam of probability p adds p^3 to a particle's
weight, so a few wrong beams do no harm. Three errors of amcl are not reproduced: its half cell
between map and field, readings beyond range_max that its beam model ignores (here: z_max), and,
with `wall_depth`, poses whose beams end inside walls.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms import likelihood_field, poses
from nav_algorithms.cells import FREE, OCCUPIED, OccupancyGrid
from nav_algorithms.compiled import compiled
from nav_algorithms.rays import cast

BEAM, FIELD, FIELD_PROB = "beam", "likelihood_field", "likelihood_field_prob"


@dataclass(frozen=True)
class SensorSettings:
    """amcl's parameters by its names; m. The last two are additions: see _way_off."""

    laser_max_beams: int
    laser_z_hit: float
    laser_z_short: float
    laser_z_max: float
    laser_z_rand: float
    laser_sigma_hit: float
    laser_lambda_short: float
    laser_likelihood_max_dist: float
    laser_model_type: str
    do_beamskip: bool
    beam_skip_distance: float
    beam_skip_threshold: float
    beam_skip_error_threshold: float
    wall_depth: float
    thin_wall: float


@dataclass(frozen=True)
class Scan:
    """`ranges` (N,), m, along `angles` (N,), rad, from `laser` (x, y, yaw) in the robot's frame.

    A range of `range_max`, m, or more means that nothing nearer was seen, and nan that nothing was
    measured.
    """

    ranges: np.ndarray
    angles: np.ndarray
    laser: np.ndarray
    range_max: float

    def thinned(self, step: int) -> Scan:
        """Every `step`-th beam, without those that measured nothing."""
        ranges, angles = self.ranges[::step], self.angles[::step]
        kept = ~np.isnan(ranges)
        return Scan(ranges[kept], angles[kept], self.laser, self.range_max)

    def ends(self) -> np.ndarray:
        """The ends of beams that hit, (M, 2), m, in the robot's frame."""
        hit = self.ranges < self.range_max
        ranges, angles = self.ranges[hit], self.angles[hit]
        points = np.column_stack((ranges * np.cos(angles), ranges * np.sin(angles)))
        return np.ascontiguousarray(poses.transform_points(self.laser, points))


@dataclass(frozen=True)
class Fit:
    """How well one scan fits N particles: logarithms of the factors for their weights.

    `parts` (N,), 0 to 1: the share of the best possible fit of such a scan in this model; unlike
    the factors they are comparable between scans of few and of many beams.
    """

    logs: np.ndarray
    parts: np.ndarray


class LaserModel:
    """One map and one way to compare scans with it."""

    def __init__(self, grid: OccupancyGrid, settings: SensorSettings) -> None:
        self._settings = settings
        self._place = grid.resolution, *grid.origin
        # The ends of upstream's rays: cells that are not free, and the map's edge.
        self._blocked = np.pad((grid.cells != FREE).astype(np.uint8), 1, constant_values=1)
        self._distances = np.minimum(_way_off(grid.cells, grid.resolution, settings),
                                     settings.laser_likelihood_max_dist)
        self._tables: dict[float, np.ndarray] = {}

    def compare(self, particles: np.ndarray, scan: Scan, converged: bool = False) -> Fit:
        """Compare a scan with what particles (N, 3) should see; once they have `converged`, beams
        that most of them cannot explain may be left out.
        """
        chosen = self._settings
        count = len(scan.ranges)
        if chosen.laser_model_type == FIELD_PROB:
            ends = scan.thinned(max(1, -(-count // chosen.laser_max_beams))).ends()
            if chosen.do_beamskip and converged:
                ends = self._without_skipped(particles, ends)
            logs = _sums(np.log(self._probabilities(scan.range_max)), *self._place, particles, ends)
            each = np.exp(logs / max(len(ends), 1))
            return Fit(logs, each / self._best(scan.range_max) if len(ends) else np.ones_like(each))
        scan = scan.thinned(max(1, (count - 1) // max(1, chosen.laser_max_beams - 1)))
        if chosen.laser_model_type == BEAM:
            sums = self._beam_sums(particles, scan)
            is_max = scan.ranges >= scan.range_max
            best = (chosen.laser_z_hit
                    + np.where(is_max, chosen.laser_z_max, chosen.laser_z_rand / scan.range_max))
            return Fit(np.log1p(sums), _part(sums, (best**3).sum()))
        ends = scan.ends()
        sums = _sums(self._probabilities(scan.range_max)**3, *self._place, particles, ends)
        return Fit(np.log1p(sums), _part(sums, len(ends) * self._best(scan.range_max)**3))

    def _best(self, range_max: float) -> float:
        return self._settings.laser_z_hit + self._settings.laser_z_rand / range_max

    def _probabilities(self, range_max: float) -> np.ndarray:
        """Probability of a beam ending in each cell; the border, one cell wide, is for outside."""
        if range_max not in self._tables:
            chosen = self._settings
            distances = np.pad(self._distances, 1,
                               constant_values=chosen.laser_likelihood_max_dist)
            hit = np.exp(-distances**2 / (2 * chosen.laser_sigma_hit**2))
            self._tables = {range_max: chosen.laser_z_hit * hit + chosen.laser_z_rand / range_max}
        return self._tables[range_max]

    def _beam_sums(self, particles: np.ndarray, scan: Scan) -> np.ndarray:
        chosen = self._settings
        return _sums_of_beams(
            self._blocked, *self._place, poses.compose(particles, scan.laser),
            np.minimum(scan.ranges, scan.range_max), np.ascontiguousarray(scan.angles),
            scan.range_max, np.array((chosen.laser_z_hit, chosen.laser_z_short, chosen.laser_z_max,
                                      chosen.laser_z_rand, chosen.laser_sigma_hit,
                                      chosen.laser_lambda_short)))

    def _without_skipped(self, particles: np.ndarray, ends: np.ndarray) -> np.ndarray:
        """Without the beams that too few particles can explain; all if that is nearly all."""
        chosen = self._settings
        near = (np.pad(self._distances, 1, constant_values=np.inf)
                < chosen.beam_skip_distance).astype(float)
        explained = _shares(near, *self._place, particles, ends)
        kept = explained > chosen.beam_skip_threshold
        skipped = len(ends) - kept.sum()
        return ends if skipped >= chosen.beam_skip_error_threshold * len(ends) else ends[kept]


def _part(sums: np.ndarray, best: float) -> np.ndarray:
    """The sums as a share of the best one; 1 if there was nothing to see."""
    return sums / best if best > 0.0 else np.ones_like(sums)


def _way_off(cells: np.ndarray, resolution: float, settings: SensorSettings) -> np.ndarray:
    """How wrong it is for a beam to end in each cell, (rows, columns), m.

    Upstream's distance to the nearest occupied cell: any place in a wall is right, and a wall of
    15 cm is one broad optimum for sigma_hit of 0.2 m, 7 cm behind its surface. With `wall_depth`,
    that times the depth below the surface, if it is more; in walls thicker than `thin_wall`, which
    are not seen from both sides, at most the depth itself: more would push poses away from them.
    """
    occupied, free = cells == OCCUPIED, cells == FREE
    distances = likelihood_field.distances(occupied.astype(np.uint8)) * resolution
    if not (settings.wall_depth and occupied.any() and free.any()):
        return distances
    behind = (likelihood_field.distances(free.astype(np.uint8)) - 1.0) * resolution
    half = settings.thin_wall / 2
    of_thick = likelihood_field.distances((behind >= half).astype(np.uint8)) * resolution <= half
    depth = np.where(of_thick, min(1.0, settings.wall_depth), settings.wall_depth)
    return np.where(free, distances, np.maximum(distances, depth * behind))


@compiled("f8(f8[:,::1], f8, f8)")
def _value_at(table: np.ndarray, column: float, row: float) -> float:
    """The value of a table with a border one cell wide, which stands for all outside; in cells.

    Interpolated between the cells' centres: otherwise poses up to a cell apart fit equally.
    """
    across = min(max(column + 0.5, 0.0), table.shape[1] - 1.0)
    up = min(max(row + 0.5, 0.0), table.shape[0] - 1.0)
    i, j = min(int(up), table.shape[0] - 2), min(int(across), table.shape[1] - 2)
    up, across = up - i, across - j
    return ((1.0 - up) * ((1.0 - across) * table[i, j] + across * table[i, j + 1])
            + up * ((1.0 - across) * table[i + 1, j] + across * table[i + 1, j + 1]))


@compiled("f8[::1](f8[:,::1], f8, f8, f8, f8[:,::1], f8[:,::1])")
def _sums(table: np.ndarray, resolution: float, origin_x: float, origin_y: float,
          particles: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """For each particle, the sum of the table's values where its beams end."""
    found = np.empty(len(particles))
    for n in range(len(particles)):
        cos, sin = np.cos(particles[n, 2]) / resolution, np.sin(particles[n, 2]) / resolution
        column = (particles[n, 0] - origin_x) / resolution
        row = (particles[n, 1] - origin_y) / resolution
        total = 0.0
        for k in range(len(ends)):
            total += _value_at(table, column + cos * ends[k, 0] - sin * ends[k, 1],
                               row + sin * ends[k, 0] + cos * ends[k, 1])
        found[n] = total
    return found


@compiled("f8[::1](f8[:,::1], f8, f8, f8, f8[:,::1], f8[:,::1])")
def _shares(table: np.ndarray, resolution: float, origin_x: float, origin_y: float,
            particles: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """For each beam, the mean over the particles of the table's values where it ends."""
    found = np.zeros(len(ends))
    for n in range(len(particles)):
        cos, sin = np.cos(particles[n, 2]) / resolution, np.sin(particles[n, 2]) / resolution
        column = (particles[n, 0] - origin_x) / resolution
        row = (particles[n, 1] - origin_y) / resolution
        for k in range(len(ends)):
            found[k] += _value_at(table, column + cos * ends[k, 0] - sin * ends[k, 1],
                                  row + sin * ends[k, 0] + cos * ends[k, 1])
    return found / len(particles)


@compiled("f8[::1](u1[:,::1], f8, f8, f8, f8[:,::1], f8[::1], f8[::1], f8, f8[::1])")
def _sums_of_beams(blocked: np.ndarray, resolution: float, origin_x: float, origin_y: float,
                   lasers: np.ndarray, ranges: np.ndarray, angles: np.ndarray, range_max: float,
                   laws: np.ndarray) -> np.ndarray:
    """For each laser pose (N, 3), the sum of its beams' cubed probabilities.

    `blocked` has a border one cell wide; `laws`: z_hit, z_short, z_max, z_rand, sigma, lambda.
    """
    z_hit, z_short, z_max, z_rand, sigma, decay = laws
    found = np.zeros(len(lasers))
    for n in range(len(lasers)):
        x, y = lasers[n, 0], lasers[n, 1]
        expected = cast(blocked, resolution, origin_x - resolution, origin_y - resolution, x, y,
                        angles + lasers[n, 2], range_max)
        outside = not (0 <= (x - origin_x) / resolution < blocked.shape[1] - 2
                       and 0 <= (y - origin_y) / resolution < blocked.shape[0] - 2)
        for k in range(len(ranges)):
            z = ranges[k] - (0.0 if outside else min(expected[k], range_max))
            p = z_hit * np.exp(-z * z / (2.0 * sigma * sigma))
            if z < 0.0:
                p += z_short * decay * np.exp(-decay * ranges[k])
            p += z_max if ranges[k] == range_max else z_rand / range_max
            found[n] += p**3
    return found
