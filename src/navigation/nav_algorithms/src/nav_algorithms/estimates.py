"""From weighted particles: the estimate of the pose, with its covariance; bins of poses.

The bins tell how many particles are needed (D. Fox, "Adapting the sample size in particle filters
through KLD-sampling", 2003), and their clusters. As in amcl, particles in adjacent bins are one
cluster; unlike there, the bins of yaw form a circle, and particles that are all in one bin need the
minimum number, not the maximum.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.compiled import compiled

EDGE = 0.5       # m
TURNS = 36       # bins of yaw: 10 degrees each
_SPAN = 1 << 20  # bins along x or y
TOGETHER = 0.5  # m; amcl's limit, in x and y, of converged particles' distance from their mean


def bins_of(particles: np.ndarray) -> np.ndarray:
    """A number for the bin of each particle (N, 3), int64 (N,)."""
    x, y = ((np.floor(particles[:, axis] / EDGE).astype(np.int64) + _SPAN // 2) % _SPAN
            for axis in (0, 1))
    turn = np.floor(particles[:, 2] % (2 * np.pi) / (2 * np.pi) * TURNS).astype(np.int64) % TURNS
    return (x * _SPAN + y) * TURNS + turn


def particles_needed(bins: np.ndarray, error: float, z: float, least: int, most: int) -> int:
    """How many of the particles, whose bins (N,) are in the order of drawing, are enough.

    With a probability whose quantile of the normal distribution is `z`, their distribution is then
    within `error` of the true one. Between `least` and `most`, and at most N.
    """
    is_new = np.zeros(len(bins), bool)
    is_new[np.unique(bins, return_index=True)[1]] = True
    others = np.cumsum(is_new) - 1
    spread = 2.0 / (9.0 * np.maximum(others, 1))
    wanted = np.ceil(others / (2.0 * error) * (1.0 - spread + np.sqrt(spread) * z) ** 3)
    enough = np.arange(1, len(bins) + 1) > np.clip(wanted, least, most)
    return int(np.argmax(enough)) + 1 if enough.any() else len(bins)


def clusters_of(particles: np.ndarray) -> np.ndarray:
    """The cluster of each particle (N, 3): int64 (N,), from 0."""
    bins, which = np.unique(bins_of(particles), return_inverse=True)
    return np.unique(_joined(bins), return_inverse=True)[1][which]


@compiled("i8(i8[::1], i8)")
def _root(parents: np.ndarray, i: int) -> int:
    while parents[i] != i:
        parents[i] = parents[parents[i]]
        i = parents[i]
    return i


@compiled("i8[::1](i8[::1])")
def _joined(bins: np.ndarray) -> np.ndarray:
    """For each of the sorted bins, the first bin that it is connected with."""
    parents = np.arange(bins.size)
    for i in range(bins.size):
        turn, place = bins[i] % TURNS, bins[i] // TURNS
        for dx in range(2):  # the others were checked from the other side
            for dy in range(-1, 2):
                for dturn in range(-1, 2):
                    beside = ((place + dx * _SPAN + dy) * TURNS + (turn + dturn) % TURNS)
                    k = np.searchsorted(bins, beside)
                    if k < bins.size and bins[k] == beside:
                        a, b = _root(parents, i), _root(parents, k)
                        parents[max(a, b)] = min(a, b)
    for i in range(bins.size):
        parents[i] = _root(parents, i)
    return parents


@dataclass(frozen=True)
class Estimate:
    """`pose` (3,) is the mean of the cluster with the most weight, `covariance` (3, 3) is of all.

    `share` is that cluster's share of all weight.
    """

    pose: np.ndarray
    covariance: np.ndarray
    share: float


def estimate(particles: np.ndarray, weights: np.ndarray) -> Estimate:
    """The estimate from particles (N, 3) with weights (N,) that sum up to 1."""
    clusters = clusters_of(particles)
    sums = np.bincount(clusters, weights)
    heaviest = int(np.argmax(sums))
    inside = clusters == heaviest
    mean, _ = _moments(particles[inside], weights[inside] / sums[heaviest])
    return Estimate(mean, _moments(particles, weights)[1], float(sums[heaviest]))


def _moments(particles: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean and covariance; yaw's variance is circular, -2 ln of the mean direction's length.

    As in amcl, yaw is taken as uncorrelated.
    """
    places = particles[:, :2]
    mean = weights @ places
    cos, sin = weights @ np.cos(particles[:, 2]), weights @ np.sin(particles[:, 2])
    covariance = np.zeros((3, 3))
    covariance[:2, :2] = ((places - mean) * weights[:, None]).T @ (places - mean)
    covariance[2, 2] = -2.0 * np.log(np.clip(np.hypot(cos, sin), 1e-12, 1.0))
    return np.array([*mean, np.arctan2(sin, cos)]), covariance


def have_converged(particles: np.ndarray) -> bool:
    """Whether all particles (N, 3) are within TOGETHER of their mean, in x and y."""
    return bool((np.abs(particles[:, :2] - particles[:, :2].mean(axis=0)) <= TOGETHER).all())
