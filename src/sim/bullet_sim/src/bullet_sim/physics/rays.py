"""Straight rays against collision shapes."""

from dataclasses import dataclass

import numpy as np

from bullet_sim.physics.client import PhysicsClient
from bullet_sim.physics.quiet import pybullet

AT_ONCE = pybullet.MAX_RAY_INTERSECTION_BATCH_SIZE - 1


@dataclass(frozen=True)
class RayHits:
    """Result of a batch of rays; row i belongs to ray i."""

    fraction: np.ndarray  # (n,) of the ray's length; 1 where nothing was hit
    retro: np.ndarray  # (n,) laser_retro of what was hit


def cast_rays(client: PhysicsClient, starts: np.ndarray, ends: np.ndarray) -> RayHits:
    """First shape along each ray; `starts` and `ends` are (n, 3) in the world, m."""
    rows = []  # of body (-1: nothing was hit), link, fraction, position, normal
    for first in range(0, len(starts), AT_ONCE):
        some = slice(first, first + AT_ONCE)
        rows += client.read(pybullet.rayTestBatch, starts[some].tolist(), ends[some].tolist())
    fraction = np.array([row[2] if row[0] >= 0 else 1.0 for row in rows])
    retro = np.zeros(len(rows))
    if client.retro:
        retro[:] = [client.retro.get((row[0], row[1]), 0.0) for row in rows]
    return RayHits(fraction, retro)
