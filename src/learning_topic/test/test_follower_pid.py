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
        assert seen[:, 1] == pytest.approx([-beside, -beside], abs=0.001)


def test_no_line_is_no_points(lesson, config):
    assert lesson(6).see_line(np.zeros((1080, 1920, 3), np.uint8), config).shape == (0, 2)


def test_points_move_against_the_robot(lesson):
    points = np.array([[1.0, 0.0]])
    assert lesson(6).moved(points, 0.25, 0.0) == pytest.approx(np.array([[0.75, 0.0]]))
    assert lesson(6).moved(points, 0.0, math.pi / 2) == pytest.approx(np.array([[0.0, -1.0]]))
    assert len(lesson(6).moved(points, 2.0, 0.0)) == 0


@pytest.mark.parametrize("radius", [-0.5, 0.7, 1.1])
def test_fit_finds_offset_slope_and_bend(lesson, radius):
    x = np.linspace(-0.2, 0.35, 60)
    offset, slope, bend = lesson(6).fit_line(np.stack([x, 0.02 + 0.1 * x + x * x / 2 / radius], 1))
    assert (offset, slope) == pytest.approx((0.02, 0.1), abs=0.002)
    assert bend == pytest.approx(1 / radius, rel=0.02)


def test_two_points_make_a_straight_line(lesson):
    offset, slope, _bend = lesson(6).fit_line(np.array([[0.35, 0.035], [0.40, 0.040]]))
    assert (offset, slope) == pytest.approx((0.0, 0.1), abs=0.005)


def test_steers_towards_the_line_and_into_the_bend(lesson, config):
    steer = lesson(6).steer
    assert steer((0.0, 0.0, 0.0), 0.0, config) == 0
    assert steer((0.01, 0.0, 0.0), 0.0, config) > 0 > steer((-0.01, 0.0, 0.0), 0.0, config)
    assert steer((0.0, 0.0, 2.0), 0.0, config) == pytest.approx(0.4)  # 0.2 m/s, radius 0.5 m
    assert steer((1.0, 1.0, 2.0), 0.0, config) == config["max_turn"]


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
