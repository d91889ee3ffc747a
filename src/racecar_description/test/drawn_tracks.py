"""Draws pictures of tracks as people draw them: clean, by hand, with coffee, open, crossing.

All are BGR, 1200 x 800 px unless they say otherwise; at 12 x 8 m a pixel is a centimetre.
`python3 drawn_tracks.py FOLDER` writes them all as PNG, to be looked at.
"""

import sys
from pathlib import Path

import cv2
import numpy as np

WIDTH_PX, HEIGHT_PX = 1200, 800
PAPER, INK = (255, 255, 255), (30, 30, 30)
ROAD_PX = 80
BEAN = [  # corners of a smooth bean-shaped circuit, px
    (250, 620), (600, 660), (980, 620), (1060, 400), (960, 190), (740, 230), (600, 360),
    (430, 220), (210, 190), (130, 400)]


def blank(shape_px=(HEIGHT_PX, WIDTH_PX), colour=PAPER):
    """White paper."""
    return np.full((*shape_px, 3), colour, np.uint8)


def closed_curve(corners, count=1200):
    """(count, 2) points of the smooth closed curve (cubic B-spline) that corners (px) pull."""
    corners = np.array(corners, float)
    place = np.arange(count) * len(corners) / count
    i, t = place.astype(int), (place % 1)[:, None]
    p = [corners[(i + k) % len(corners)] for k in (-1, 0, 1, 2)]
    return (
        (1 - t) ** 3 * p[0] + (3 * t**3 - 6 * t**2 + 4) * p[1]
        + (-3 * t**3 + 3 * t**2 + 3 * t + 1) * p[2] + t**3 * p[3]) / 6


def stroke(picture, points, width_px=ROAD_PX, colour=INK, closed=True):
    """A thick line through points."""
    fixed = np.round(np.asarray(points, float) * 16).astype(np.int32)
    cv2.polylines(picture, [fixed], closed, colour, width_px, cv2.LINE_AA, 4)
    return picture


def circle(radius_px=300, centre=(600, 400), width_px=ROAD_PX):
    """A ring."""
    picture = blank()
    cv2.circle(picture, centre, radius_px, INK, width_px, cv2.LINE_AA)
    return picture


def ellipse(half_axes=(450, 280), centre=(600, 400), width_px=ROAD_PX):
    """A ring drawn along an ellipse."""
    angle = np.linspace(0, 2 * np.pi, 2000, endpoint=False)
    points = np.column_stack((np.cos(angle), np.sin(angle))) * half_axes + centre
    return stroke(blank(), points, width_px)


def bean():
    """A clean circuit with bends to both sides."""
    return stroke(blank(), closed_curve(BEAN))


def by_hand(seed=1):
    """The bean on a photo: ragged ink, paper in a shadow, grain, crumbs, gaps, a coffee ring."""
    random = np.random.default_rng(seed)
    picture = blank().astype(float)
    ink = np.zeros((HEIGHT_PX, WIDTH_PX), np.uint8)
    points = closed_curve(BEAN)
    for _ in range(3):  # three strokes over one another, none exact
        waves = random.normal(0, 1, (2, 40))
        shift = np.column_stack([_wave(len(points), wave) for wave in waves])
        stroke(ink, points + 1.2 * shift, ROAD_PX - 6, 255)
    for x, y in points[random.integers(0, len(points), 40)]:  # the pen has missed spots
        cv2.circle(ink, (int(x + random.normal(0, 25)), int(y + random.normal(0, 25))),
                   int(random.integers(2, 6)), 0, -1)
    across = 1.5 * (points[310] - points[290])[::-1] * (1, -1)
    ends = [tuple(int(v) for v in points[300] + side * across) for side in (-1, 1)]
    cv2.line(ink, *ends, 0, 9)  # the pen was lifted
    for _ in range(60):  # crumbs
        at = random.integers((0, 0), (WIDTH_PX, HEIGHT_PX))
        cv2.circle(ink, tuple(at.tolist()), int(random.integers(1, 5)), 255, -1)
    picture *= coffee_stain((430, 470), 130, random) * coffee_stain((980, 690), 90, random)
    cover = cv2.GaussianBlur(ink, (0, 0), 1.2)[..., None] / 255.0
    picture = picture * (1 - cover) + np.array((60.0, 45.0, 40.0)) * cover
    rows, columns = np.mgrid[0:HEIGHT_PX, 0:WIDTH_PX]
    shadow = 1 - 0.35 * columns / WIDTH_PX - 0.15 * rows / HEIGHT_PX
    picture = picture * shadow[..., None] + random.normal(0, 6, picture.shape)
    return np.clip(picture, 0, 255).astype(np.uint8)


def coffee_stain(centre, radius_px, random):
    """What a cup leaves, as factors (BGR) for paper: a brown disc with a dark, broken rim."""
    rows, columns = np.mgrid[0:HEIGHT_PX, 0:WIDTH_PX].astype(float)
    x, y = columns - centre[0], rows - centre[1]
    angle, apart = np.arctan2(y, x), np.hypot(x, y)
    waves = [(k, random.normal(0, 2), random.uniform(0, 6)) for k in range(1, 6)]
    wobble = sum(high * np.sin(k * angle + phase) for k, high, phase in waves)
    rim = np.exp(-(((apart - radius_px - wobble) / 6) ** 2)) * (0.75 + 0.25 * np.sin(3 * angle))
    disc = 1 / (1 + np.exp((apart - radius_px - wobble) / 3))
    depth = 0.18 * disc + 0.45 * rim
    return 1 - depth[..., None] * np.array((1.0, 0.75, 0.5))


def open_road():
    """The bean with a fifth of it missing."""
    return stroke(blank(), closed_curve(BEAN)[150:1100], closed=False)


def figure_eight():
    """A road that crosses itself once, at the middle."""
    angle = np.linspace(0, 2 * np.pi, 2000, endpoint=False)
    points = np.column_stack((600 + 450 * np.sin(angle), 400 + 260 * np.sin(2 * angle)))
    return stroke(blank(), points)


def side_road():
    """The bean and a road that leaves it at the top right and leads nowhere."""
    return stroke(bean(), [(600, 640), (600, 480)], closed=False)


def short_cut():
    """The bean with a second way through the infield."""
    return stroke(bean(), [(300, 210), (300, 620)], closed=False)


def _wave(count, amplitudes):
    """A smooth closed random function of unit size."""
    place = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return sum(a / 4 * np.sin((k + 1) * place + 7 * a) for k, a in enumerate(amplitudes))


ALL = (circle, ellipse, bean, by_hand, open_road, figure_eight, side_road, short_cut, blank)


def main():
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for draw in ALL:
        cv2.imwrite(str(folder / f"{draw.__name__}.png"), draw())


if __name__ == "__main__":
    main()
