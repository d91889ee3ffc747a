"""A path to follow, as points on the ground: its length, headings, curvatures, nearest point."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class NearestPoint:
    """The point of a path closest to a given place."""

    s: float  # m along the path
    lateral: float  # m; positive: the place is to the left of the path
    heading: float  # rad, of the path there


class Path:
    """A polyline; a closed one also connects its last point to its first."""

    def __init__(self, points: np.ndarray, closed: bool = False):
        """`points`: (n, 2) in m, no two neighbours equal; n >= 2, or 3 if closed."""
        self.points = np.asarray(points, float)
        self.closed = closed
        if self.points.ndim != 2 or self.points.shape[1] != 2 or len(self.points) < 2 + closed:
            raise ValueError(
                f"a path needs {2 + closed} points (x, y) or more, not {self.points.shape}"
            )
        ends = np.roll(self.points, -1, axis=0) if closed else self.points[1:]
        self._starts = self.points if closed else self.points[:-1]
        self._edges = ends - self._starts
        self.spacing = np.hypot(*self._edges.T)  # (edges,) m
        if not (np.isfinite(self.points).all() and (self.spacing > 0).all()):
            raise ValueError("a path's points must be finite, and differ from their neighbours")
        self._s = np.concatenate([[0.0], np.cumsum(self.spacing)])  # m, at each edge's start

    @property
    def length(self) -> float:
        """Metres from the first point to the last; of a closed path, back to the first."""
        return float(self._s[-1])

    def point(self, s: float) -> np.ndarray:
        """(x, y) at s metres; beyond the ends of an open path, the end."""
        edge, share = self._locate(s)
        return self._starts[edge] + share * self._edges[edge]

    def heading(self, s: float) -> float:
        """Direction in rad at s metres."""
        edge, _share = self._locate(s)
        return math.atan2(self._edges[edge, 1], self._edges[edge, 0])

    def nearest(self, x: float, y: float) -> NearestPoint:
        """The point of the path closest to x, y."""
        away = np.array((x, y)) - self._starts
        share = (away * self._edges).sum(axis=1) / self.spacing**2
        share = np.clip(share, 0.0, 1.0)
        gaps = away - share[:, None] * self._edges
        edge = int(np.argmin((gaps**2).sum(axis=1)))
        direction = self._edges[edge]
        side = direction[0] * gaps[edge, 1] - direction[1] * gaps[edge, 0]
        return NearestPoint(
            s=float(self._s[edge] + share[edge] * self.spacing[edge]),
            lateral=math.copysign(float(np.hypot(*gaps[edge])), side),
            heading=math.atan2(direction[1], direction[0]),
        )

    def curvature(self) -> np.ndarray:
        """(n,) 1/m, left positive, of the circle through each point and its neighbours."""
        before, here, after = self._neighbours()
        back, on = here - before, after - here
        across = back[:, 0] * on[:, 1] - back[:, 1] * on[:, 0]
        sides = np.hypot(*back.T) * np.hypot(*on.T) * np.hypot(*(after - before).T)
        inner = np.divide(2 * across, sides, out=np.zeros(len(sides)), where=sides > 0)
        if self.closed:
            return inner
        if not len(inner):
            return np.zeros(len(self.points))
        return np.concatenate([inner[:1], inner, inner[-1:]])

    def _neighbours(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        if self.closed:
            return np.roll(self.points, 1, axis=0), self.points, np.roll(self.points, -1, axis=0)
        return self.points[:-2], self.points[1:-1], self.points[2:]

    def _locate(self, s: float) -> tuple[int, float]:
        """The edge at s metres, and the share of it that lies behind."""
        s = s % self.length if self.closed else min(max(s, 0.0), self.length)
        edge = min(int(np.searchsorted(self._s, s, side="right")) - 1, len(self.spacing) - 1)
        return edge, (s - self._s[edge]) / self.spacing[edge]
