"""Poses and grids, with answers worked out by hand."""

import numpy as np
import pytest

from nav_algorithms import poses
from nav_algorithms.grid import UNKNOWN, OccupancyGrid


def test_angles_are_wrapped_to_the_half_open_circle():
    assert poses.wrap_angle(np.pi) == pytest.approx(np.pi)
    assert poses.wrap_angle(-np.pi) == pytest.approx(np.pi)
    assert poses.wrap_angle(7.0) == pytest.approx(7.0 - 2 * np.pi)


def test_compose_turns_the_second_into_the_first():
    assert poses.compose((1, 2, np.pi / 2), (3, 0, 0.1)) == pytest.approx((1, 5, np.pi / 2 + 0.1))


def test_relative_undoes_compose():
    first, second = np.array([0.3, -2.0, 2.8]), np.array([1.5, 0.2, 1.9])
    assert poses.relative(first, poses.compose(first, second)) == pytest.approx(second)


def test_many_poses_at_once():
    many = poses.compose(np.array([[0, 0, 0], [0, 0, np.pi / 2]]), (1.0, 0.0, 0.0))
    assert many == pytest.approx(np.array([[1, 0, 0], [0, 1, np.pi / 2]]))


def test_points_are_turned_and_moved():
    moved = poses.transform_points(np.array([1.0, 0.0, np.pi / 2]), np.array([[1.0, 0.0]]))
    assert moved == pytest.approx(np.array([[1.0, 1.0]]))


def test_cells_and_centres_answer_each_other():
    grid = OccupancyGrid(np.full((4, 6), UNKNOWN, np.int8), 0.5, (-1.0, 2.0))
    assert grid.cells_of((-0.9, 2.6)).tolist() == [1, 0]
    assert grid.centres_of((1, 0)) == pytest.approx((-0.75, 2.75))
    assert grid.contains(np.array([[3, 5], [4, 0], [0, -1]])).tolist() == [True, False, False]


@pytest.mark.parametrize("place", [(np.nan, 2.6), (1e300, 2.6), (-0.9, -np.inf)])
def test_what_is_nowhere_lies_outside_without_a_warning(recwarn, place):
    grid = OccupancyGrid(np.full((4, 6), UNKNOWN, np.int8), 0.5, (-1.0, 2.0))
    assert not grid.contains(grid.cells_of(place))
    assert not recwarn


@pytest.mark.parametrize("arguments, text", [
    ((np.zeros((2, 2)), 0.05, (0, 0)), "int8"),
    ((np.zeros((2, 2), np.int8), 0.0, (0, 0)), "resolution"),
    ((np.zeros((2, 2), np.int8), 0.05, (np.nan, 0)), "origin")])
def test_what_is_no_map_is_refused(arguments, text):
    with pytest.raises(ValueError, match=text):
        OccupancyGrid(*arguments)
