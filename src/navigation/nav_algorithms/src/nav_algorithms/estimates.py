"""The estimate from weighted particles: a pose and its covariance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.particle_bins import clusters_of

TOGETHER = 0.5  # m; amcl's limit, in x and y, of converged particles' distance from their mean


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
