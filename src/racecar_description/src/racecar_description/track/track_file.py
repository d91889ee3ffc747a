"""A course's line as a YAML file: a polygon with corners rounded by arcs."""

from __future__ import annotations

import math
import reprlib
from dataclasses import dataclass, fields
from pathlib import Path

import yaml
from node_basics.bounded_yaml import BoundedLoader

from racecar_description.track.centre_line import CentreLine, Corner
from racecar_description.track.errors import TrackError

MOST = 1e4  # m, of any number; on a line of millions of km a nearest-point search takes minutes


@dataclass(frozen=True)
class TrackFile:
    """A track's YAML, key by key; m, in the world frame; driven in the order of the corners."""

    name: str
    size: float  # the longer side of the plane that the course is painted on
    model_yaw: float  # rad, the plane's yaw in the world file
    line_width: float  # of the painted line
    lane_width: float  # from the middle of that line to the middle of the lane's other line
    start: tuple[float, float]  # where laps start, on the line
    corners: tuple[Corner, ...]  # of the line


def load_track_file(path: str | Path) -> TrackFile:
    """Read and check a track file; an error is a TrackError that names file and key."""
    path = Path(path)
    try:
        values = yaml.load(path.read_text(encoding="utf-8"), BoundedLoader)
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "not a text file"
        raise TrackError(f"{path}: {reason}") from error
    except Exception as error:  # PyYAML also raises KeyError, IndexError and more
        raise TrackError(f"{path}: not valid YAML: {' '.join(str(error).split())[:200]}") from error
    try:
        return _track_file(values)
    except TrackError as error:
        raise TrackError(f"{path}: {error}") from error


def load_centre_line(path: Path) -> tuple[TrackFile, CentreLine]:
    """A track file and its line; TrackError also if bends overlap or `start` is off the line."""
    track = load_track_file(path)
    try:
        line = CentreLine(track.corners)
        _check_start(track, line)
    except TrackError as error:
        raise TrackError(f"{path}: {error}") from error
    return track, line


def _track_file(values: object) -> TrackFile:
    _check_keys("", values, TrackFile)
    corners = values["corners"]
    if not isinstance(corners, list) or len(corners) < 3:
        raise TrackError("corners: at least three are needed, as a list")
    start = values["start"]
    if not isinstance(start, list) or len(start) != 2:
        raise TrackError(f"start: must be [x, y], is {_shown(start)}")
    return TrackFile(
        name=_name(values["name"]),
        size=_number("size", values["size"], positive=True),
        model_yaw=_number("model_yaw", values["model_yaw"]),
        line_width=_number("line_width", values["line_width"], positive=True),
        lane_width=_number("lane_width", values["lane_width"], positive=True),
        start=(_number("start[0]", start[0]), _number("start[1]", start[1])),
        corners=tuple(_corner(f"corners[{i}]", item) for i, item in enumerate(corners)),
    )


def _name(value: object) -> str:
    if isinstance(value, list | dict):
        raise TrackError(f"name: must be text, is {_shown(value)}")
    return str(value)


def _shown(value: object) -> str:
    """A value for a message; expanded YAML aliases can be a billion times as long as the file."""
    return reprlib.repr(value)[:80]


def _check_start(track: TrackFile, line: CentreLine) -> None:
    x, y, _ = line.pose(line.nearest(*track.start))
    beside = math.hypot(x - track.start[0], y - track.start[1])
    if beside > 1e-6:
        raise TrackError(
            f"start: {beside:.3f} m beside the line; its nearest point is [{x:.9f}, {y:.9f}]"
        )


def _corner(place: str, values: object) -> Corner:
    _check_keys(place, values, Corner)
    return Corner(
        x=_number(f"{place}.x", values["x"]),
        y=_number(f"{place}.y", values["y"]),
        radius=_number(f"{place}.radius", values["radius"], positive=True),
    )


def _check_keys(place: str, values: object, schema: type) -> None:
    expected = [field.name for field in fields(schema)]
    where = f"{place}: " if place else ""
    if not isinstance(values, dict):
        raise TrackError(f"{where}must have the keys {', '.join(expected)}")
    for key in values:
        if key not in expected:
            raise TrackError(f"{where}unknown key {_shown(key)}; there are: {', '.join(expected)}")
    for key in expected:
        if key not in values:
            raise TrackError(f"{where}key {key!r} is missing")


def _number(place: str, value: object, positive: bool = False) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= MOST:
        raise TrackError(f"{place}: must be a number up to {MOST:g}, is {_shown(value)}")
    if positive and value <= 0:
        raise TrackError(f"{place}: must be more than 0, is {_shown(value)}")
    return float(value)


def track_text(track: TrackFile, source: str) -> str:
    """The file's text; `load_track_file` reads the same numbers. `source`: what it is made from."""
    lines = [
        f"# The centre line of a race track, made by make_track from {source}.",
        "# A polygon whose corners are rounded by arcs, driven in the order of the corners.",
        f"name: {track.name}",
        f"size: {_text(track.size)}  # m, the longer side of the painted plane",
        f"model_yaw: {_text(track.model_yaw)}  # rad, how the world turns that plane",
        f"line_width: {_text(track.line_width)}  # m, of the centre line",
        f"lane_width: {_text(track.lane_width)}  # m, middle of the centre line to that of an edge",
        f"start: [{', '.join(map(_text, track.start))}]  # m, where a lap begins and ends",
        "corners:  # m",
    ]
    for corner in track.corners:
        x, y, radius = map(_text, (corner.x, corner.y, corner.radius))
        lines.append(f"  - {{x: {x}, y: {y}, radius: {radius}}}")
    return "\n".join(lines) + "\n"


def _text(value: float) -> str:
    """All digits, without an exponent: YAML 1.1 reads 1e-05 as a word."""
    text = repr(float(value))
    return f"{value:.15f}" if "e" in text else text
