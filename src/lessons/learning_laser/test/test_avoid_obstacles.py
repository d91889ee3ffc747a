"""The law on drawn scans, the halls, and drives of a robot without slip through them."""

import math

import numpy as np
import pytest
from learning_laser import hall

LIMIT = 120.0  # s


def test_with_nothing_in_sight_it_drives_straight_on(lesson):
    assert lesson.command(np.array([]), np.array([])) == (lesson.SPEED, 0.0)


@pytest.mark.parametrize("side", [1, -1])
def test_it_turns_away_from_what_is_ahead_and_slows_down(lesson, side):
    angles = np.radians(side * np.arange(-2.0, 12.0))
    speed, turn = lesson.command(angles, np.full(14, 0.6))
    assert turn * side < 0 and 0 < speed < lesson.SPEED


def test_what_is_beside_the_strip_does_not_matter(lesson):
    free = lesson.free_lengths(np.array([math.pi / 2]), np.array([0.3]))
    assert free[len(free) // 2] == lesson.REACH and free[-1] == pytest.approx(0.3)


def test_halls_are_the_same_for_a_number_and_have_gaps():
    for seed in range(100):
        columns = hall.columns(seed)
        assert len(columns) >= 6
        assert (columns == hall.columns(seed)).all()
        apart = np.hypot(*(columns[:, None] - columns).T) + 9 * np.eye(len(columns))
        assert apart.min() >= 2 * hall.RADIUS + hall.GAP
        assert np.abs(columns[:, 1]).max() <= hall.WIDTH / 2 - hall.RADIUS - hall.GAP


def test_the_shipped_hall_is_hall_0(lesson):
    world = lesson.__file__.replace("scripts/avoid_obstacles.py", "worlds/hall.world")
    with open(world, encoding="utf-8") as file:
        assert file.read() == hall.world(0)


def test_it_drives_through_twenty_halls_and_touches_nothing(lesson):
    drives = [hall.drive(lesson.command, seed, LIMIT) for seed in range(20)]
    assert all(time is not None and air > 0 for time, air in drives), drives
