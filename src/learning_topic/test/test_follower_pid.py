"""Lesson 6: what P, I and D each add, and its file of numbers."""

import pathlib

import pytest
import yaml

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
