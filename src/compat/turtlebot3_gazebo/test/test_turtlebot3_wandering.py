"""The driving rules with made-up rays, and on a ten-minute drive through the world's plan."""

import math
from pathlib import Path
from xml.etree import ElementTree

import pytest
from turtlebot3_gazebo.wandering import SPEED, TURN_RATE, Rays, Wanderer, look, rays, turned

MODEL = Path(__file__).resolve().parent.parent / "models/turtlebot3_world/model.sdf"
FORWARD, RIGHT, LEFT = (SPEED, 0.0), (0.0, -TURN_RATE), (0.0, TURN_RATE)
CLEAR, BLOCKED = Rays(3.5, 3.5, 3.5), Rays(0.5, 3.5, 3.5)
WAFFLE_REACH = 0.25  # m, from the wheel axis to a rear corner


@pytest.mark.parametrize("seen, command", [
    (CLEAR, FORWARD),
    (Rays(0.71, 0.61, 0.61), FORWARD),
    (Rays(0.69, 3.5, 3.5), RIGHT),
    (Rays(3.5, 0.59, 3.5), RIGHT),
    (Rays(3.5, 3.5, 0.59), LEFT),
    (Rays(3.5, 0.5, 0.5), RIGHT),
    (Rays(0.5, 3.5, 0.5), RIGHT),
])
def test_look(seen, command):
    assert look(seen) == command


def test_rays_are_ahead_and_30_degrees_to_the_sides():
    ranges = [9.0] * 360
    ranges[0], ranges[30], ranges[330] = 1.0, math.inf, -math.inf
    assert rays(ranges, 3.5) == Rays(1.0, 3.5, 0.0)


@pytest.mark.parametrize("start_deg, now_deg, expected_deg", [
    (0, 20, 20), (10, -15, 25), (175, -175, 10), (-170, 170, 20),
])
def test_turned_takes_the_shorter_way_round(start_deg, now_deg, expected_deg):
    angle = turned(math.radians(start_deg), math.radians(now_deg))
    assert math.degrees(angle) == pytest.approx(expected_deg)


@pytest.mark.parametrize("start_deg", [0, -160])  # the second turn crosses the seam at 180 degrees
def test_a_turn_goes_on_for_30_degrees(start_deg):
    wanderer = Wanderer()
    assert wanderer.update(BLOCKED, math.radians(start_deg)) == RIGHT
    for done_deg in range(1, 30):
        assert wanderer.update(CLEAR, heading(start_deg - done_deg)) == RIGHT
    assert wanderer.update(CLEAR, heading(start_deg - 30.1)) == FORWARD


def heading(angle_deg):
    """In rad, between -pi and pi as odometry gives it."""
    return math.remainder(math.radians(angle_deg), math.tau)


def test_a_second_turn_follows_where_it_is_still_blocked():
    wanderer = Wanderer()
    wanderer.update(BLOCKED, 0.0)
    assert wanderer.update(BLOCKED, heading(-31)) == RIGHT
    assert wanderer.update(CLEAR, heading(-45)) == RIGHT
    assert wanderer.update(CLEAR, heading(-62)) == FORWARD


class Shape:
    """A column or box of the world, seen from above."""

    def __init__(self, collision):
        self.x, self.y, _, _, _, self.yaw = map(float, collision.findtext("pose").split())
        size = collision.findtext("geometry/box/size")
        self.half = [float(word) / 2 for word in size.split()[:2]] if size else (0.0, 0.0)
        self.radius = float(collision.findtext("geometry/cylinder/radius") or 0.0)

    def gap(self, x, y):
        """Distance in m from a point to the surface; not above 0 inside."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        dx, dy = x - self.x, y - self.y
        across = abs(cos * dx + sin * dy) - self.half[0]
        along = abs(cos * dy - sin * dx) - self.half[1]
        outside = math.hypot(max(across, 0.0), max(along, 0.0))
        return outside + min(max(across, along), 0.0) - self.radius


@pytest.fixture(scope="module")
def shapes():
    return [Shape(each) for each in ElementTree.parse(MODEL).iter("collision")]


def nearest(shapes, x, y):
    return min(shape.gap(x, y) for shape in shapes)


def ray(shapes, x, y, angle):
    """Distance in m, walked by as much as is surely free; inf beyond the laser's 3.5 m."""
    length = 0.0
    while length < 3.5:
        free = nearest(shapes, x + length * math.cos(angle), y + length * math.sin(angle))
        if free < 1e-3:
            return length
        length += free
    return math.inf


def test_a_drive_through_the_world_touches_nothing(shapes):
    x, y, yaw, wanderer = -2.0, -0.5, 0.0, Wanderer()
    period = 1 / 25  # s; the laser measures at 5 Hz
    closest, seen, places = math.inf, None, set()
    for tick in range(600 * 25):
        if tick % 5 == 0:
            angles = (yaw, yaw + math.radians(30), yaw - math.radians(30))
            seen = Rays(*(min(ray(shapes, x, y, angle), 3.5) for angle in angles))
        forward, left = wanderer.update(seen, yaw)
        x += forward * math.cos(yaw) * period
        y += forward * math.sin(yaw) * period
        yaw = math.remainder(yaw + left * period, math.tau)
        closest = min(closest, nearest(shapes, x, y))
        places.add((round(x), round(y)))
    assert closest > WAFFLE_REACH
    assert len(places) > 5  # it gets about
