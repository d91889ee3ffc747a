"""The racetrack's road and its start line, painted.

Reads tracks/racetrack.yaml (m, world frame) and writes the textures of models/racetrack and
models/smartcar_plane. The road's colours only depend on the distance to its centre line.
"""

from pathlib import Path

import numpy as np
import yaml
from racecar_description.track.closed_line import build_track
from racecar_description.track.course_model import encode_png, piece_distance
from racecar_description.track.track_file import load_track_file

PACKAGE = "src/racecar_description"
TRACK = Path(__file__).resolve().parents[2] / PACKAGE / "tracks/racetrack.yaml"
PX_PER_M = 256
EDGE_LINE = 0.03  # m, width of the road's edge lines
VERGE = 0.03  # m of asphalt outside them
MOWN = 0.5  # m, width of the lawn's stripes, which make the speed visible
PLATE_CHECKS, CHECK_PX = (6, 16), 12  # squares along and across the road; a square's side

LAWNS = ((62, 104, 58), (70, 114, 64))  # RGB
ASPHALT, YELLOW, WHITE, BLACK = (52, 53, 56), (250, 205, 20), (235, 235, 235), (20, 20, 20)


def distance_to_line(pieces, x, y):
    """Distance (m) of points from the closed line; rounded, so that last digits have no effect."""
    return np.round(np.min([piece_distance(piece, x, y) for piece in pieces], axis=0), 7)


def paint(image, cover, colour):
    """Blend a colour into the image, with an opacity of 0 to 1 per pixel."""
    whole = np.floor(np.clip(cover, 0, 1) * 255 + 0.5)[..., None]
    mixed = (image * (255 - whole) + np.array(colour, float) * whole) / 255
    image[:] = np.floor(mixed + 0.5).astype(np.uint8)


def draw_track(track):
    """The plane's texture, RGB: up is +y, right is +x."""
    corners = np.array([(corner["x"], corner["y"]) for corner in track["corners"]])
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle = np.round((low + high) / 2, 6)
    half_x, half_y = track["size"] / 2, round((high - low)[1] / 2, 6) + 0.8
    x = middle[0] - half_x + (np.arange(round(2 * half_x * PX_PER_M)) + 0.5) / PX_PER_M
    y = middle[1] + half_y - (np.arange(round(2 * half_y * PX_PER_M)) + 0.5) / PX_PER_M
    image = np.empty((len(y), len(x), 3), np.uint8)
    image[:] = np.where(np.floor(x / MOWN)[:, None] % 2 == 0, *np.array(LAWNS, np.uint8)[:, None])
    pieces = build_track(load_track_file(TRACK)).pieces
    for rows in np.array_split(np.arange(len(y)), 16):
        distance = distance_to_line(pieces, x[None, :], y[rows][:, None])
        part = image[rows]
        half = track["lane_width"] + EDGE_LINE / 2 + VERGE
        paint(part, (half - distance) * PX_PER_M + 0.5, ASPHALT)
        from_edge = np.abs(distance - track["lane_width"])
        paint(part, (EDGE_LINE / 2 - from_edge) * PX_PER_M + 0.5, WHITE)
        paint(part, (track["line_width"] / 2 - distance) * PX_PER_M + 0.5, YELLOW)
        image[rows] = part
    return image


def draw_start_line(track):
    """A chequered plate, RGB, crossed by the road's yellow line."""
    along, across = PLATE_CHECKS
    row, column = np.indices((across * CHECK_PX, along * CHECK_PX))
    dark = (row // CHECK_PX + column // CHECK_PX) % 2 == 0
    image = np.where(dark[..., None], BLACK, WHITE).astype(np.uint8)
    from_middle = np.abs(row + 0.5 - across * CHECK_PX / 2)
    paint(image, track["line_width"] / 2 * PX_PER_M - from_middle + 0.5, YELLOW)
    return image


def files() -> dict[str, bytes]:
    """The files' bytes by path in the repository."""
    track = yaml.safe_load(TRACK.read_text(encoding="utf-8"))
    return {f"{PACKAGE}/models/{name}/materials/textures/{name}.png": encode_png(draw(track))
            for name, draw in (("racetrack", draw_track), ("smartcar_plane", draw_start_line))}
