"""Straight rays against collision shapes."""

import contextlib
import gc
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from bullet_sim.physics.client import PhysicsClient
from bullet_sim.physics.engine import pybullet

AT_ONCE = pybullet.MAX_RAY_INTERSECTION_BATCH_SIZE - 1


@dataclass(frozen=True)
class RayHits:
    """Result of a batch of rays; row i belongs to ray i."""

    fraction: np.ndarray  # (n,) of the ray's length; 1 if nothing was hit
    retro: np.ndarray  # (n,) laser_retro of the link that was hit


def cast_rays(client: PhysicsClient, starts: np.ndarray, ends: np.ndarray) -> RayHits:
    """The first shape along each ray; `starts` and `ends` are (n, 3) in the world, m."""
    fraction, retro = np.ones(len(starts)), np.zeros(len(starts))
    with _without_collector():
        for first in range(0, len(starts), AT_ONCE):
            some = slice(first, first + AT_ONCE)
            # Rows of body (-1: nothing was hit), link, fraction, position, normal.
            rows = client.read(pybullet.rayTestBatch, starts[some].tolist(), ends[some].tolist())
            fraction[some] = [row[2] if row[0] >= 0 else 1.0 for row in rows]
            if client.retro:
                retro[some] = [client.retro.get((row[0], row[1]), 0.0) for row in rows]
            del rows
    return RayHits(fraction, retro)


@contextlib.contextmanager
def _without_collector() -> Iterator[None]:
    """Without garbage collection, which takes a third of the time of a sweep, as thousands of
    short-lived tuples trigger it."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()
