"""Map agreement and trajectory error, on maps and paths whose answers are known."""

import numpy as np
import pytest

from evaluation.navigate_score import map_agreement
from evaluation.trajectory_error import align, at_moments, trajectory_error
from nav_algorithms.cells import OccupancyGrid
from nav_algorithms.poses import compose, invert


def room():
    """A room of 10 rows and 12 columns, walls round it, on a grid of 0.1 m: 40 wall cells."""
    cells = np.zeros((10, 12), np.int8)
    cells[[0, -1]] = cells[:, [0, -1]] = 100
    return OccupancyGrid(cells, 0.1, (-0.5, -0.5))


def changed(grid, *changes):
    cells = grid.cells.copy()
    for where, value in changes:
        cells[where] = value
    return OccupancyGrid(cells, grid.resolution, grid.origin)


def test_a_perfect_map():
    found = map_agreement(room(), room())
    assert (found.occupied_near_walls, found.walls_found) == (1.0, 1.0)
    assert (found.occupied_cells, found.wall_cells) == (40, 40)


def test_one_cell_beside_counts_two_do_not():
    one = changed(room(), (np.s_[1:-1, -1], 0), (np.s_[1:-1, -2], 100))
    two = changed(room(), (np.s_[2:-2, -1], 0), (np.s_[2:-2, -3], 100))
    assert map_agreement(one, room()).occupied_near_walls == 1.0
    assert map_agreement(two, room()).occupied_near_walls == pytest.approx(34 / 40)
    # of the 6 wall cells moved away, the outer 2 have a neighbour on the map
    assert map_agreement(two, room()).walls_found == pytest.approx(36 / 40)


def test_a_wall_that_the_map_misses_counts_once_it_was_seen():
    half = changed(room(), (np.s_[:, 6:], -1))
    assert map_agreement(half, room()).occupied_near_walls == 1.0
    # beside what is known: columns 0 to 6, of which 0 to 5 are on the map, and 6 is beside them
    assert map_agreement(half, room()).walls_found == 1.0
    everything = np.ones(room().cells.shape, bool)
    found = map_agreement(half, room(), everything)
    assert (found.walls_found, found.wall_cells) == (pytest.approx(22 / 40), 40)
    assert "55.0% of the 40 true wall cells" in str(found)
    assert "100.0% of the map's 20 occupied cells" in str(found)


def test_an_invented_wall():
    found = map_agreement(changed(room(), (np.s_[4:6, 3:8], 65)), room())
    assert found.occupied_near_walls == pytest.approx(40 / 50)
    assert found.walls_found == 1.0
    assert map_agreement(changed(room(), (np.s_[4:6, 3:8], 64)), room()).occupied_cells == 40


def test_frames_and_resolutions_may_differ():
    pose = np.array([3.0, -2.0, np.pi / 2])
    fine = OccupancyGrid(np.kron(room().cells, np.ones((4, 4), np.int8)), 0.025, (-0.5, -0.5))
    turned = OccupancyGrid(np.ascontiguousarray(np.rot90(fine.cells, 1)), 0.025,
                           (-2.5, 2.5 - 2 * 0.1 - 0.9))
    assert map_agreement(fine, room()).occupied_near_walls == 1.0
    # A point (x, y) of `fine` is at (3 - y, x - 2) in the truth: rot90's image, moved.
    truth = OccupancyGrid(np.ascontiguousarray(room().cells.T[:, ::-1]), 0.1, (2.5, -2.5))
    found = map_agreement(fine, truth, built_in_truth=pose)
    assert (found.occupied_near_walls, found.walls_found) == (1.0, 1.0)
    assert map_agreement(turned, truth).occupied_near_walls < 0.2


def test_nothing_agrees_with_nothing():
    empty = changed(room(), (np.s_[:], -1))
    assert map_agreement(empty, room()).occupied_near_walls == 0.0
    assert map_agreement(room(), empty).occupied_near_walls == 0.0
    far = OccupancyGrid(room().cells, 0.1, (50.0, 0.0))
    assert map_agreement(far, room(), np.ones((10, 12), bool)).walls_found == 0.0


def circle(count=50):
    angles = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return np.stack((np.cos(angles), np.sin(angles), angles + np.pi / 2), axis=1)


def test_a_path_that_is_only_moved_has_no_error_once_aligned():
    pose = np.array([1.0, 2.0, 2.5])
    moved = compose(pose, circle())
    found = trajectory_error(moved, circle())
    assert found.ate_rmse == pytest.approx(0.0, abs=1e-12)
    assert found.yaw_rmse == pytest.approx(0.0, abs=1e-12)
    assert found.alignment == pytest.approx(invert(pose))
    apart = np.hypot(*(moved - circle())[:, :2].T)
    assert found.rmse == pytest.approx(np.sqrt(np.mean(apart**2)))
    assert found.largest == pytest.approx(apart.max())


def test_scale_is_not_aligned_away():
    bigger = circle() * [1.1, 1.1, 1.0]
    found = trajectory_error(bigger, circle())
    assert (found.ate_rmse, found.rmse) == (pytest.approx(0.1), pytest.approx(0.1))


def test_alignment_is_the_best_there_is():
    random = np.random.default_rng(0)
    points, targets = random.normal(size=(2, 30, 2))
    best = align(points, targets)

    def error(pose):
        return trajectory_error(compose(pose, np.c_[points, np.zeros(30)]),
                                np.c_[targets, np.zeros(30)]).rmse

    for change in np.vstack((np.eye(3), -np.eye(3))) * 1e-3:
        assert error(best) < error(best + change)


def test_one_wrong_yaw():
    turned = circle()
    turned[0, 2] += 1.0
    assert trajectory_error(turned, circle()).yaw_rmse == pytest.approx(1.0 / np.sqrt(50))


@pytest.mark.parametrize("shape", [(49, 3), (50, 2), (0, 3)])
def test_wrong_shapes(shape):
    with pytest.raises(ValueError, match=r"poses are \(N, 3\) twice"):
        trajectory_error(np.zeros(shape), np.zeros(shape) if shape == (0, 3) else circle())


def test_between_moments():
    stamps = np.array([0.0, 1.0, 2.0])
    poses = np.array([[0.0, 0.0, 3.0], [1.0, 2.0, -3.0], [1.0, 2.0, -3.0]])
    found = at_moments(stamps, poses, np.array([0.5, 1.5, -0.1, 2.1]))
    assert found[0] == pytest.approx([0.5, 1.0, np.pi])  # the short way round
    assert found[1] == pytest.approx([1.0, 2.0, -3.0])
    assert np.isnan(found[2:]).all()
