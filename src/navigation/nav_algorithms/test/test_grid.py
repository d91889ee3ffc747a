"""Poses, grids and rays, with answers worked out by hand."""

import numpy as np
import pytest

from nav_algorithms import poses, rays
from nav_algorithms.cells import UNKNOWN, OccupancyGrid


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


# 10 rows, 20 columns, of an array in which all is occupied before and after it.
ROOM = np.ones((30, 20), np.uint8)[10:20]
ROOM[1:-1, 1:-1] = 0


def test_ranges_end_at_the_near_border_of_the_wall():
    angles = np.array([0.0, np.pi / 2, np.pi, -np.pi / 2, np.pi / 4])
    ranges = rays.cast(ROOM, 0.5, -1.0, 2.0, 1.0, 4.5, angles, 50.0)
    # The room's inside: x from -0.5 to 8.5, y from 2.5 to 6.5.
    assert ranges == pytest.approx([7.5, 2.0, 1.5, 2.0, 2.0 * np.sqrt(2)])


def test_beyond_range_max_nothing_is_seen():
    assert rays.cast(ROOM, 0.5, -1.0, 2.0, 1.0, 4.5, np.array([0.0, np.pi]), 2.0).tolist() \
        == [np.inf, 1.5]


def test_from_within_an_occupied_cell_the_range_is_0():
    assert rays.cast(ROOM, 1.0, 0.0, 0.0, 0.5, 0.5, np.array([1.0]), 5.0).tolist() == [0.0]


def test_rays_enter_the_grid_from_outside_and_leave_it():
    ranges = rays.cast(ROOM, 1.0, 0.0, 0.0, -3.0, 5.5, np.array([0.0, 2.0, np.pi]), 50.0)
    assert ranges.tolist() == [3.0, np.inf, np.inf]


@pytest.mark.parametrize("x, y, angle", [(-3, 0.5, 0.0), (0.5, -3, np.pi / 2), (23, 9.5, np.pi),
                                         (19.5, 13, -np.pi / 2)])
def test_rays_enter_along_the_grid_s_edges_from_all_sides(x, y, angle):
    assert rays.cast(ROOM, 1.0, 0.0, 0.0, x, y, np.array([angle]), 50.0) == pytest.approx([3.0])


def test_every_cell_on_the_way_is_seen():
    thin = np.zeros((40, 40), np.uint8)
    thin[np.arange(40), np.arange(40)] = 1  # a wall of corners that touch
    angles = np.linspace(-np.pi / 4 + 0.02, 3 * np.pi / 4 - 0.02, 101)
    ranges = rays.cast(thin, 1.0, 0.0, 0.0, 25.5, 15.5, angles + np.pi / 2, 1000.0)
    across = 10.0 / np.sqrt(2) / np.cos(angles + np.pi / 2 - 3 * np.pi / 4)
    inside = across < 12.0
    assert inside.sum() > 20
    assert (abs(ranges[inside] - across[inside]) < 1.5).all()


@pytest.mark.parametrize("begin, end", [((1, 1), (3, 5)), ((3, 5), (1, 1))])
def test_cells_between_two_are_counted_once_without_the_last(begin, end):
    counts = np.zeros((5, 7), np.int32)
    rays.count_between(counts, *begin, *end, 1)
    assert counts.sum() == 6 and counts.max() == 1
    assert counts[begin] == 1 and counts[end] == 0


@pytest.mark.parametrize("line", [0, 1, 2])
def test_counting_passes_over_what_lies_outside(line):
    counts = np.zeros((3, 3), np.int32)
    rays.count_between(counts, line, -2, line, 9, 1)
    rays.count_between(counts, 9, line, -2, line, 2)
    expected = np.zeros((3, 3))
    expected[line] += 1
    expected[:, line] += 2
    assert (counts == expected).all()
