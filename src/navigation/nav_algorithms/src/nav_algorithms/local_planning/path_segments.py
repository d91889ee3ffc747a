"""A path that was planned with headings, cut where the vehicle changes its kind of motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.poses import wrap_angle

FORWARD, BACKWARD, ON_THE_SPOT = 1, -1, 0


@dataclass(frozen=True)
class Piece:
    """Poses (M, 3), M >= 2, driven FORWARD or BACKWARD, or turned ON_THE_SPOT.

    `lengths` (M,): m driven from the first pose to each; on the spot, rad turned.
    """

    poses: np.ndarray
    direction: int
    lengths: np.ndarray


def cut(path: np.ndarray) -> list[Piece]:
    """The pieces of a path (N, 3); empty if nothing moves.

    A step is driven backwards if the next pose is behind, seen along the mean of both headings,
    and is a turn if only the heading changes.
    """
    path = np.asarray(path, float)
    steps = np.diff(path[:, :2], axis=0)
    turns = wrap_angle(np.diff(path[:, 2]))
    middle = path[:-1, 2] + 0.5 * turns
    ahead = steps[:, 0] * np.cos(middle) + steps[:, 1] * np.sin(middle)
    sizes = np.hypot(*steps.T)
    kinds = np.where(sizes > 1e-6, np.where(ahead >= 0.0, FORWARD, BACKWARD), ON_THE_SPOT)
    moves = np.nonzero((sizes > 1e-6) | (np.abs(turns) > 1e-6))[0]
    found: list[Piece] = []
    begin = 0
    for n in range(1, len(moves) + 1):
        if n == len(moves) or kinds[moves[n]] != kinds[moves[begin]]:
            kind = int(kinds[moves[begin]])
            chosen = moves[begin:n]
            poses = np.vstack((path[chosen[0]], path[chosen + 1]))
            size = np.abs(turns[chosen]) if kind == ON_THE_SPOT else sizes[chosen]
            found.append(Piece(poses, kind, np.append(0.0, np.cumsum(size))))
            begin = n
    return found
