"""Footprints on costmaps, with answers worked out by hand."""

import numpy as np
import pytest

from nav_algorithms.costmap import footprint
from nav_algorithms.costmap.costs import INSCRIBED, LETHAL, UNKNOWN, Costmap

SQUARE = np.array([[-0.2, -0.1], [-0.2, 0.1], [0.3, 0.1], [0.3, -0.1]])


def empty(cells=40):
    return Costmap(np.zeros((cells, cells), np.uint8), 0.1, (-2.0, -2.0))


def test_radii_are_of_the_nearest_edge_and_the_farthest_corner():
    assert footprint.radii(SQUARE) == pytest.approx((0.1, np.hypot(0.3, 0.1)))
    with pytest.raises(ValueError, match="three corners"):
        footprint.radii(SQUARE[:2])


def test_a_circle_has_its_corners_at_the_radius():
    assert footprint.radii(footprint.circle(0.5)) == pytest.approx((0.5 * np.cos(np.pi / 16), 0.5))


def test_padding_moves_coordinates_away_from_the_axes():
    grown = footprint.padded(np.array([[0.3, 0.1], [0.0, -0.1], [-0.2, 0.0]]), 0.05)
    assert grown == pytest.approx(np.array([[0.35, 0.15], [0.0, -0.15], [-0.25, 0.0]]))


@pytest.mark.parametrize("point, expected", [
    ((0.29, 0.05), footprint.COLLISION),   # on the outline
    ((0.05, 0.05), footprint.COLLISION),   # inside
    ((0.41, 0.05), 0), ((0.05, 0.21), 0), ((-0.31, 0.0), 0)])
def test_what_is_below_the_robot_is_hit(point, expected):
    costmap = empty()
    costmap.cells[tuple(costmap.cells_of(point))] = LETHAL
    assert footprint.costs(costmap, SQUARE, (0.01, 0.01, 0.0)).tolist() == [expected]


def test_the_footprint_turns():
    costmap = empty()
    costmap.cells[tuple(costmap.cells_of((0.0, 0.305)))] = LETHAL
    poses = np.array([[0.01, 0.01, 0.0], [0.01, 0.01, np.pi / 2], [0.01, 0.01, -np.pi / 2]])
    assert footprint.costs(costmap, SQUARE, poses).tolist() == [0, footprint.COLLISION, 0]


def test_the_dearest_cell_counts_and_the_unknown_after_the_lethal():
    costmap = empty()
    costmap.cells[tuple(costmap.cells_of((0.2, 0.05)))] = INSCRIBED
    assert footprint.costs(costmap, SQUARE, (0, 0, 0)).tolist() == [INSCRIBED]
    costmap.cells[tuple(costmap.cells_of((0.1, 0.05)))] = UNKNOWN
    assert footprint.costs(costmap, SQUARE, (0, 0, 0)).tolist() == [footprint.ON_UNKNOWN]
    costmap.cells[tuple(costmap.cells_of((-0.1, 0.05)))] = LETHAL
    assert footprint.costs(costmap, SQUARE, (0, 0, 0)).tolist() == [footprint.COLLISION]


def test_outside_the_costmap():
    poses = np.array([[1.8, 0, 0], [50, 0, 0], [0, -1.95, 0]])
    assert footprint.costs(empty(), SQUARE, poses).tolist() == [-3] * 3  # as upstream's world model


@pytest.mark.parametrize("yaw", [0.0, np.pi / 2, np.pi, -np.pi / 2])
@pytest.mark.parametrize("left", [0.05, -0.05, -0.25])
def test_a_robot_is_on_the_costmap_as_long_as_its_nose_is(yaw, left):
    """The nose is 0.3 m ahead, and each edge of the costmap 2 m from its middle."""
    way = 2.0 - 0.3 - left
    pose = (way * np.cos(yaw), way * np.sin(yaw), yaw)
    assert footprint.costs(empty(), SQUARE, pose).tolist() == [
        0 if left > 0.0 else footprint.OUTSIDE]
    assert footprint.OUTSIDE == -3
    inside = np.array([[1.65, 0, 0], [-1.75, 0, 0], [0, 1.85, 0], [0, -1.85, 0]])
    assert footprint.costs(empty(), SQUARE, inside).tolist() == [0] * 4  # 5 cm to the edge


def test_random_turns_against_points_in_the_polygon():
    """Every cell that a dense cloud of the robot's points falls in is looked at."""
    generator = np.random.default_rng(1)
    cloud = np.stack(np.meshgrid(np.linspace(-0.2, 0.3, 60), np.linspace(-0.1, 0.1, 30)), -1)
    for _ in range(50):
        pose = np.array([*generator.uniform(-0.5, 0.5, 2), generator.uniform(-4, 4)])
        cos, sin = np.cos(pose[2]), np.sin(pose[2])
        points = cloud.reshape(-1, 2) @ np.array([[cos, sin], [-sin, cos]]) + pose[:2]
        costmap = empty()
        cells = np.unique(costmap.cells_of(points), axis=0)
        costmap.cells[tuple(cells[generator.integers(len(cells))])] = LETHAL
        assert footprint.costs(costmap, SQUARE, pose).tolist() == [footprint.COLLISION]
        costmap.cells[:] = LETHAL
        costmap.cells[cells.min(axis=0)[0]:cells.max(axis=0)[0] + 1,
                      cells.min(axis=0)[1]:cells.max(axis=0)[1] + 1] = 0
        assert footprint.costs(costmap, SQUARE, pose).tolist() == [0]


@pytest.mark.parametrize("cost, expected", [(100, 100), (INSCRIBED, footprint.COLLISION),
                                            (UNKNOWN, footprint.ON_UNKNOWN)])
def test_a_robot_without_outline_is_its_centre(cost, expected):
    costmap = empty()
    costmap.cells[tuple(costmap.cells_of((0.0, 0.0)))] = cost
    assert footprint.costs(costmap, np.zeros((0, 2)), (0.01, 0.01, 1.0)).tolist() == [expected]


@pytest.mark.parametrize("shape", [(40, 20), (20, 40)])
def test_a_robot_without_an_outline_is_on_the_costmap_as_long_as_its_centre_is(shape):
    costmap = Costmap(np.zeros(shape, np.uint8), 0.1, (0.0, 0.0))
    rows, columns = shape
    x, y = 0.1 * columns - 0.05, 0.1 * rows - 0.05  # of the last cell
    poses = np.array([[0.05, y, 0], [x, 0.05, 0], [x + 0.1, 0.05, 0], [0.05, y + 0.1, 0],
                      [-0.05, 0.05, 0], [0.05, -0.05, 0]])
    assert footprint.costs(costmap, np.zeros((0, 2)), poses).tolist() == [0, 0] + [-3] * 4
