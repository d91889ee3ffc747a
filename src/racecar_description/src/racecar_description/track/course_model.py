"""Makes a Gazebo model of the course, a painted plane, from the track file."""

from __future__ import annotations

import math
import struct
import zlib

import numpy as np

from racecar_description.track.centre_line import Piece
from racecar_description.track.closed_line import Track, build_track
from racecar_description.track.errors import TrackError
from racecar_description.track.painted_plane import model_texts
from racecar_description.track.track_file import TrackFile

SIDE_PX = 2048
EDGE_MARGIN = 0.1  # m of bare plane required around every line
MODEL_URI = "model://turtlebot3_autorace/course"
BACKGROUND, WHITE, YELLOW = (10, 10, 10), (255, 255, 255), (255, 255, 0)  # RGB

DESCRIPTION = (
    "A black floor with one closed lane: yellow line on its left, white line on its right.\n"
    "Made from its track file."
)


def floor_files(track_file: TrackFile) -> dict[str, bytes]:
    """The model's four files by their paths in its folder; the same track gives the same bytes."""
    texts = model_texts(
        track_file.name,
        description=DESCRIPTION,
        size=(track_file.size, track_file.size),
        uri=MODEL_URI,
        part="course_",
    )
    picture = encode_png(draw_course(track_file))
    return {**{path: text.encode() for path, text in texts.items()},
            f"materials/textures/{track_file.name}.png": picture}


def draw_course(track_file: TrackFile, side_px: int = SIDE_PX) -> np.ndarray:
    """The plane's texture, RGB uint8: up is the plane's +y, right is its +x.

    The world file rotates the plane by model_yaw, so the lines are rotated back here: then they
    are at the track file's coordinates in the world.
    """
    yellow = build_track(track_file)
    white = yellow.offset(-track_file.lane_width)
    image = np.full((side_px, side_px, 3), BACKGROUND, np.uint8)
    for track, colour in ((white, WHITE), (yellow, YELLOW)):
        cover = _coverage(track_file, track, side_px)[..., None]
        mixed = (image * (255.0 - cover) + np.array(colour, float) * cover) / 255.0
        image = np.floor(mixed + 0.5).astype(np.uint8)
    return image


def encode_png(image: np.ndarray) -> bytes:
    """An RGB image as PNG; encoded here, because the bytes of image libraries differ."""
    height, width, _ = image.shape
    above = np.vstack([np.zeros((1, width, 3), np.uint8), image[:-1]])
    rows = np.full(
        (height, 1 + width * 3), 2, np.uint8
    )  # 2: filter Up, each byte minus the one above
    rows[:, 1:] = (image - above).reshape(height, width * 3)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = ((b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 9)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks
    )


def _coverage(track_file: TrackFile, track: Track, side_px: int) -> np.ndarray:
    """How much of each pixel the line covers, as integers from 0 to 255."""
    half, metres_per_px = track_file.size / 2, track_file.size / side_px
    reach = track_file.line_width / 2 + metres_per_px
    centres = (np.arange(side_px) + 0.5) * metres_per_px - half
    cover = np.zeros((side_px, side_px))
    for piece in track.pieces:
        turned = _turned(piece, -track_file.model_yaw)
        columns, rows = _bounds(turned, centres, reach, half)
        distance = np.round(  # so that last digits cannot change a pixel
            piece_distance(turned, centres[columns][None, :], -centres[rows][:, None]), 9)
        part = np.clip((track_file.line_width / 2 - distance) / metres_per_px + 0.5, 0.0, 1.0)
        cover[rows, columns] = np.maximum(cover[rows, columns], part)
    return np.floor(cover * 255 + 0.5)


def _turned(piece: Piece, angle: float) -> Piece:
    """The piece after a rotation of the whole course about the origin."""
    x = math.cos(angle) * piece.x - math.sin(angle) * piece.y
    y = math.sin(angle) * piece.x + math.cos(angle) * piece.y
    return Piece(x, y, piece.heading + angle, piece.length, piece.curvature)


def _bounds(piece: Piece, centres: np.ndarray, reach: float, half: float) -> tuple[slice, slice]:
    """Columns and rows of the pixels that the piece can touch."""
    count = max(2, math.ceil(piece.length / 0.01))
    points = [piece.pose(piece.length * i / (count - 1))[:2] for i in range(count)]
    (left, low), (right, high) = np.min(points, axis=0), np.max(points, axis=0)
    if max(-left, -low, right, high) > half - EDGE_MARGIN:
        raise TrackError(
            f"a line at x={piece.x:.2f}, y={piece.y:.2f} of the plane comes closer than"
            f" {EDGE_MARGIN} m to its edge"
        )
    columns = np.searchsorted(centres, (left - reach, right + reach))
    rows = np.searchsorted(centres, (-high - reach, -low + reach))
    return slice(*columns), slice(*rows)


def piece_distance(piece: Piece, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Distance (m) of points from the piece."""
    along = _straight_distance if piece.is_straight else _arc_distance
    return along(piece, x - piece.x, y - piece.y)


def _straight_distance(piece: Piece, dx: np.ndarray, dy: np.ndarray) -> np.ndarray:
    ahead = math.cos(piece.heading) * dx + math.sin(piece.heading) * dy
    left = -math.sin(piece.heading) * dx + math.cos(piece.heading) * dy
    beyond = np.maximum(np.maximum(-ahead, ahead - piece.length), 0.0)
    return np.sqrt(left * left + beyond * beyond)


def _arc_distance(piece: Piece, dx: np.ndarray, dy: np.ndarray) -> np.ndarray:
    """Distance from the circle if the point's angle is on the arc, else from the nearer end."""
    radius, side = 1.0 / abs(piece.curvature), math.copysign(1.0, piece.curvature)
    ahead = math.cos(piece.heading) * dx + math.sin(piece.heading) * dy
    inward = side * (-math.sin(piece.heading) * dx + math.cos(piece.heading) * dy)
    from_centre = np.sqrt(ahead * ahead + (radius - inward) * (radius - inward))
    angle = np.arctan2(ahead, radius - inward)
    angle = np.where(angle < piece.length / radius / 2 - math.pi, angle + 2 * math.pi, angle)
    on_arc = (angle >= 0) & (angle <= piece.length / radius)
    end_x, end_y, _ = piece.pose(piece.length)
    to_start = np.sqrt(dx * dx + dy * dy)
    ex, ey = dx + piece.x - end_x, dy + piece.y - end_y
    to_end = np.sqrt(ex * ex + ey * ey)
    return np.where(on_arc, np.abs(from_centre - radius), np.minimum(to_start, to_end))
