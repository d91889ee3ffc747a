"""The course as geometry: a closed line of straights and arcs, from YAML, in the world frame."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from pathlib import Path

import yaml

CLOSED_WITHIN = 1e-9  # m and rad, between the end of the last piece and the start of the first


class TrackError(Exception):
    """A track file that cannot be read, or a line that cannot be built from it."""


@dataclass(frozen=True)
class Corner:
    """One corner of the polygon that the line follows, rounded by an arc of this radius."""

    x: float
    y: float
    radius: float


@dataclass(frozen=True)
class TrackFile:
    """A track's YAML, key by key; m in the world frame, driven in the order of the corners."""

    name: str
    size: float  # side of the square plane that the course is painted on
    model_yaw: float  # rad, how the world file turns that plane
    line_width: float
    lane_width: float  # from the centre of the yellow line to the centre of the white one
    start: tuple[float, float]  # where laps begin, on the yellow line
    corners: tuple[Corner, ...]  # of the yellow line


@dataclass(frozen=True)
class Piece:
    """A straight (curvature 0) or an arc (1/radius, positive to the left) from a pose onwards."""

    x: float
    y: float
    heading: float
    length: float
    curvature: float

    def pose(self, s: float) -> tuple[float, float, float]:
        """x, y and heading after s metres of this piece."""
        turned = self.heading + self.curvature * s
        if abs(self.curvature) < 1e-12:
            return (self.x + s * math.cos(turned), self.y + s * math.sin(turned), turned)
        radius = 1.0 / self.curvature
        x = self.x + radius * (math.sin(turned) - math.sin(self.heading))
        y = self.y - radius * (math.cos(turned) - math.cos(self.heading))
        return x, y, turned

    def nearest(self, x: float, y: float) -> float:
        """Length along this piece at which it comes closest to the point."""
        ahead = math.cos(self.heading) * (x - self.x) + math.sin(self.heading) * (y - self.y)
        if abs(self.curvature) < 1e-12:
            return min(max(ahead, 0.0), self.length)
        left = -math.sin(self.heading) * (x - self.x) + math.cos(self.heading) * (y - self.y)
        side = math.copysign(1.0, self.curvature)
        radius = 1.0 / abs(self.curvature)
        angle = math.atan2(ahead, radius - side * left)
        whole = self.length / radius
        # The arc's blind side is split in the middle: half of it is nearer to each end.
        if angle < whole / 2 - math.pi:
            angle += 2 * math.pi
        return min(max(angle, 0.0), whole) * radius

    def offset(self, left: float) -> Piece:
        """The parallel piece this far to the left (negative: to the right)."""
        scale = 1.0 - self.curvature * left
        if scale <= 0:
            raise TrackError(
                f"no line {left:+.3f} m beside a bend of radius {1 / abs(self.curvature):.3f} m"
            )
        x = self.x - left * math.sin(self.heading)
        y = self.y + left * math.cos(self.heading)
        return Piece(x, y, self.heading, self.length * scale, self.curvature / scale)


@dataclass(frozen=True)
class NearestPoint:
    """Where on the line a point belongs: m along it, and m to its left (negative: right)."""

    s: float
    lateral: float


class Track:
    """A closed line; s runs from 0 at its start to `length`, and wraps."""

    def __init__(self, pieces: tuple[Piece, ...]):
        self.pieces = pieces
        self.begins = tuple(sum(piece.length for piece in pieces[:i]) for i in range(len(pieces)))
        self.length = sum(piece.length for piece in pieces)
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
        for begin, piece in zip(self.begins, self.pieces, strict=True):
            if s <= begin + piece.length:
                return piece.pose(s - begin)
        return self.pieces[0].pose(0.0)

    def nearest(self, x: float, y: float) -> NearestPoint:
        """The point of the line closest to x, y."""
        best_distance, best = math.inf, NearestPoint(0.0, 0.0)
        for begin, piece in zip(self.begins, self.pieces, strict=True):
            s = piece.nearest(x, y)
            px, py, heading = piece.pose(s)
            distance = math.hypot(x - px, y - py)
            if distance < best_distance:
                cross = math.cos(heading) * (y - py) - math.sin(heading) * (x - px)
                best_distance = distance
                best = NearestPoint((begin + s) % self.length, math.copysign(distance, cross))
        return best

    def offset(self, left: float) -> Track:
        """The closed line this far to the left (negative: to the right)."""
        return Track(tuple(piece.offset(left) for piece in self.pieces))

    def points(self, spacing: float = 0.02) -> list[tuple[float, float]]:
        """Points all along the line, for drawing."""
        count = math.ceil(self.length / spacing)
        return [self.pose(i * self.length / count)[:2] for i in range(count)]


