"""Masks, lanes, zebras and people in drawn pictures, in bright and dim light."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from drawn_lane import Person, draw
from lane_keeping import binarise
from lane_keeping.binarise import line_mask
from lane_keeping.crossing import find_people, find_zebra
from lane_keeping.image_watch import FrozenWatch, is_blank, mistake_in
from lane_keeping.lane import LEFT, RIGHT, Side, beside, fit_side, make_lane
from lane_keeping.road_view import road_view
from lane_keeping.settings import load_settings

SETTINGS = load_settings(Path(__file__).parents[1] / "config" / "lane_keeping.yaml")
VIEW = road_view(SETTINGS, 640, 480)
LIGHTS = pytest.mark.parametrize("light", [0.6, 1.0, 1.4])
SHADE = (((0.3, -1.0), (1.4, -1.0), (1.6, 1.0), (0.6, 1.0)),)


def grey(image):
    return image.mean(axis=2).astype(np.uint8)


def test_ground_and_pixels_are_each_others_inverse():
    ground = np.array([[0.5, 0.0], [1.2, 0.3], [3.0, -1.0]])
    assert VIEW.to_ground(VIEW.to_pixels(ground)) == pytest.approx(ground)
    assert VIEW.to_pixels(ground)[0, 0] == 320
    assert VIEW.to_ground(np.array([320.0, VIEW.horizon - VIEW.top - 1]))[0] > 1e5
    for row in (0, 239):
        half = VIEW.lane_width_px(row) / 2
        ends = VIEW.to_ground(np.array([[320 - half, row], [320 + half, row]]))
        assert ends[0, 1] - ends[1, 1] == pytest.approx(SETTINGS.lane_width)


def test_thresholds_are_inverted():
    picture = np.full((60, 60), 200, np.uint8)
    picture[:, 28:33] = 40  # a dark line
    for mask in (binarise.global_mean(picture), binarise.adaptive_mean(picture, 11, 2),
                 binarise.relative_mean(picture, 31, 0.6)):
        assert (mask[:, 28:33] == 255).all() and not mask[:, :28].any() and not mask[:, 33:].any()
    assert not binarise.opening(np.pad(np.full((4, 4), 255, np.uint8), 9), 5).any()
    assert binarise.region(picture, 0.5).shape == (30, 60)


@LIGHTS
def test_a_share_of_the_mean_sees_lines_only_whatever_the_light(light):
    plain = line_mask(draw(SETTINGS), SETTINGS) > 0
    seen = line_mask(draw(SETTINGS, shade=SHADE, zebra=(0.7, 1.5), light=light), SETTINGS) > 0
    assert (seen & ~plain).sum() < 0.03 * plain.sum()
    assert (plain & ~seen).sum() < 0.15 * plain.sum()


def test_the_pages_global_mean_takes_shade_for_line():
    page = replace(SETTINGS, binarise="global_mean")
    near = ((0.3, -1.0), (0.8, -1.0), (0.8, 1.0), (0.3, 1.0))
    plain, shaded = draw(SETTINGS), draw(SETTINGS, shade=[near])
    assert (line_mask(shaded, page) > 0).sum() > 4 * (line_mask(plain, page) > 0).sum()


def side(column, first=0.0, last=239.0):
    return Side(np.array([0.0, 0.0, column]), (first, last))


def test_lines_too_near_to_each_other_are_one_line():
    lane = make_lane(side(100.0), side(160.0, 100.0), VIEW)
    assert lane.left is not None and lane.right is None
    assert make_lane(None, None, VIEW) is None


@pytest.mark.parametrize(("which", "towards"), [(0.3, RIGHT), (-0.3, LEFT)])
def test_beside_a_line_the_middle_is_half_a_lane_away(which, towards):
    ahead = np.linspace(0.5, 1.3, 50)
    line = fit_side(VIEW.to_pixels(np.stack([ahead, np.full(50, which)], axis=1)))
    centre = beside(line, towards, VIEW)
    middle = VIEW.to_ground(np.array([np.polyval(centre.curve, 168), 168]))
    assert middle[1] == pytest.approx(0, abs=0.005)


@LIGHTS
@pytest.mark.parametrize("near", [0.7, 1.3, 1.9])
def test_a_zebra_is_found_where_it_is(light, near):
    image = draw(SETTINGS, zebra=(near, near + 0.8), light=light, noise=0.01, turned=0.05)
    zebra = find_zebra(grey(image), VIEW)
    assert zebra.near == pytest.approx(near, abs=0.05)
    assert zebra.far == pytest.approx(min(near + 0.8, 2.7), abs=0.1)


@pytest.mark.parametrize("lane", [{}, {"curvature": 0.7}, {"shade": SHADE}, {"light": 1.4}])
def test_no_zebra_is_seen_where_none_is(lane):
    assert find_zebra(grey(draw(SETTINGS, noise=0.01, **lane)), VIEW) is None


def test_a_camera_that_does_not_see_the_road_sees_no_zebra():
    settings = replace(SETTINGS, camera_forward=2.0)
    assert find_zebra(grey(draw(SETTINGS)), road_view(settings, 640, 480)) is None


@LIGHTS
def test_people_are_found_where_they_stand(light):
    people = (Person(1.6, 0.2), Person(2.4, -0.9))
    image = draw(SETTINGS, zebra=(1.2, 2.0), people=people, light=light, noise=0.01)
    found = find_people(image, VIEW)
    wanted = np.array([[1.6, 0.2], [2.4, -0.9]])
    assert found[found[:, 0].argsort()] == pytest.approx(wanted, abs=0.08)


def test_nobody_is_found_where_nobody_is():
    assert find_people(draw(SETTINGS, zebra=(0.8, 1.6), shade=SHADE), VIEW).shape == (0, 2)
    flat = draw(SETTINGS, people=(Person(1.5, 0.0, tall=0.05, wide=0.3),))
    assert len(find_people(flat, VIEW)) == 0


def test_blank_pictures():
    assert is_blank(np.full((480, 640, 3), 90, np.uint8), SETTINGS.blank_contrast)
    assert not is_blank(draw(SETTINGS, light=0.4), SETTINGS.blank_contrast)


def test_a_frozen_picture_counts_only_while_driving_until_another_comes():
    watch, picture = FrozenWatch(0.5), np.zeros((4, 4, 3), np.uint8)
    assert not any(watch.see(picture, t / 10, moving=False) for t in range(20))
    seen = [watch.see(picture, 2 + t / 10, moving=True) for t in range(8)]
    assert seen == [False] * 4 + [True] * 4  # counted from the last picture while standing
    assert watch.see(picture.copy(), 3.0, moving=False)  # standing because of it ends nothing
    assert not watch.see(picture + 1, 3.1, moving=False)


@pytest.mark.parametrize(("fields", "mistake"), [
    (("bgr8", 640, 480, 1920, 921600), None),
    (("mono8", 640, 480, 704, 337920), None),
    (("bgr8", 640, 480, 640, 307200), "step is 640, but 640 pixels of bgr8 need 1920 bytes a row"),
    (("bgr8", 640, 480, 1920, 900000), "900000 bytes of data, but 480 rows of 1920 bytes"),
    (("yuv99", 640, 480, 1920, 921600), "encoding 'yuv99' is unknown here; known: bgr8, "),
    (("bgr8", 0, 0, 0, 0), "0x0 pixels are too few, 80x60 is the least"),
])
def test_mistakes_in_image_messages(fields, mistake):
    found = mistake_in(*fields)
    assert found is None if mistake is None else found.startswith(mistake)
