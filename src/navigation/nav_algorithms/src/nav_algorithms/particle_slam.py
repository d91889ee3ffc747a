"""Rao-Blackwellised particle SLAM: each particle is a path, with the map of that path.

The design is that of G. Grisetti, C. Stachniss, W. Burgard, "Improved techniques for grid mapping
with Rao-Blackwellized particle filters" (2007): a particle is drawn from the posterior of odometry
and scan, and resampling only happens when few particles carry the weight. Here that posterior is
the Gaussian at the matched pose, and maps are shared until they differ. The paths are a tree,
because particles share their past.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms import poses as pose_arithmetic
from nav_algorithms.beam_walls import holds
from nav_algorithms.cells import OccupancyGrid
from nav_algorithms.hit_maps import HitMaps
from nav_algorithms.map_rendering import MapRendering
from nav_algorithms.motion_models import StepSum
from nav_algorithms.proposals import Matching, Odometry, propose

ROOT = -1


class PoseTree:
    """Nodes (pose, scan), each with its parent; drops nodes that are on no particle's path."""

    def __init__(self, count: int) -> None:
        """Paths of `count` particles, all empty."""
        self._poses = np.zeros((0, 3))
        self._parents = np.zeros(0, np.int64)
        self._scans = np.zeros(0, np.int64)
        self._used = 0
        self._leaves = np.full(count, ROOT)

    def append(self, poses: np.ndarray, scan: int) -> None:
        """Each particle i moved to poses[i], (3,), where it took scan number `scan`."""
        count = len(self._leaves)
        if self._used + count > len(self._parents):
            self._compact()
        new = np.arange(self._used, self._used + count)
        self._poses[new], self._parents[new], self._scans[new] = poses, self._leaves, scan
        self._leaves = new
        self._used += count

    def choose(self, chosen: np.ndarray) -> None:
        """Particle i continues with the path of particle chosen[i]."""
        self._leaves = self._leaves[chosen]

    def path(self, particle: int) -> tuple[np.ndarray, np.ndarray]:
        """(poses (N, 3), scan numbers (N,)) of a particle, the oldest first."""
        nodes = []
        node = self._leaves[particle]
        while node != ROOT:
            nodes.append(node)
            node = self._parents[node]
        return self._poses[nodes[::-1]], self._scans[nodes[::-1]]

    def _compact(self) -> None:
        """Drop the nodes that are on no leaf's path, and make room for twice the rest."""
        kept = np.zeros(self._used, bool)
        fresh = np.unique(self._leaves[self._leaves != ROOT])
        while len(fresh):
            kept[fresh] = True
            parents = self._parents[fresh]
            fresh = np.unique(parents[parents != ROOT])
            fresh = fresh[~kept[fresh]]
        numbers = np.append(np.cumsum(kept) - 1, ROOT)  # ROOT, -1, indexes the last
        room = 2 * kept.sum() + 64 * len(self._leaves)
        for name in ("_poses", "_parents", "_scans"):
            old = getattr(self, name)
            new = np.zeros((room, *old.shape[1:]), old.dtype)
            new[:kept.sum()] = old[:self._used][kept]
            setattr(self, name, new)
        self._used = int(kept.sum())
        self._parents[:self._used] = numbers[self._parents[:self._used]]
        self._leaves = numbers[self._leaves]


SEARCHED = 2.5     # standard deviations of the odometry, to either side, that a search covers
MOST_STEPS = 5     # of a search, to either side
SEARCH_BEAMS = 90  # enough for a search
MATCHED = 0.25     # cells; deviation of beams from the walls for a matching scan: about 1 cm


@dataclass(frozen=True)
class SlamSettings:
    """gmapping's parameters by its names; m, rad, s."""

    maxUrange: float
    maxRange: float
    minimumScore: float
    sigma: float
    kernelSize: int
    lstep: float
    astep: float
    iterations: int
    lsigma: float
    ogain: float
    lskip: int
    srr: float
    srt: float
    str: float
    stt: float
    linearUpdate: float
    angularUpdate: float
    temporalUpdate: float
    resampleThreshold: float
    particles: int
    xmin: float
    ymin: float
    xmax: float
    ymax: float
    delta: float
    occ_thresh: float


