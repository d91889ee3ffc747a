"""The paths of all particles: a tree, because particles share where they came from."""

from __future__ import annotations

import numpy as np

ROOT = -1


class PoseTree:
    """Nodes (pose, scan), each knowing the one before; forgets what no particle came along."""

    def __init__(self, count: int) -> None:
        """Paths of `count` particles, all empty."""
        self._poses = np.zeros((0, 3))
        self._parents = np.zeros(0, np.int64)
        self._scans = np.zeros(0, np.int64)
        self._used = 0
        self._leaves = np.full(count, ROOT)

    def append(self, poses: np.ndarray, scan: int) -> None:
        """Every particle i went on to poses[i], (3,), where it took scan number `scan`."""
        count = len(self._leaves)
        if self._used + count > len(self._parents):
            self._compact()
        new = np.arange(self._used, self._used + count)
        self._poses[new], self._parents[new], self._scans[new] = poses, self._leaves, scan
        self._leaves = new
        self._used += count

    def choose(self, chosen: np.ndarray) -> None:
        """Particle i goes on with the path of particle chosen[i]."""
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
        """Drops the nodes that no leaf came along, and makes room for twice what stays."""
        kept = np.zeros(self._used, bool)
        fresh = np.unique(self._leaves[self._leaves != ROOT])
        while len(fresh):
            kept[fresh] = True
            parents = self._parents[fresh]
            fresh = np.unique(parents[parents != ROOT])
            fresh = fresh[~kept[fresh]]
        numbers = np.append(np.cumsum(kept) - 1, ROOT)  # the last is found at index ROOT
        room = 2 * kept.sum() + 64 * len(self._leaves)
        for name in ("_poses", "_parents", "_scans"):
            old = getattr(self, name)
            new = np.zeros((room, *old.shape[1:]), old.dtype)
            new[:kept.sum()] = old[:self._used][kept]
            setattr(self, name, new)
        self._used = int(kept.sum())
        self._parents[:self._used] = numbers[self._parents[:self._used]]
        self._leaves = numbers[self._leaves]
