"""Paths, pure pursuit and Stanley against circles and straight lines."""

import math

import numpy as np
import pytest
from car_control.driving.path import Path
from car_control.driving.pure_pursuit import curvature_to, pure_pursuit
from car_control.driving.stanley import StanleyGains, stanley, stanley_angle

WHEELBASE = 0.335  # m


def circle(radius, count=400):
    """Counter-clockwise round the origin, from (radius, 0)."""
    angles = np.arange(count) * 2 * math.pi / count
    return Path(radius * np.stack([np.cos(angles), np.sin(angles)], axis=1), closed=True)


STRAIGHT = Path([(0.0, 0.0), (1.0, 0.0), (10.0, 0.0)])


def test_a_circle_has_its_length_and_curvature():
    ring = circle(2.0)
    assert ring.length == pytest.approx(4 * math.pi, rel=1e-4)
    assert ring.curvature() == pytest.approx(np.full(400, 0.5))
    assert Path(ring.points[::-1], closed=True).curvature() == pytest.approx(np.full(400, -0.5))


def test_an_open_path_has_a_curvature_at_every_point():
    arc = Path(circle(2.0).points[:50])
    assert arc.curvature() == pytest.approx(np.full(50, 0.5))
    assert Path([(0, 0), (1, 1)]).curvature().tolist() == [0.0, 0.0]


def test_points_along_and_beyond_a_path():
    assert STRAIGHT.point(4.0).tolist() == [4.0, 0.0]
    assert STRAIGHT.point(-1.0).tolist() == [0.0, 0.0]
    assert STRAIGHT.point(99.0).tolist() == [10.0, 0.0]
    square = Path([(0, 0), (1, 0), (1, 1), (0, 1)], closed=True)
    assert square.point(3.5).tolist() == [0.0, 0.5]
    assert square.point(-0.5).tolist() == [0.0, 0.5]
    assert square.point(4.25).tolist() == [0.25, 0.0]
    assert square.heading(1.5) == pytest.approx(math.pi / 2)


def test_left_of_the_path_is_positive():
    near = STRAIGHT.nearest(3.0, 0.2)
    assert (near.s, near.lateral, near.heading) == pytest.approx((3.0, 0.2, 0.0))
    assert STRAIGHT.nearest(3.0, -0.2).lateral == pytest.approx(-0.2)
    inside = circle(2.0).nearest(0.0, 1.5)  # counter-clockwise: the middle is to the left
    assert inside.lateral == pytest.approx(0.5, abs=1e-3)
    assert inside.s == pytest.approx(math.pi, abs=2.0 * math.pi / 400)


@pytest.mark.parametrize("points", [[(0, 0)], [(0, 0), (0, 0)], [(0, 0), (math.nan, 1)], [1, 2]])
def test_what_is_no_path_is_refused(points):
    with pytest.raises(ValueError, match="path"):
        Path(points)


@pytest.mark.parametrize("radius", [-0.9, 1.0, 5.0])
@pytest.mark.parametrize("angle", [0.1, 0.5, 1.5])
def test_one_arc_leads_to_every_point_of_a_circle(radius, angle):
    ahead, left = abs(radius) * math.sin(angle), radius * (1 - math.cos(angle))
    assert curvature_to(ahead, left) == pytest.approx(1 / radius)


def test_pure_pursuit_on_a_circle_drives_the_circle():
    assert pure_pursuit(circle(2.0), (2.0, 0.0, math.pi / 2), 0.5) == pytest.approx(0.5, rel=1e-3)


def test_pure_pursuit_beside_a_line_drives_the_arc_to_the_goal():
    assert pure_pursuit(STRAIGHT, (0.0, 0.3, 0.0), 0.4) == pytest.approx(2 * -0.3 / 0.25)
    assert pure_pursuit(STRAIGHT, (0.0, 0.0, 0.0), 1.0) == 0.0
    assert curvature_to(0.0, 0.0) == 0.0


def test_pure_pursuit_needs_a_way_to_look_ahead():
    with pytest.raises(ValueError, match="look_ahead must be more than 0 m"):
        pure_pursuit(STRAIGHT, (0.0, 0.0, 0.0), 0.0)


def test_stanley_adds_heading_and_distance():
    gains = StanleyGains(gain=2.0, softening=0.5)
    assert stanley_angle(0.1, 0.0, 1.0, gains) == pytest.approx(0.1)
    assert stanley_angle(0.0, 0.3, 1.0, gains) == pytest.approx(-math.atan(0.6 / 1.5))
    assert stanley_angle(0.0, -0.3, -1.0, gains) == pytest.approx(math.atan(0.6 / 1.5))
    assert stanley_angle(2 * math.pi - 0.1, 0.0, 1.0, gains) == pytest.approx(-0.1)


@pytest.mark.parametrize("law", ["pure_pursuit", "stanley"])
@pytest.mark.parametrize("beside", [-0.3, 0.3])
def test_a_bicycle_finds_to_the_circle_and_stays(law, beside):
    ring, speed, period = circle(2.0), 1.5, 0.01
    x, y, yaw = 2.0 + beside, 0.0, math.pi / 2
    gains = StanleyGains(gain=3.0)
    for _ in range(600):
        if law == "stanley":
            angle = stanley(ring, (x, y, yaw), speed, WHEELBASE, gains)
        else:
            angle = math.atan(WHEELBASE * pure_pursuit(ring, (x, y, yaw), 0.5))
        yaw += speed * math.tan(max(-0.4, min(0.4, angle))) / WHEELBASE * period
        x, y = x + speed * math.cos(yaw) * period, y + speed * math.sin(yaw) * period
    axle = math.hypot(x, y)
    front = math.hypot(x + WHEELBASE * math.cos(yaw), y + WHEELBASE * math.sin(yaw))
    assert (front if law == "stanley" else axle) == pytest.approx(2.0, abs=0.02)
