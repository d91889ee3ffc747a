"""A course's line as a YAML file: a polygon with corners rounded by arcs."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

from node_basics.bounded_yaml import BoundedLoader
from node_basics.records import Must, are, read_yaml, to_record

from racecar_description.track.centre_line import (
    CentreLine,
    Coordinate,
    Corner,
    Size,
    is_coordinate,
)
from racecar_description.track.errors import TrackError

Name = Annotated[str, Must("a text", lambda value: not isinstance(value, list | dict))]
Place = Annotated[tuple[float, float], Must("[x, y]", lambda value: are(value, is_coordinate, 2))]


@dataclass(frozen=True)
class TrackFile:
    """A track's YAML, key by key; m, in the world frame; driven in the order of the corners."""

    name: Name
    size: Size  # the longer side of the plane that the course is painted on
    model_yaw: Coordinate  # rad, the plane's yaw in the world file
    line_width: Size  # of the painted line
    lane_width: Size  # from the middle of that line to the middle of the lane's other line
    start: Place  # where laps start, on the line
    corners: tuple[Corner, ...]  # of the line


def load_track_file(path: str | Path) -> TrackFile:
    """Read and check a track file; an error is a TrackError that names file and key."""
    path = Path(path)
    track = to_record(TrackFile, read_yaml(path, TrackError, BoundedLoader), path, TrackError)
    if len(track.corners) < 3:
        raise TrackError(f"{path}: corners: at least three are needed")
    return replace(track, name=str(track.name))


def load_centre_line(path: Path) -> tuple[TrackFile, CentreLine]:
    """A track file and its line; TrackError also if bends overlap or `start` is off the line."""
    track = load_track_file(path)
    try:
        line = CentreLine(track.corners)
        _check_start(track, line)
    except TrackError as error:
        raise TrackError(f"{path}: {error}") from error
    return track, line


def _check_start(track: TrackFile, line: CentreLine) -> None:
    x, y, _ = line.pose(line.nearest(*track.start))
    beside = math.hypot(x - track.start[0], y - track.start[1])
    if beside > 1e-6:
        raise TrackError(
            f"start: {beside:.3f} m beside the line; its nearest point is [{x:.9f}, {y:.9f}]"
        )


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
