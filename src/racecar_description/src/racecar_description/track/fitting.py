"""Smooths a measured closed line, and converts it to a polygon with rounded corners."""

from __future__ import annotations

import math

import numpy as np

from racecar_description.track.centre_line import Corner

KNOT = 0.2  # m, between the spline's control points
CORNER = 0.25  # m, between the corners of the polygon
DIGITS = 4  # decimals of written corners: a tenth of a millimetre
WIDEST = 100.0  # m: bends of larger radius are written with this one, between straights
ODD_WIDTH = 0.2  # share of the usual half width: a larger deviation is a stain or a gap
ODD_WEIGHT = 0.01


def width_weights(half_width: np.ndarray) -> np.ndarray:
    """Weights of the middle line's points: small where the road's width is unusual."""
    usual = np.median(half_width)
    odd = np.abs(half_width - usual) > ODD_WIDTH * usual + 1.5
    reach = max(1, round(usual / 2))  # the middle is displaced even before the width is
    near = np.convolve(np.concatenate((odd[-reach:], odd, odd[:reach])), np.ones(2 * reach + 1))
    return np.where(near[2 * reach : 2 * reach + len(odd)] > 0.5, ODD_WEIGHT, 1.0)


def smooth(points: np.ndarray, weights: np.ndarray, bend: float) -> np.ndarray:
    """A smooth closed curve through about (n, 2) points, as (m, 2) points KNOT / 10 apart.

    A quadratic B-spline that minimises weighted squared distances and squared third differences.
    Waves shorter than about 2 pi `bend` (m) are removed; circles keep their size.
    """
    along = _lengths(points)
    knots = max(8, round(along[-1] / KNOT))
    place = along[:-1] / along[-1] * knots
    basis = _basis(place, knots)
    # Points are denser where the line is ragged, so each is weighted by its length.
    stands_for = (np.roll(np.diff(along), 1) + np.diff(along)) / 2
    weight = weights * stands_for / (along[-1] / knots)
    third = _differences(knots, 3)
    matrix = basis.T @ (basis * weight[:, None]) + (bend / KNOT) ** 6 * third.T @ third
    control = np.linalg.solve(matrix, basis.T @ (points * weight[:, None]))
    return _basis(np.arange(10 * knots) / 10, knots) @ control


def start_at(curve: np.ndarray, start: tuple[float, float] | None) -> np.ndarray:
    """The closed curve, starting nearest to `start`, or on its straightest stretch towards +x."""
    if start is not None:
        return np.roll(curve, -int(np.argmin(np.hypot(*(curve - start).T))), axis=0)
    headings, curvature = _headings_and_curvature(curve)
    after = np.roll(headings, -1)
    level = np.flatnonzero(((headings <= 0) != (after <= 0)) & (np.abs(headings) < 1))
    window = max(3, min(50, len(curve) // 8))  # a metre to each side
    bent = [np.abs(np.roll(curvature, window - i)[: 2 * window]).max() for i in level]
    best = level[np.argmin(bent)]
    rolled = np.roll(curve, -best, axis=0)
    share = headings[best] / (headings[best] - after[best])  # share of the way to the next point
    return (1 - share) * rolled + share * np.roll(rolled, -1, axis=0)


def to_corners(curve: np.ndarray, straight_ahead: bool) -> list[Corner]:
    """Corners of a rounded polygon that follows a smooth closed curve.

    The curve's first point becomes the origin; it is on the line, midway between the last corner
    and the first one. With `straight_ahead` the line is parallel to x there.
    """
    along = _lengths(curve)
    count = max(8, round(along[-1] / CORNER))
    wanted = (np.arange(count) + 0.5) * along[-1] / count
    closed = np.vstack((curve, curve[:1]))
    passed = np.column_stack([np.interp(wanted, along, closed[:, i]) for i in (0, 1)])
    # A rounded corner passes through (1, 6, 1) / 8 of three neighbours, to fourth order.
    spread = 0.75 + 0.25 * np.cos(2 * math.pi * np.fft.fftfreq(count))
    polygon = np.fft.ifft(np.fft.fft(passed, axis=0) / spread[:, None], axis=0).real
    return _rounded(_through_origin(polygon, straight_ahead))


def _through_origin(polygon: np.ndarray, straight_ahead: bool) -> np.ndarray:
    """The polygon, moved and rounded so that the last edge's middle is exactly the origin."""
    polygon = np.round(polygon - (polygon[0] + polygon[-1]) / 2, DIGITS)
    if straight_ahead:
        polygon[0, 1] = 0.0
    polygon[-1] = -polygon[0]
    return polygon + 0.0  # no -0.0


def _rounded(polygon: np.ndarray) -> list[Corner]:
    """Corners with the largest radii that use at most half of each edge."""
    edges = np.roll(polygon, -1, axis=0) - polygon
    lengths, headings = np.hypot(*edges.T), np.arctan2(edges[:, 1], edges[:, 0])
    turns = (headings - np.roll(headings, 1) + math.pi) % (2 * math.pi) - math.pi
    room = np.minimum(lengths, np.roll(lengths, 1)) / 2
    radii = room / np.maximum(np.tan(np.abs(turns) / 2), 1e-9)
    radii = np.floor(np.minimum(radii, WIDEST) * 10**DIGITS) / 10**DIGITS
    return [
        Corner(float(x), float(y), float(radius))
        for (x, y), radius in zip(polygon, radii, strict=True)
    ]


def _lengths(points: np.ndarray) -> np.ndarray:
    """(n + 1,) lengths along a closed line to each point, and back to the first."""
    steps = np.hypot(*(np.roll(points, -1, axis=0) - points).T)
    return np.concatenate(([0.0], np.cumsum(steps)))


def _basis(place: np.ndarray, knots: int) -> np.ndarray:
    """(n, knots) weights of a closed uniform quadratic B-spline's control points at places."""
    nearest = np.floor(place + 0.5).astype(int)
    t = place - nearest
    basis, rows = np.zeros((len(place), knots)), np.arange(len(place))
    for offset, weight in ((-1, (0.5 - t) ** 2 / 2), (0, 0.75 - t**2), (1, (0.5 + t) ** 2 / 2)):
        basis[rows, (nearest + offset) % knots] += weight
    return basis


def _differences(count: int, order: int) -> np.ndarray:
    """The difference matrix, of this order, for a closed sequence."""
    once = np.roll(np.eye(count), 1, axis=1) - np.eye(count)
    return np.linalg.matrix_power(once, order)


def _headings_and_curvature(curve: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Headings (rad) and curvatures (1/m) at the points of a closed curve."""
    ahead, behind = np.roll(curve, -1, axis=0) - curve, curve - np.roll(curve, 1, axis=0)
    middle = ahead + behind
    turns = np.arctan2(ahead[:, 1], ahead[:, 0]) - np.arctan2(behind[:, 1], behind[:, 0])
    turns = (turns + math.pi) % (2 * math.pi) - math.pi
    return np.arctan2(middle[:, 1], middle[:, 0]), turns / np.hypot(*middle.T) * 2
