"""What is seen in drawn pictures: mask, blobs, bearing, distance, form; and the law of the page."""

from pathlib import Path
from types import SimpleNamespace

import cv2
import numpy as np
import pytest
import yaml
from ai_robot_tracking.red_target import (
    Colour,
    bearing_of,
    distance_of,
    find_blobs,
    looks_upright,
    red_mask,
    split_off,
)
from drawn_room import HEIGHT, HFOV, ORANGE, RADIUS, SIZE, cylinder, draw_cylinder, room
from visual_tracker import PAGE as NUMBERS
from visual_tracker import command_to, largest_circle
from visual_tracker import red_mask as page_mask

NARROW = Colour(175, 5, 120, 18)
PAGE = Colour(0, 10, 100, 100)


def seen(picture, colour=NARROW):
    return find_blobs(red_mask(picture, colour), 5)


def distance(blob):
    return distance_of(blob, SIZE, HFOV, RADIUS, HEIGHT)


def test_an_empty_room_has_no_target():
    assert seen(room()) == []


@pytest.mark.parametrize("metres", [0.8, 1.2, 2.0, 4.0])
@pytest.mark.parametrize("bearing", [-0.4, 0.0, 0.4])
def test_bearing_and_distance(metres, bearing):
    (blob,) = seen(cylinder(metres, bearing))
    assert bearing_of(blob, SIZE[1], HFOV) == pytest.approx(bearing, abs=0.01)
    assert distance(blob) == pytest.approx(metres, rel=0.05)


def test_half_hidden_it_is_as_far_as_before():
    for hide in (np.s_[:, 160:], np.s_[170:, :]):
        picture = cylinder(1.2, 0.0)
        picture[hide] = room()[hide]
        (blob,) = seen(picture)
        assert distance(blob) == pytest.approx(1.2, rel=0.04)


def test_hue_may_go_over_180():
    purple_side, orange = (20, 0, 200), ORANGE  # BGR: hue 177 and 8
    assert seen(cylinder(1.2, 0.0, purple_side))
    assert not seen(cylinder(1.2, 0.0, orange))
    assert not seen(cylinder(1.2, 0.0, purple_side), PAGE)
    assert seen(cylinder(1.2, 0.0, orange), PAGE)


def test_in_deep_shade_only_the_lower_bound_sees_it():
    dark = (0, 0, 40)
    assert seen(cylinder(1.2, 0.0, dark))
    assert not seen(cylinder(1.2, 0.0, dark), PAGE)


def test_specks_are_nothing():
    picture = room()
    picture[::7, ::9] = (0, 0, 255)
    assert seen(picture) == []


def test_the_largest_comes_first():
    blobs = seen(draw_cylinder(cylinder(3.0, 0.4), 1.2, -0.2))
    assert [round(distance(blob), 1) for blob in blobs] == [1.2, 3.0]


def test_form():
    def upright(picture):
        return [looks_upright(blob, SIZE, RADIUS, HEIGHT) for blob in seen(picture)]

    assert upright(cylinder(1.2, 0.0)) == [True]
    assert upright(cv2.circle(room(), (160, 120), 30, (0, 0, 200), -1)) == [False]
    assert upright(cv2.rectangle(room(), (100, 120), (220, 150), (0, 0, 200), -1)) == [False]


def test_a_low_thing_behind_is_split_off():
    picture = cylinder(1.2, 0.1)
    (alone,) = seen(picture)
    cv2.rectangle(picture, (60, 130), (310, 145), (0, 0, 200), -1)
    mask = red_mask(picture, NARROW)
    (merged,) = find_blobs(mask, 5)
    assert merged.width > 200
    part = split_off(mask, merged, alone.left + alone.width / 2, alone.height)
    assert (part.left, part.width, part.height) == (alone.left, alone.width, alone.height)
    assert split_off(red_mask(cylinder(1.2, 0.1), NARROW), alone, 150.0, alone.height).width == (
        alone.width)


CONFIG = Path(__file__).resolve().parents[1] / "config" / "tracking_params.yaml"
SETTINGS = SimpleNamespace(**NUMBERS)


def at(error, radius):
    return 320 + error, 240, radius


def test_the_launch_files_config_has_the_numbers_of_the_script():
    assert yaml.safe_load(CONFIG.read_text(encoding="utf-8"))["visual_tracker"] == NUMBERS


@pytest.mark.parametrize(("error", "radius", "speed"), [
    (0, 31, 0.2), (49, 100, 0.2), (-49, 31, 0.2),   # ahead and near
    (50, 31, 0.1), (-200, 100, 0.1),                # near, but beside
    (0, 30, 0.1), (0, 25, 0.1),                     # ahead, between near and far
    (0, 24, 0.15), (300, 11, 0.15),                 # far
])
def test_speeds(error, radius, speed):
    assert command_to(at(error, radius), 640, SETTINGS) == (speed, pytest.approx(-0.005 * error))


def test_without_a_target_it_turns_on_the_spot():
    assert command_to(None, 640, SETTINGS) == (0.0, 0.5)
    assert command_to(at(-100, 10), 640, SETTINGS) == (0.0, 0.3)  # too small


def test_the_largest_is_the_target():
    assert largest_circle(page_mask(room(), SETTINGS)) is None
    picture = draw_cylinder(cylinder(3.0, 0.4), 1.2, -0.3)
    circle = largest_circle(page_mask(picture, SETTINGS))
    assert circle[0] > 160
    assert command_to(circle, 320, SETTINGS)[1] < 0
