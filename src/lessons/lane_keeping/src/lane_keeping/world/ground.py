"""The ground's texture: lawn, road, lane lines, zebra crossings, shade."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from racecar_description.track.closed_line import build_track
from racecar_description.track.track_file import TrackFile

from lane_keeping.world.scenery import Crossings, Scenery, Zebra

PX_PER_M, FINE = 160, 2  # drawn FINE times as large, then shrunk, for smooth edges
MARGIN = 1.3  # m of ground round the lane's middle
VERGE = 0.35  # m of road outside the lane's lines
STRIPE = 0.1  # m, width of a zebra's stripes and of the gaps between them
MOWN = 0.5  # m, width of the lawn's stripes, which make the speed visible
# RGB. Lawn and road are equally bright: only lines are darker than their surroundings.
LAWNS, ROAD, LINE, WHITE = ((120, 139, 105), (125, 144, 110)), (127, 127, 129), (30, 30, 33), (
    236, 236, 236)
TRUNK, POLE, LAMP_HEAD = 0.12, 0.07, 0.16  # m, widths of objects that cast shade
PENUMBRA = 0.04  # m


@dataclass(frozen=True)
class Plane:
    """The painted part of the ground; m in the world, sides along x and y."""

    x: float  # its centre
    y: float
    width: float
    height: float

    def to_px(self, points: np.ndarray) -> np.ndarray:
        """World points (n, 2) in pixels (n, 2) of the fine image; up is +y, right is +x."""
        corner = (self.x - self.width / 2, self.y + self.height / 2)
        return (np.asarray(points, float).reshape(-1, 2) - corner) * (_SCALE, -_SCALE)


def plane_of(track_file: TrackFile) -> Plane:
    """The ground of a track, with its margin."""
    points = np.array(build_track(track_file).points(0.1))
    low, high = points.min(axis=0) - MARGIN, points.max(axis=0) + MARGIN
    low, high = np.round(low, 1), np.round(high, 1)
    return Plane(*((low + high) / 2), *(high - low))


def draw_ground(track_file: TrackFile, crossings: Crossings, scenery: Scenery | None) -> np.ndarray:
    """The plane's texture, RGB uint8; without scenery there is no shade."""
    plane = plane_of(track_file)
    columns, rows = round(plane.width * _SCALE), round(plane.height * _SCALE)
    mown = (np.arange(columns) // round(MOWN * _SCALE)) % 2
    image = np.empty((rows, columns, 3), np.uint8)
    image[:] = np.array(LAWNS, np.uint8)[mown]
    middle = build_track(track_file)
    road = 2 * (track_file.lane_width + track_file.line_width / 2 + VERGE)
    _draw(image, plane, middle.points(), ROAD, road)
    for zebra in crossings.zebras:
        _draw_zebra(image, plane, zebra, crossings)
    for side in (-1, 1):
        line = middle.offset(side * track_file.lane_width)
        _draw(image, plane, line.points(), LINE, track_file.line_width)
    if scenery is not None:
        light = 1 - (1 - scenery.shade) * _shade(image.shape[:2], plane, scenery)
        image = (image * light[..., None] + 0.5).astype(np.uint8)
    return cv2.resize(image, (columns // FINE, rows // FINE), interpolation=cv2.INTER_AREA)


_SCALE = PX_PER_M * FINE


def _draw(image: np.ndarray, plane: Plane, points: list, colour: object, width: float) -> None:
    _line(image, plane.to_px(points), colour, round(width * _SCALE), closed=True)


def _line(image: np.ndarray, points_px: np.ndarray, colour: object, thick_px: int,
          closed: bool = False) -> None:
    """A line through subpixel points, which OpenCV takes in sixteenths."""
    cv2.polylines(image, [np.round(points_px * 16).astype(np.int32)], closed, colour, thick_px,
                  cv2.LINE_AA, 4)


def _draw_zebra(image: np.ndarray, plane: Plane, zebra: Zebra, crossings: Crossings) -> None:
    """Stripes along the road, from one end of the crossing to the other."""
    ahead = np.array((math.cos(zebra.heading), math.sin(zebra.heading)))
    left = np.array((-ahead[1], ahead[0]))
    count = 2 * math.floor(crossings.half_width / STRIPE / 2)  # the lines run between stripes
    for number in range(-count, count + 1, 2):
        middle = (zebra.x, zebra.y) + number * STRIPE * left
        corners = [middle + a * crossings.length / 2 * ahead + b * STRIPE / 2 * left
                   for a, b in ((-1, -1), (-1, 1), (1, 1), (1, -1))]
        cv2.fillPoly(image, [np.round(plane.to_px(corners)).astype(np.int32)], WHITE, cv2.LINE_AA)


def _shade(shape: tuple[int, int], plane: Plane, scenery: Scenery) -> np.ndarray:
    """How much of the sun is covered, 0 to 1, for each pixel."""
    cover = np.zeros(shape, np.uint8)
    for tree in scenery.trees:
        _stroke(cover, plane, scenery, (tree.x, tree.y), tree.height, TRUNK)
        _blot(cover, plane, scenery, (tree.x, tree.y), tree.height, tree.crown)
    for lamp in scenery.lamps:
        _stroke(cover, plane, scenery, (lamp.x, lamp.y), lamp.height, POLE)
        _blot(cover, plane, scenery, (lamp.x, lamp.y), lamp.height, LAMP_HEAD)
    return cv2.GaussianBlur(cover, (0, 0), PENUMBRA * _SCALE).astype(np.float32) / 255


def _stroke(cover: np.ndarray, plane: Plane, scenery: Scenery, at: tuple[float, float],
            height: float, width: float) -> None:
    """The shade of something thin and upright."""
    ends = plane.to_px([at, scenery.shadow_of(*at, height)])
    _line(cover, ends, 255, round(width * _SCALE))


def _blot(cover: np.ndarray, plane: Plane, scenery: Scenery, at: tuple[float, float],
          height: float, radius: float) -> None:
    """The shade of a ball: an ellipse, elongated along the sun's direction."""
    centre = np.round(plane.to_px([scenery.shadow_of(*at, height)])[0]).astype(int)
    level = math.hypot(*scenery.sun[:2])
    longer = math.hypot(level, scenery.sun[2]) / abs(scenery.sun[2])
    turned = -math.degrees(math.atan2(scenery.sun[1], scenery.sun[0]))  # the image's y is down
    axes = (round(radius * longer * _SCALE), round(radius * _SCALE))
    cv2.ellipse(cover, tuple(int(value) for value in centre), axes, turned, 0, 360, 255, -1)
