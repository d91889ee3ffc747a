"""The course model: committed files are what the track gives, colours lie where it says."""

import math
from pathlib import Path

import cv2
import numpy as np
import pytest
import rospkg
from racecar_description.track.closed_line import load_track
from racecar_description.track.course_model import (
    BACKGROUND,
    WHITE,
    YELLOW,
    encode_png,
)
from racecar_description.track.track_file import load_track_file

PACKAGES = rospkg.RosPack()
TRACK = Path(PACKAGES.get_path("evaluation")) / "tracks" / "course.yaml"
COMMITTED = Path(PACKAGES.get_path("learning_topic")) / "models" / "turtlebot3_autorace" / "course"
WORLD_YAW = -1.54  # rad, of the model in the lesson's course.world


@pytest.fixture(scope="module")
def texture() -> np.ndarray:
    """The committed texture, RGB."""
    image = cv2.imread(str(COMMITTED / "materials" / "textures" / "course.png"))
    return cv2.cvtColor(image, cv2.COLOR_BGR2RGB)


def colour_at(texture: np.ndarray, x: float, y: float) -> tuple[int, ...]:
    """What lies at a point of the world: turn it into the model's frame, then into pixels."""
    plane_x = math.cos(-WORLD_YAW) * x - math.sin(-WORLD_YAW) * y
    plane_y = math.sin(-WORLD_YAW) * x + math.cos(-WORLD_YAW) * y
    px_per_m = texture.shape[0] / 4.0
    row, column = (2.0 - plane_y) * px_per_m, (plane_x + 2.0) * px_per_m
    return tuple(int(value) for value in texture[int(row), int(column)])


def test_lines_have_their_colours_all_along(texture):
    track_file, yellow = load_track_file(TRACK), load_track(TRACK)
    white = yellow.offset(-track_file.lane_width)
    for line, colour in ((yellow, YELLOW), (white, WHITE)):
        assert all(colour_at(texture, x, y) == colour for x, y in line.points(0.05))


def test_white_lies_right_of_the_start_and_floor_around(texture):
    assert colour_at(texture, 0.0, 0.0) == YELLOW
    assert colour_at(texture, 0.0, -0.296) == WHITE
    for x, y in ((0.0, -0.15), (0.0, 0.15), (0.0, -0.45), (1.9, 1.9), (-1.9, -1.9), (0.0, -1.0)):
        assert colour_at(texture, x, y) == BACKGROUND


def test_line_is_as_wide_as_the_track_says(texture):
    across = [colour_at(texture, 0.0, y / 10000)[0] for y in range(-300, 300)]
    width = sum((value - 10) / 245 for value in across) / 10000
    assert width == pytest.approx(0.019, abs=0.0015)


def test_texture_is_small(texture):
    assert texture.shape == (2048, 2048, 3)
    assert (COMMITTED / "materials" / "textures" / "course.png").stat().st_size < 300_000


def test_png_decodes_to_what_was_encoded():
    image = np.random.default_rng(1).integers(0, 256, (13, 17, 3), np.uint8)
    decoded = cv2.imdecode(np.frombuffer(encode_png(image), np.uint8), cv2.IMREAD_COLOR)
    assert np.array_equal(cv2.cvtColor(decoded, cv2.COLOR_BGR2RGB), image)