class ParticleSlam:
    """Maps and localises; the same scans, odometry and seed give the same bits."""

    def __init__(self, settings: SlamSettings, seed: int = 0) -> None:
        self.settings = settings
        self._random = np.random.default_rng(seed)
        count = settings.particles
        lower, upper = (settings.xmin, settings.ymin), (settings.xmax, settings.ymax)
        self._maps = HitMaps(count, settings.delta, lower, upper)
        self._tree = PoseTree(count)
        self._rendering = MapRendering(settings.delta, lower, upper)
        self._scans: list[tuple[np.ndarray, np.ndarray]] = []
        self._stamps: list[float] = []
        self._laser = np.zeros(2)
        self._widths = np.array([settings.lsigma / settings.delta,
                                 settings.sigma / settings.delta**2, MATCHED])
        self._step = StepSum(settings.srr, settings.srt, settings.str, settings.stt)
        self._odometry: np.ndarray | None = None
        self._poses = np.zeros((count, 3))
        self._log_weights = np.zeros(count)  # since the last resampling, times the gain
        self._path_likelihoods = np.zeros(count)  # of each particle's whole path

    def add(self, stamp: float, odometry: np.ndarray, ranges: np.ndarray, angles: np.ndarray,
            laser: np.ndarray) -> bool:
        """Add a scan; True if it was used: the first, or after enough distance, turn or time.

        `odometry` (x, y, yaw) of the robot at `stamp`, s; `ranges`, m, at `angles`, rad, (N,), from
        `laser` (x, y, yaw) in the robot's frame; inf or nan if nothing was measured.
        """
        odometry = np.array(odometry, float)
        if self._odometry is None:
            self._poses[:] = odometry
        else:
            self._step.add(self._odometry, odometry)
        self._odometry = odometry
        if not self._is_due(stamp):
            return False
        ends, is_hit, usable = self._ends(ranges, angles, np.asarray(laser, float))
        self._laser = np.array(laser[:2], float)
        if self._scans:
            width = abs(angles[1] - angles[0]) if len(angles) > 1 else 0.0
            self._advance(ends[is_hit], holds(ends[is_hit], usable[is_hit], width))
        self._step.clear()
        self._tree.append(self._poses, len(self._scans))
        self._maps.add(self._poses, ends[is_hit])
        self._scans.append((ends, is_hit))
        self._stamps.append(stamp)
        return True

    @property
    def best(self) -> int:
        """The particle whose path explains all scans best."""
        return int(np.argmax(self._path_likelihoods))

    @property
    def pose(self) -> np.ndarray:
        """(x, y, yaw) of the best particle, moved by the odometry since the last used scan."""
        return pose_arithmetic.compose(self._poses[self.best], self._step.mean)

    @property
    def map_to_odom(self) -> np.ndarray:
        """The pose of the odometry's frame in the map's, (3,)."""
        if self._odometry is None:
            return np.zeros(3)
        return pose_arithmetic.compose(self.pose, pose_arithmetic.invert(self._odometry))

    @property
    def entropy(self) -> float:
        """The entropy of the particles' weights, nat."""
        weights = self._weights()
        return float(-(weights[weights > 0] * np.log(weights[weights > 0])).sum())

    def trajectory(self) -> tuple[np.ndarray, np.ndarray]:
        """(stamps (N,), poses (N, 3)) of the best particle at the scans that were used."""
        path, numbers = self._tree.path(self.best)
        return np.array(self._stamps)[numbers], path

    def grid(self) -> OccupancyGrid:
        """The best particle's map."""
        path, numbers = self._tree.path(self.best)
        self._rendering.follow(path, numbers, self._scans, self._laser)
        return self._rendering.grid(self.settings.occ_thresh)

    def _is_due(self, stamp: float) -> bool:
        settings = self.settings
        return (not self._scans
                or self._step.distance >= settings.linearUpdate
                or self._step.turn >= settings.angularUpdate
                or (settings.temporalUpdate >= 0.0
                    and not 0.0 <= stamp - self._stamps[-1] <= settings.temporalUpdate))

    def _ends(self, ranges: np.ndarray, angles: np.ndarray,
              laser: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Ends of the beams in the robot's frame, (N, 2), m, which of them hit, and their lengths.

        Ranges beyond maxRange are ignored; one beyond maxUrange only means that the way is free.
        """
        limit = min(self.settings.maxUrange, self.settings.maxRange)
        with np.errstate(invalid="ignore"):
            told = (ranges > 0.0) & (ranges <= self.settings.maxRange)
        told &= np.isfinite(ranges) & np.isfinite(angles)  # maxRange may be inf, as a driver's may
        ranges, angles = ranges[told], angles[told]
        usable = np.minimum(ranges, limit)
        ends = usable[:, None] * np.column_stack((np.cos(angles), np.sin(angles)))
        return pose_arithmetic.transform_points(laser, ends), ranges <= limit, usable

    def _advance(self, hits: np.ndarray, held: np.ndarray) -> None:
        """Move, weigh and, if few particles carry the weight, resample the particles."""
        settings, maps, count = self.settings, self._maps, len(self._poses)
        noise = np.linalg.cholesky(self._step.covariance)
        steps = self._step.mean + self._random.normal(size=(count, 3)) @ noise.T
        drawn = maps.in_cells(pose_arithmetic.compose(self._poses, steps))
        priors = maps.in_cells(pose_arithmetic.compose(self._poses, self._step.mean))
        odometry = Odometry(priors, self._informations(), drawn,
                            self._random.normal(size=(count, 3)))
        matching = Matching(*self._search_grid(), max(1, len(hits) // SEARCH_BEAMS),
                            settings.iterations, settings.kernelSize, self._widths,
                            settings.lskip + 1, float(settings.minimumScore))
        moved, likelihoods, matched, factors = propose(
            maps.tables, maps.pool, np.hstack((hits / settings.delta, held)), odometry, matching)
        self._learn_odometry(matched - priors, factors)
        moved[:, :2] = moved[:, :2] * settings.delta + maps.origin
        moved[:, 2] = pose_arithmetic.wrap_angle(moved[:, 2])
        self._poses = moved
        self._log_weights += likelihoods / (settings.ogain * count)
        self._path_likelihoods += likelihoods
        self._resample()

    def _learn_odometry(self, errors: np.ndarray, factors: np.ndarray) -> None:
        """Learn from the odometry's `errors` (N, 3) that the particles found, in cells and rad.

        Uses their mean: what a particle drew last time is its own error, not the odometry's.
        """
        found = factors[:, 0, 0] > 0
        if not found.all():
            return
        turned, scale = self._turned(), np.diag([self.settings.delta, self.settings.delta, 1.0])
        error = scale @ np.einsum("nji,nj->i", turned, errors) / len(errors)
        back = scale @ turned[self.best].T @ np.linalg.inv(factors[self.best]).T
        self._step.learn(error, back @ back.T)

    def _search_grid(self) -> tuple[np.ndarray, np.ndarray]:
        """(steps to either side (3,), their size (3,) in cells and rad) for this step's noise."""
        settings = self.settings
        sizes = np.array([settings.lstep, settings.lstep, settings.astep])
        spread = SEARCHED * np.sqrt(np.diag(self._step.covariance))
        halves = np.minimum(MOST_STEPS, spread / sizes + 0.5).astype(np.int64)
        return halves, sizes / (settings.delta, settings.delta, 1.0)

    def _informations(self) -> np.ndarray:
        """Each particle's information of the step, (N, 3, 3), in the map's frame, cells and rad."""
        turned, scale = self._turned(), np.diag([self.settings.delta, self.settings.delta, 1.0])
        information = scale @ np.linalg.inv(self._step.covariance) @ scale
        return np.ascontiguousarray(turned @ information @ turned.transpose(0, 2, 1))

    def _turned(self) -> np.ndarray:
        """Rotations from each robot's frame to the map's, (N, 3, 3)."""
        cos, sin = np.cos(self._poses[:, 2]), np.sin(self._poses[:, 2])
        turned = np.zeros((len(cos), 3, 3))
        turned[:, 0, 0], turned[:, 0, 1] = cos, -sin
        turned[:, 1, 0], turned[:, 1, 1], turned[:, 2, 2] = sin, cos, 1.0
        return turned

    def _weights(self) -> np.ndarray:
        weights = np.exp(self._log_weights - self._log_weights.max())
        return weights / weights.sum()

    def _resample(self) -> None:
        """Low-variance resampling if the effective number of particles is below the threshold."""
        weights = self._weights()
        count = len(weights)
        if 1.0 / (weights**2).sum() >= self.settings.resampleThreshold * count:
            return
        places = (np.arange(count) + self._random.random()) / count
        chosen = np.minimum(np.searchsorted(np.cumsum(weights), places), count - 1)
        self._poses = self._poses[chosen]
        self._path_likelihoods = self._path_likelihoods[chosen]
        self._log_weights = np.zeros(count)
        self._maps.choose(chosen)
        self._tree.choose(chosen)
