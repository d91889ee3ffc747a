"""Monte Carlo localisation on a map, with as many particles as needed.

S. Thrun, W. Burgard, D. Fox, "Probabilistic Robotics" (2005), 8.3: KLD-sampling, and random poses
when the scans fit worse than before. As in amcl, with these differences: particles are drawn
with low variance, and the averages that reveal a lost robot depend on the scans alone, not on
the number of particles. How many random poses are drawn, and where, are parameters (see amcl's).

A lost robot's poses are on free cells, some of them where its latest scan fits: S. Lenser, M.
Veloso, "Sensor resetting localization for poorly modelled mobile robots" (2000). In a house, one in
tens of thousands of random poses is near enough to the true one, and a few hundred per draw would
take long.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms import motion_models, poses
from nav_algorithms.cells import FREE, OccupancyGrid
from nav_algorithms.estimates import Estimate, bins_of, estimate, have_converged, particles_needed
from nav_algorithms.sensor_models import LaserModel, Scan, SensorSettings

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


@dataclass(frozen=True)
class LocalisationSettings:
    """amcl's parameters by its names; m, rad. The last six are additions.

    `lost_threshold`: a passer-by makes scans fit worse, too. `lost_share_max`: where the map looks
    alike, poses must win by later scans, not by how many were drawn. `search_share`: if a robot may
    start anywhere, the right place may have been given up too early.
    """

    min_particles: int
    max_particles: int
    kld_err: float
    kld_z: float
    odom_model_type: str
    odom_alpha1: float
    odom_alpha2: float
    odom_alpha3: float
    odom_alpha4: float
    odom_alpha5: float
    update_min_d: float
    update_min_a: float
    resample_interval: int
    selective_resampling: bool
    recovery_alpha_slow: float
    recovery_alpha_fast: float
    lost_threshold: float
    lost_share_max: float
    lost_forgets: bool
    random_fit_share: float
    search_share: float
    search_scans: int

    @property
    def alphas(self) -> np.ndarray:
        """The alphas (5,) for motion_models."""
        return np.array([getattr(self, f"odom_alpha{i}") for i in range(1, 6)])


@dataclass(frozen=True)
class Step:
    """The result of one scan: whether it was weighed, and whether the estimate is new."""

    weighed: bool
    estimated: bool


class Localisation:
    """The particles on one map; scans are added in the order of their time.

    `particles` (N, 3), m and rad in the map's frame, and `weights` (N,), which sum up to 1;
    `estimate` is of them, and `map_to_odom` (3,) is the resulting pose of the odometry's frame.
    """

    def __init__(self, grid: OccupancyGrid, settings: LocalisationSettings,
                 sensor: SensorSettings, random: np.random.Generator) -> None:
        """Starts at the origin: call start_at or start_anywhere."""
        self._settings = settings
        self._random = random
        self._model = LaserModel(grid, sensor)
        self._places = Places(grid, random)
        self.start_at(np.zeros(3), np.zeros((3, 3)))

    def start_at(self, mean: np.ndarray, covariance: np.ndarray) -> None:
        """Start at a pose (3,) known with a covariance (3, 3)."""
        deviates = self._random.standard_normal((self._settings.max_particles, 3))
        values, axes = np.linalg.eigh(covariance)
        spread = axes * np.sqrt(np.maximum(values, 0.0))
        self._start(np.asarray(mean, float) + deviates @ spread.T)

    def start_anywhere(self) -> None:
        """Start anywhere on the free cells, with any yaw; the first scan chooses fitting poses."""
        self._start(self._places.draw(self._settings.max_particles))
        self._anywhere = True

    def _start(self, particles: np.ndarray) -> None:
        self.particles = particles
        self.particles[:, 2] = poses.wrap_angle(self.particles[:, 2])
        self.weights = np.full(len(particles), 1 / len(particles))
        self.estimate: Estimate = estimate(self.particles, self.weights)
        self._averages = {"slow": 0.0, "fast": 0.0}
        self._fresh = 0  # how many of the particles, at the end, are random poses
        self._odometry: np.ndarray | None = None
        self._lasers: dict[str, bool] = {}  # by laser: whether its next scan is to be weighed
        self._wanted = self._anywhere = False
        self._weighed = 0
        self.map_to_odom = np.zeros(3)

    def weigh_next(self) -> None:
        """Weigh the next scan even if the robot has not moved."""
        self._wanted = True

    def jump_to(self, odometry: np.ndarray) -> None:
        """The robot was put where the odometry (3,) has it now, without any error on the way."""
        if self._odometry is not None:
            self.particles = poses.compose(self.particles,
                                           poses.relative(self._odometry, odometry))
            self._odometry = np.asarray(odometry, float)

    def add(self, odometry: np.ndarray, scan: Scan, laser: str = "") -> Step:
        """Add a scan by the laser of that name, taken at the odometry's pose `odometry` (3,)."""
        odometry = np.asarray(odometry, float)
        self._lasers.setdefault(laser, True)
        first = self._odometry is None
        if first or self._has_moved(odometry) or self._wanted:
            self._lasers = dict.fromkeys(self._lasers, True)
            self._wanted = self._wanted and first  # as upstream: not used up by the first scan
        if not self._lasers[laser]:
            return Step(weighed=False, estimated=False)
        self._lasers[laser] = False
        if not first:
            self._move(odometry)
        elif self._anywhere and self._weighed == 0:
            self.particles = self._drawn_anew(len(self.particles), scan)
        self._odometry = odometry
        self._weigh(scan)
        resampled = self._weighed % self._settings.resample_interval == 0
        if resampled:
            self._resample(scan)
        if resampled or first:
            self.estimate = estimate(self.particles, self.weights)
            self.map_to_odom = poses.compose(self.estimate.pose, poses.invert(odometry))
        return Step(weighed=True, estimated=resampled or first)

    def _has_moved(self, odometry: np.ndarray) -> bool:
        moved = np.abs(odometry - self._odometry)
        return bool((moved[:2] > self._settings.update_min_d).any()
                    or abs(poses.wrap_angle(odometry[2] - self._odometry[2]))
                    > self._settings.update_min_a)

    def _move(self, odometry: np.ndarray) -> None:
        sample = motion_models.MODELS[self._settings.odom_model_type]
        self.particles = sample(self.particles, self._odometry, odometry, self._settings.alphas,
                                self._random.standard_normal(self.particles.shape))

    def _weigh(self, scan: Scan) -> None:
        fit = self._model.compare(self.particles, scan, have_converged(self.particles))
        old = slice(len(self.particles) - self._fresh)  # random poses fit badly and prove nothing
        total = self.weights[old].sum()
        part = fit.parts[old] @ self.weights[old] / total if total > 0.0 else 0.0
        weights = self.weights * np.exp(fit.logs - fit.logs.max())  # also for very bad fits
        self.weights = weights / weights.sum()
        self._weighed += 1
        for name in ("slow", "fast"):
            share = max(getattr(self._settings, f"recovery_alpha_{name}"), 1 / self._weighed)
            before = self._averages[name] or part  # 0 after a draw that forgets
            self._averages[name] = before + share * (part - before)

    @property
    def lost(self) -> float:
        """Share of the particles that the next resampling draws as random poses."""
        settings = self._settings
        searched = (settings.search_share
                    if self._anywhere and self._weighed < settings.search_scans else 0.0)
        if settings.recovery_alpha_fast == 0.0 or self._averages["slow"] == 0.0:
            return searched
        share = 1.0 - self._averages["fast"] / self._averages["slow"]
        return max(searched, min(share, settings.lost_share_max)
                   if share > settings.lost_threshold else 0.0)

    def _drawn_anew(self, count: int, scan: Scan) -> np.ndarray:
        return self._places.draw_fitting(count, self._settings.random_fit_share, scan, self._model)

    def _resample(self, scan: Scan) -> None:
        settings, random, lost = self._settings, self._random, self.lost
        if (settings.selective_resampling
                and 1.0 / (self.weights**2).sum() > 0.5 * len(self.weights)):
            return
        most = settings.max_particles
        sums = np.cumsum(self.weights)
        drawn = self.particles[_at(sums, random.random(most))]
        anew = np.flatnonzero(random.random(most) < lost)
        if len(anew):
            drawn[anew] = self._drawn_anew(len(anew), scan)
        if lost and settings.lost_forgets:
            self._averages = dict.fromkeys(self._averages, 0.0)
        count = particles_needed(bins_of(drawn), settings.kld_err, settings.kld_z,
                                 min(settings.min_particles, most), most)
        # This many are enough; those from the particles are drawn again, evenly spaced.
        fresh = drawn[anew[anew < count]]
        kept = count - len(fresh)
        evenly = (np.arange(kept) + random.random()) / max(kept, 1)
        self.particles = np.concatenate((self.particles[_at(sums, evenly)], fresh))
        self.weights = np.full(count, 1 / count)
        self._fresh = len(fresh)


def _at(sums: np.ndarray, shares: np.ndarray) -> np.ndarray:
    """Indices of the weights (cumulative sums `sums`) at each share (0 to 1) of their total."""
    return np.minimum(np.searchsorted(sums, shares * sums[-1], side="right"), len(sums) - 1)