def load_track_file(path: str | Path) -> TrackFile:
    """Read and check a track file; each mistake is one TrackError that names file and key."""
    path = Path(path)
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise TrackError(f"{path}: {error.strerror}") from error
    except yaml.YAMLError as error:
        raise TrackError(f"{path}: no YAML: {' '.join(str(error).split())}") from error
    _check_keys(path, "", values, TrackFile)
    if not isinstance(values["corners"], list) or len(values["corners"]) < 3:
        raise TrackError(f"{path}: corners: at least three are needed, as a list")
    corners = tuple(
        _read_corner(path, f"corners[{i}]", item) for i, item in enumerate(values["corners"])
    )
    start = values["start"]
    if not isinstance(start, list) or len(start) != 2:
        raise TrackError(f"{path}: start: must be [x, y], is {start!r}")
    lengths = ("size", "line_width", "lane_width")
    return TrackFile(
        name=str(values["name"]),
        model_yaw=_number(path, "model_yaw", values["model_yaw"]),
        start=(_number(path, "start[0]", start[0]), _number(path, "start[1]", start[1])),
        corners=corners,
        **{key: _number(path, key, values[key], positive=True) for key in lengths},
    )


def load_track(path: str | Path) -> Track:
    """The yellow line of a track file, starting at its `start`."""
    return build_track(load_track_file(path), str(path))


def build_track(track_file: TrackFile, place: str = "track") -> Track:
    """Round the corners of the polygon and start the closed line at `start`."""
    pieces = _round_corners(track_file.corners, place)
    closed = Track(tuple(pieces))
    start = closed.nearest(*track_file.start)
    if abs(start.lateral) > 1e-6:
        raise TrackError(f"{place}: start: {abs(start.lateral):.3f} m beside the line")
    return Track(_starting_at(closed, start.s))


def _read_corner(path: Path, place: str, values: object) -> Corner:
    _check_keys(path, place, values, Corner)
    return Corner(
        x=_number(path, f"{place}.x", values["x"]),
        y=_number(path, f"{place}.y", values["y"]),
        radius=_number(path, f"{place}.radius", values["radius"], positive=True),
    )


def _check_keys(path: Path, place: str, values: object, schema: type) -> None:
    expected = [field.name for field in fields(schema)]
    where = f"{path}: {place}: " if place else f"{path}: "
    if not isinstance(values, dict):
        raise TrackError(f"{where}must have the keys {', '.join(expected)}")
    for key in values:
        if key not in expected:
            raise TrackError(f"{where}unknown key {key!r}; there are: {', '.join(expected)}")
    for key in expected:
        if key not in values:
            raise TrackError(f"{where}key {key!r} is missing")


def _number(path: Path, place: str, value: object, positive: bool = False) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise TrackError(f"{path}: {place}: must be a number, is {value!r}")
    if positive and value <= 0:
        raise TrackError(f"{path}: {place}: must be more than 0, is {value!r}")
    return float(value)


def _round_corners(corners: tuple[Corner, ...], place: str) -> list[Piece]:
    """A straight and an arc for each corner, in order; straights of no length are left out."""
    count = len(corners)
    edges = [
        (corners[(i + 1) % count].x - corners[i].x, corners[(i + 1) % count].y - corners[i].y)
        for i in range(count)
    ]
    headings = [math.atan2(dy, dx) for dx, dy in edges]
    turns = [math.remainder(headings[i] - headings[i - 1], 2 * math.pi) for i in range(count)]
    cut = [corners[i].radius * math.tan(abs(turns[i]) / 2) for i in range(count)]
    pieces = []
    for i in range(count):
        straight = math.hypot(*edges[i]) - cut[i] - cut[(i + 1) % count]
        if straight < -CLOSED_WITHIN:
            raise TrackError(
                f"{place}: corners[{i}] and [{(i + 1) % count}]:"
                f" the bends overlap by {-straight:.3f} m"
            )
        pieces += _corner_pieces(
            corners[i], headings[i - 1], headings[i], turns[i], cut[i], straight
        )
    return pieces


def _corner_pieces(
    corner: Corner, arriving: float, leaving: float, turn: float, cut: float, straight: float
) -> list[Piece]:
    """The arc round one corner and the straight after it."""
    pieces = []
    if abs(turn) > CLOSED_WITHIN:
        x = corner.x - cut * math.cos(arriving)
        y = corner.y - cut * math.sin(arriving)
        curvature = math.copysign(1.0 / corner.radius, turn)
        pieces.append(Piece(x, y, arriving, abs(turn) * corner.radius, curvature))
    if straight > CLOSED_WITHIN:
        x = corner.x + cut * math.cos(leaving)
        y = corner.y + cut * math.sin(leaving)
        pieces.append(Piece(x, y, leaving, straight, 0.0))
    return pieces


def _starting_at(track: Track, s: float) -> tuple[Piece, ...]:
    """The same line, cut open at s: the piece there becomes the first and, in part, the last."""
    index = max(i for i, begin in enumerate(track.begins) if begin <= s + CLOSED_WITHIN)
    split, done = track.pieces[index], s - track.begins[index]
    rest = track.pieces[index + 1 :] + track.pieces[:index]
    if done < CLOSED_WITHIN:
        return (split, *rest)
    if split.length - done < CLOSED_WITHIN:
        return (*rest, split)
    first = Piece(*split.pose(done), split.length - done, split.curvature)
    return (first, *rest, Piece(split.x, split.y, split.heading, done, split.curvature))
