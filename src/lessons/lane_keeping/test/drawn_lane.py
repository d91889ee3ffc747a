"""A drawn lane with its zebra, shade and people, as the camera of the settings sees it."""

import math
from dataclasses import dataclass

import cv2
import numpy as np
from lane_keeping.road_view import road_view

LAWN, ROAD, LINE, WHITE, SKY = (
    (120, 150, 125), (130, 130, 130), (32, 32, 32), (235, 235, 235), (225, 200, 170),
)
TROUSERS, SHIRT = (150, 40, 20), (30, 120, 240)  # blue, orange; all BGR
ROAD_HALF, LINE_HALF = 0.75, 0.02  # m
PX_PER_M = 150
AHEAD, ASIDE = 4.0, 2.5  # m that are drawn, ahead of the axle and to either side
BAR, BARS = 0.12, 5  # m wide, and as wide between them; so many
STEP = 0.02  # m along the lane


@dataclass(frozen=True)
class Person:
    """A doll at (ahead, left) in m, so many m tall and wide."""

    ahead: float
    left: float
    tall: float = 0.9
    wide: float = 0.24


def lane_points(beside=0.0, turned=0.0, curvature=0.0, left=0.0, begin=-1.0, end=6.0):
    """(n, 2) m in the robot's frame of a line so far left of the lane's centre.

    The robot is `beside` m to the left of the centre and turned so much to the left; the lane
    bends by `curvature` in 1/m, left positive.
    """
    s = np.arange(begin, end, STEP)
    heading = curvature * s
    if curvature:
        x, y = np.sin(heading) / curvature, (1 - np.cos(heading)) / curvature
    else:
        x, y = s, np.zeros_like(s)
    x, y = x - left * np.sin(heading), y + left * np.cos(heading) - beside
    c, s = math.cos(turned), math.sin(turned)
    return np.stack([c * x + s * y, c * y - s * x], axis=1)


def draw(settings, beside=0.0, turned=0.0, curvature=0.0, sides=(1, -1), zebra=None, shade=(),
         people=(), light=1.0, noise=0.0, seed=0, size=(640, 480)):
    """The BGR picture. zebra: begin and end in m along the lane; shade: polygons in m."""
    where = dict(beside=beside, turned=turned, curvature=curvature)
    half = settings.lane_width / 2
    ground = np.empty((round(AHEAD * PX_PER_M), round(2 * ASIDE * PX_PER_M), 3), np.uint8)
    ground[:] = LAWN
    _strip(ground, ROAD, lane_points(left=ROAD_HALF, **where),
           lane_points(left=-ROAD_HALF, **where))
    if zebra is not None:
        for bar in range(BARS):
            left = (bar - BARS / 2 + 0.25) * 2 * BAR
            part = dict(where, begin=zebra[0], end=zebra[1])
            _strip(ground, WHITE, lane_points(left=left, **part),
                   lane_points(left=left + BAR, **part))
    for side in sides:
        _strip(ground, LINE, lane_points(left=side * half + LINE_HALF, **where),
               lane_points(left=side * half - LINE_HALF, **where))
    for polygon in shade:
        covered = cv2.fillPoly(np.zeros(ground.shape[:2], np.uint8), [_texture(polygon)], 1) > 0
        ground[covered] = (ground[covered] * 0.55).astype(np.uint8)
    image = _seen(ground, settings, size)
    for person in sorted(people, key=lambda one: -one.ahead):
        _doll(image, person, settings, size)
    if noise:
        sheet = np.random.default_rng(seed).standard_normal(image.shape, np.float32)
        return np.clip(image * np.float32(light) + 255 * noise * sheet, 0, 255).astype(np.uint8)
    return cv2.convertScaleAbs(image, alpha=light)


def _texture(points):
    """(n, 2) m to pixels of the ground's texture: row 0 is at the robot's axle."""
    points = np.asarray(points, float)
    return np.rint(
        np.stack([(ASIDE - points[:, 1]) * PX_PER_M, points[:, 0] * PX_PER_M], axis=1)
    ).astype(np.int32)


def _strip(ground, colour, one, other):
    outline = np.concatenate([one, other[::-1]])
    outline = np.stack([ASIDE - outline[:, 1], outline[:, 0]], axis=1) * PX_PER_M * 16
    cv2.fillPoly(ground, [np.rint(outline).astype(np.int32)], colour, cv2.LINE_AA, shift=4)


def _seen(ground, settings, size):
    """The texture as the camera sees it, lawn beyond it, sky above the horizon."""
    view = road_view(settings, *size)
    corners = np.array([[0.5, 1], [0.5, -1], [3.5, 1], [3.5, -1]])
    pixels = view.to_picture(corners)
    turn = cv2.getPerspectiveTransform(
        _texture(corners).astype(np.float32), pixels.astype(np.float32)
    )
    image = cv2.warpPerspective(ground, turn, size, flags=cv2.INTER_LINEAR, borderValue=LAWN)
    image[: max(round(view.horizon), 0)] = SKY
    return image


def _doll(image, person, settings, size):
    view = road_view(settings, *size)
    sides = np.array([[person.ahead, person.left + person.wide / 2],
                      [person.ahead, person.left - person.wide / 2]])
    hips = person.tall * 0.5
    for low, high, colour in ((0.0, hips, TROUSERS), (hips, person.tall, SHIRT)):
        feet, top = view.to_picture(sides, low), view.to_picture(sides, high)
        corners = np.concatenate([feet, top[::-1]])
        if np.isfinite(corners).all():
            cv2.fillConvexPoly(image, np.rint(corners).astype(np.int32), colour)
