"""The tutorial's law, number by number, and its largest-blob choice."""

from pathlib import Path

import pytest
from ai_robot_tracking.red_target import Blob
from ai_robot_tracking.settings import load_settings
from drawn_room import cylinder, draw_cylinder, room
from visual_tracker import PageSettings, largest_blob, page_command

CONFIG = Path(__file__).resolve().parents[1] / "config" / "tracking_params.yaml"
SETTINGS = load_settings(PageSettings, CONFIG, "visual_tracker", {})


def at(error, radius):
    return Blob(0, 0, 10, 10, 320 + error, 240, radius, 100)


@pytest.mark.parametrize(("error", "radius", "speed"), [
    (0, 31, 0.2), (49, 100, 0.2), (-49, 31, 0.2),   # ahead and near
    (50, 31, 0.1), (-200, 100, 0.1),                # near, but beside
    (0, 30, 0.1), (0, 25, 0.1),                     # ahead, between near and far
    (0, 24, 0.15), (300, 11, 0.15),                 # far
])
def test_speeds(error, radius, speed):
    assert page_command(at(error, radius), 640, SETTINGS) == (speed, pytest.approx(-0.005 * error))


def test_without_a_target_it_turns_on_the_spot():
    assert page_command(None, 640, SETTINGS) == (0.0, 0.5)
    assert page_command(at(-100, 10), 640, SETTINGS) == (0.0, 0.3)  # too small


def test_the_largest_is_the_target():
    assert largest_blob(room(), SETTINGS) is None
    blob = largest_blob(draw_cylinder(cylinder(3.0, 0.4), 1.2, -0.3), SETTINGS)
    assert blob.column > 160
    assert page_command(blob, 320, SETTINGS)[1] < 0
