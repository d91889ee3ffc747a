"""Lesson 6's geometry against closed forms, its configuration's messages, its steering's signs."""

import math
import pathlib

import numpy as np
import pytest
import yaml
from drawn_course import CAMERA, FOCAL, HEIGHT, WIDTH, Course

CONFIG = pathlib.Path(__file__).resolve().parents[1] / "config" / "follower.yaml"


@pytest.fixture
def config(lesson):
    return lesson(6).load_config(CONFIG, {})


@pytest.mark.parametrize("ahead", [0.28, 0.4, 1.0])
@pytest.mark.parametrize("left", [-0.2, 0.0, 0.15])
def test_a_floor_point_comes_back_from_its_pixel(lesson, config, ahead, left):
    column = WIDTH / 2 - FOCAL * (left - CAMERA[1]) / (ahead - CAMERA[0])
    row = HEIGHT / 2 + FOCAL * CAMERA[2] / (ahead - CAMERA[0])
    point = lesson(6).to_ground(column, row, (HEIGHT, WIDTH, 3), config)
    assert point == pytest.approx((ahead, left), abs=1e-9)


def test_the_size_of_the_image_does_not_matter(lesson, config):
    big = lesson(6).to_ground(1200, 1000, (1080, 1920), config)
    small = lesson(6).to_ground(400, 1000 / 3, (360, 640), config)
    assert big == pytest.approx(small)


def test_a_drawn_straight_line_is_seen_where_it_is(lesson, config):
    course = Course(((-3, 0, 0.5), (3, 0, 0.5), (3, -3, 0.5), (-3, -3, 0.5)))
    for beside in (-0.1, 0.0, 0.08):
        seen = lesson(6).see_line(course.view((0.0, beside, 0.0)), config)
        assert len(seen) == 2 and seen[0][0] < seen[1][0]
        assert [left for _ahead, left in seen] == pytest.approx([-beside, -beside], abs=0.001)


def test_no_line_is_no_points(lesson, config):
    assert lesson(6).see_line(np.zeros((1080, 1920, 3), np.uint8), config) == []


@pytest.mark.parametrize("radius", [-0.5, 0.7, 1.1])
def test_one_arc_leads_to_all_points_of_a_bend(lesson, radius):
    for angle in (0.3, 0.5):
        ahead, left = abs(radius) * math.sin(angle), radius * (1 - math.cos(angle))
        assert lesson(6).bend_to(ahead, left) == pytest.approx(1 / radius)


@pytest.fixture
def pid(lesson, config):
    """pid(near, error, way) of a lesson 6 without its node that just began."""
    follower = object.__new__(lesson(6).Follower)
    follower.config = {**config, "cruise_speed": 0.2, "kp": 4.0, "ki": 2.0, "kd": 0.1}
    follower.stand()
    return follower.pid


def test_drives_into_the_bend_where_nothing_is_wrong(pid):
    assert pid(0.0, 0.0, 0.01) == 0
    assert pid(2.0, 0.0, 0.01) == pytest.approx(0.4)  # 0.2 m/s, radius 0.5 m


def test_p_i_and_d_each_add_their_part(pid):
    assert pid(0.0, 0.1, 0.0) == pytest.approx(0.2 * 4 * 0.1)  # no way driven: P alone
    with_sum = 4 * 0.1 + 2 * 0.1 * 0.05
    assert pid(0.0, 0.1, 0.05) == pytest.approx(0.2 * with_sum)
    with_change = 4 * -0.1 + 2 * (0.1 * 0.05 - 0.1 * 0.05) + 0.1 * -0.2 / 0.05
    assert pid(0.0, -0.1, 0.05) == pytest.approx(0.2 * with_change)


def test_never_steers_harder_than_max_turn(pid, config):
    assert pid(50.0, 0.0, 0.01) == config["max_turn"] == -pid(-50.0, 0.0, 0.01)


def test_parameters_win_over_the_file(lesson):
    assert lesson(6).load_config(CONFIG, {"kp": 3})["kp"] == 3


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"kpp": 1}, "unknown key 'kpp'"),
        ({"kp": "fast"}, "'kp' must be a number"),
        ({"kp": None}, "missing key 'kp'"),
    ],
)
def test_a_wrong_file_is_named_with_its_key(lesson, tmp_path, change, says):
    values = {**yaml.safe_load(CONFIG.read_text()), **change}
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump({key: v for key, v in values.items() if v is not None}))
    with pytest.raises(ValueError) as raised:
        lesson(6).load_config(path, {})
    assert says in str(raised.value) and "mine.yaml" in str(raised.value)


@pytest.mark.parametrize("text", ["", "- 1\n- 2\n", "kp: [1\n"])
def test_a_file_that_is_no_table_is_one_clear_error(lesson, tmp_path, text):
    path = tmp_path / "mine.yaml"
    path.write_text(text)
    with pytest.raises(ValueError) as raised:
        lesson(6).load_config(path, {})
    assert "mine.yaml" in str(raised.value) and "\n" not in str(raised.value)


def test_a_wrong_parameter_is_named(lesson):
    with pytest.raises(ValueError, match="parameters: unknown key 'kpp'"):
        lesson(6).load_config(CONFIG, {"kpp": 1})
