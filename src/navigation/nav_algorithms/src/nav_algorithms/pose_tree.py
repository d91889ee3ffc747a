"""The paths of all particles: a tree, because particles share their past."""

from __future__ import annotations

import numpy as np

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
