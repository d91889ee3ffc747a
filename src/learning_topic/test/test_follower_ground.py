"""Lesson 6's P, I and D; lesson 7's geometry against closed forms, and what it drives where."""

import math
import pathlib

import numpy as np
import pytest
import rospy
import yaml
from drawn_course import CAMERA, FOCAL, HEIGHT, WIDTH, DrawnCourse


@pytest.mark.parametrize("ahead", [0.28, 0.4, 1.0])
@pytest.mark.parametrize("left", [-0.2, 0.0, 0.15])
def test_a_floor_point_comes_back_from_its_pixel(lesson, ahead, left):
    column = WIDTH / 2 - FOCAL * (left - CAMERA[1]) / (ahead - CAMERA[0])
    row = HEIGHT / 2 + FOCAL * CAMERA[2] / (ahead - CAMERA[0])
    point = lesson(7).to_ground(column, row, (HEIGHT, WIDTH, 3), lesson(7).CAMERA)
    assert point == pytest.approx((ahead, left), abs=1e-9)


def test_the_size_of_the_image_does_not_matter(lesson):
    seven = lesson(7)
    big = seven.to_ground(1200, 1000, (1080, 1920), seven.CAMERA)
    small = seven.to_ground(400, 1000 / 3, (360, 640), seven.CAMERA)
    assert big == pytest.approx(small)


def test_a_drawn_straight_line_is_seen_where_it_is(lesson):
    course = DrawnCourse(((-3, 0, 0.5), (3, 0, 0.5), (3, -3, 0.5), (-3, -3, 0.5)))
    for beside in (-0.1, 0.0, 0.08):
        seen = lesson(7).see_line(course.view((0.0, beside, 0.0)), lesson(7).CAMERA)
        assert len(seen) == 2 and seen[0][0] < seen[1][0]
        assert [left for _ahead, left in seen] == pytest.approx([-beside, -beside], abs=0.001)


def test_no_line_is_no_points(lesson):
    assert lesson(7).see_line(np.zeros((1080, 1920, 3), np.uint8), lesson(7).CAMERA) == []


@pytest.mark.parametrize("radius", [-0.5, 0.7, 1.1])
def test_in_a_bend_the_arc_of_the_bend_is_driven(lesson, radius):
    points = [(abs(radius) * math.sin(angle), radius * (1 - math.cos(angle)))
              for angle in (0.3, 0.5)]
    for point in points:
        assert lesson(7).bend_to(*point) == pytest.approx(1 / radius)
    assert lesson(7).steer(points, 0.2) == pytest.approx(0.2 / radius)


def test_steers_harder_where_the_line_lies_on_one_side(lesson):
    seven = lesson(7)
    points = [(0.3, 0.05), (0.5, 0.05)]
    assert seven.steer(points, 0.2) > 0.2 * seven.bend_to(*points[0]) > 0
    assert seven.steer(points[:1], 0.2) == pytest.approx(0.2 * seven.bend_to(*points[0]))


def test_never_steers_harder_than_max_turn(lesson):
    seven = lesson(7)
    assert seven.steer([(0.01, 0.1)], 0.2) == seven.MAX_TURN == -seven.steer([(0.01, -0.1)], 0.2)


def test_turns_on_the_spot_to_where_the_line_was(lesson, monkeypatch):
    monkeypatch.setattr(rospy, "logwarn_throttle", lambda *_: None)  # needs a node
    follower = object.__new__(lesson(7).Follower)
    follower.speed, follower.side = 0.2, 1.0
    for left, turn in ((-0.05, -0.5), (0.05, 0.5)):
        assert follower.command([(0.4, left)]).linear.x == 0.2
        lost = follower.command([])
        assert (lost.linear.x, lost.angular.z) == (0.0, turn)


CONFIG = pathlib.Path(__file__).resolve().parents[1] / "config" / "follower.yaml"


@pytest.fixture
def steer(lesson):
    """steer(offset_px, stamp) of a lesson 6 without its node that just began."""
    follower = object.__new__(lesson(6).Follower)
    follower.kp, follower.ki, follower.kd = 0.002, 0.001, 0.0005
    follower.reset()
    return follower.steer


def test_the_first_image_is_p_alone(steer):
    assert steer(100, 5.0) == pytest.approx(-0.2)


def test_p_i_and_d_each_add_their_part(steer):
    steer(100, 5.0)
    assert steer(80, 5.1) == pytest.approx(-(0.002 * 80 + 0.001 * 80 * 0.1 + 0.0005 * -200))


def test_two_images_of_one_time_do_not_divide_by_zero(steer):
    steer(100, 5.0)
    assert steer(80, 5.0) == pytest.approx(-0.16)


def test_the_file_shows_the_lessons_own_numbers(lesson):
    six = lesson(6)
    assert yaml.safe_load(CONFIG.read_text(encoding="utf-8")) == {
        "speed": six.SPEED, "kp": six.KP, "ki": six.KI, "kd": six.KD}
