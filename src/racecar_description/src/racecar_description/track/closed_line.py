"""A track's geometry: a closed line of straights and arcs, starting at a track file's `start`."""

from __future__ import annotations

import math
from bisect import bisect_left
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path

from racecar_description.track.centre_line import CentreLine, Piece
from racecar_description.track.errors import TrackError
from racecar_description.track.track_file import TrackFile, load_track_file

CLOSED_WITHIN = 1e-9  # m and rad, between the end of the last piece and the start of the first


@dataclass(frozen=True)
class NearestPoint:
    """The line's point nearest to a place: m along it, and the place's m to its left."""

    s: float
    lateral: float


class Track:
    """A closed line; s runs from 0 at its start to `length`, then wraps."""

    def __init__(self, pieces: tuple[Piece, ...]):
        self.pieces = pieces
        self.begins = tuple(accumulate((piece.length for piece in pieces[:-1]), initial=0.0))
        self._ends = tuple(begin + piece.length
                           for begin, piece in zip(self.begins, pieces, strict=True))
        self.length = self._ends[-1]
        # A circle around each piece, about its middle: x, y and radius, m.
        self._around = tuple((*piece.pose(piece.length / 2)[:2], piece.length / 2)
                             for piece in pieces)
        self._check_closed()

    def _check_closed(self) -> None:
        for before, after in zip(self.pieces, self.pieces[1:] + self.pieces[:1], strict=True):
            x, y, heading = before.pose(before.length)
            turn = math.remainder(heading - after.heading, 2 * math.pi)
            gap = max(math.hypot(x - after.x, y - after.y), abs(turn))
            if gap > CLOSED_WITHIN:
                raise TrackError(f"the line has a gap of {gap:.3g} at x={x:.3f}, y={y:.3f}")

    def pose(self, s: float) -> tuple[float, float, float]:
        """x, y (m) and heading (rad) at s; s may be beyond one lap, or negative."""
        s %= self.length
        i = bisect_left(self._ends, s)
        return self.pieces[i].pose(s - self.begins[i])

    def nearest(self, x: float, y: float) -> NearestPoint:
        """The line's point closest to x, y."""
        best_distance, best = math.inf, NearestPoint(0.0, 0.0)
        for index in self._may_be_nearest(x, y):
            piece = self.pieces[index]
            s = piece.nearest(x, y)
            px, py, heading = piece.pose(s)
            distance = math.hypot(x - px, y - py)
            if distance < best_distance:
                cross = math.cos(heading) * (y - py) - math.sin(heading) * (x - px)
                best_distance = distance
                best = NearestPoint((self.begins[index] + s) % self.length,
                                    math.copysign(distance, cross))
        return best

    def _may_be_nearest(self, x: float, y: float) -> list[int]:
        """Numbers of the pieces on which the point closest to x, y may be: those whose circle is
        not farther away than the most that one of the others' can be."""
        away = [math.hypot(x - cx, y - cy) for cx, cy, _ in self._around]
        most = min(away) + CLOSED_WITHIN  # the middle of a piece is on the line
        return [index for index, (gap, (_, _, radius)) in
                enumerate(zip(away, self._around, strict=True)) if gap - radius <= most]

    def offset(self, left: float) -> Track:
        """The closed line this far to the left (negative: to the right)."""
        return Track(tuple(piece.offset(left) for piece in self.pieces))

    def points(self, spacing: float = 0.02) -> list[tuple[float, float]]:
        """Points along the whole line, for drawing."""
        count = math.ceil(self.length / spacing)
        return [self.pose(i * self.length / count)[:2] for i in range(count)]


def load_track(path: str | Path) -> Track:
    """A track file's yellow line, starting at its `start`."""
    return build_track(load_track_file(path), str(path))


def build_track(track_file: TrackFile, place: str = "track") -> Track:
    """Round the polygon's corners and start the closed line at `start`."""
    try:
        closed = Track(CentreLine(track_file.corners).pieces)
    except TrackError as error:
        raise TrackError(f"{place}: {error}") from error
    start = closed.nearest(*track_file.start)
    if abs(start.lateral) > 1e-6:
        raise TrackError(f"{place}: start: {abs(start.lateral):.3f} m beside the line")
    return Track(_starting_at(closed, start.s))


def _starting_at(track: Track, s: float) -> tuple[Piece, ...]:
    """The same line, cut at s: the piece there becomes the first one and, in part, the last."""
    index = max(i for i, begin in enumerate(track.begins) if begin <= s + CLOSED_WITHIN)
    split, done = track.pieces[index], s - track.begins[index]
    rest = track.pieces[index + 1 :] + track.pieces[:index]
    if done < CLOSED_WITHIN:
        return (split, *rest)
    if split.length - done < CLOSED_WITHIN:
        return (*rest, split)
    first = Piece(*split.pose(done), split.length - done, split.curvature)
    return (first, *rest, Piece(split.x, split.y, split.heading, done, split.curvature))
