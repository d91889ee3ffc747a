"""What particle SLAM is made of, each with answers worked out by hand."""

from itertools import pairwise

import numpy as np
import pytest

from nav_algorithms import poses
from nav_algorithms.cells import FREE, OCCUPIED
from nav_algorithms.hit_maps import ABSENT, HITS, NEAR, HitMaps, value_at
from nav_algorithms.map_rendering import MARGIN, MapRendering
from nav_algorithms.motion_models import STILL, StepSum
from nav_algorithms.particle_slam import PoseTree
from nav_algorithms.small_matrices import cholesky, solve_backwards, solve_forwards


def test_patches_are_shared_until_one_owner_writes():
    maps = HitMaps(2, 0.1, (-3.2, -3.2), (3.2, 3.2))
    maps.add(np.zeros((2, 3)), np.array([[1.05, 1.05]]))
    maps.choose(np.array([1, 1]))
    assert (maps.tables[0] == maps.tables[1]).all()
    shared = maps.tables.max()
    apart = np.array([[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]])
    maps.add(apart, np.array([[1.05, 1.05]]))
    hits = [[value_at(maps.tables[i], maps.pool, 42, c, HITS) for c in (42, 47)] for i in (0, 1)]
    assert hits == [[2.0, 0.0], [1.0, 1.0]]
    assert shared in maps.tables[1] and shared not in maps.tables[0]  # the last owner's own


def test_the_search_takes_a_hit_s_neighbours_for_half_a_wall():
    maps = HitMaps(1, 0.1, (0, 0), (2, 2))
    maps.add(np.zeros((1, 3)), np.array([[1.05, 0.85]]))
    column, row = maps.in_cells(np.array([[1.05, 0.85, 0.0]]))[0, :2].astype(int)
    around = [[value_at(maps.tables[0], maps.pool, row + r, column + c, NEAR)
               for c in range(-2, 3)] for r in range(-2, 3)]
    expected = np.pad(np.ones((3, 3)), 1)
    expected[2, 2] = 2.0
    assert around == expected.tolist()


def test_unowned_patches_are_used_again():
    maps = HitMaps(4, 0.1, (0, 0), (20, 20))
    random = np.random.default_rng(0)
    for _ in range(200):
        maps.add(np.column_stack((random.uniform(2, 18, (4, 2)), np.zeros(4))),
                 random.uniform(-1, 1, (50, 2)))
        maps.choose(np.array([0, 0, 1, 2]))
    assert len(maps.pool) <= 1024
    used = maps.tables[maps.tables != ABSENT]
    assert used.max() < len(maps.pool)


def test_a_scan_over_a_whole_hall_finds_room_in_every_map():
    along = np.arange(-19.75, 20.0, 1.6)  # a hit in each patch
    points = np.stack(np.meshgrid(along, along), axis=-1).reshape(-1, 2)
    maps = HitMaps(3, 0.1, (-22, -22), (22, 22))
    robots = np.array([[0.0, 0.0, 0.0], [0.2, 0.0, 0.0], [0.4, 0.0, 0.0]])
    maps.add(robots, points)
    for robot, table in zip(robots, maps.tables, strict=True):
        ends = np.column_stack((points, 0 * points[:, 0])) + robot
        hits = {value_at(table, maps.pool, row, column, HITS)
                for column, row, _ in np.floor(maps.in_cells(ends)).astype(int)}
        assert hits == {1.0}


def test_maps_keep_their_hits_when_they_grow():
    maps = HitMaps(1, 0.1, (0, 0), (1, 1.7))
    assert maps.tables.shape == (1, 2, 1)  # a patch is 1.6 m wide
    maps.add(np.zeros((1, 3)), np.array([[0.55, 0.55]]))
    maps.add(np.zeros((1, 3)), np.array([[-0.95, 9.05]]))
    for column, row in maps.in_cells(np.array([[0.55, 0.55, 0], [-0.95, 9.05, 0]]))[:, :2]:
        assert value_at(maps.tables[0], maps.pool, int(row), int(column), HITS) == 1.0


def test_paths_survive_choosing_and_forgetting():
    tree, random = PoseTree(3), np.random.default_rng(1)
    paths = [[], [], []]
    for scan in range(500):
        new = random.normal(size=(3, 3))
        tree.append(new, scan)
        paths = [[*path, pose] for path, pose in zip(paths, new, strict=True)]
        if scan % 3 == 0:
            chosen = random.integers(0, 3, 3)
            tree.choose(chosen)
            paths = [list(paths[i]) for i in chosen]
    for i in range(3):
        found, scans = tree.path(i)
        assert found == pytest.approx(np.array(paths[i]))
        assert scans.tolist() == list(range(500))
    assert len(tree._parents) < 1500  # of 1500 nodes most were forgotten


def test_a_changed_path_leaves_no_trace_in_the_map():
    random = np.random.default_rng(2)
    scans = [(random.uniform(-2, 2, (40, 2)), random.random(40) < 0.7) for _ in range(6)]
    first, second = random.uniform(-1, 1, (2, 6, 3))
    second[:2] = first[:2]
    laser = np.array([0.1, 0.0])
    changed = MapRendering(0.1, (-1, -1), (1, 1))
    changed.follow(first[:5], np.arange(5), scans, laser)
    changed.follow(second, np.arange(6), scans, laser)
    straight = MapRendering(0.1, (-1, -1), (1, 1))
    straight.follow(second, np.arange(6), scans, laser)
    low = (-2.0, -2.0)
    ours, theirs = changed.grid(0.25), straight.grid(0.25)
    a, b = ours.cells_of(low), theirs.cells_of(low)
    assert (ours.cells[a[0]:a[0] + 40, a[1]:a[1] + 40]
            == theirs.cells[b[0]:b[0] + 40, b[1]:b[1] + 40]).all()


def test_a_rendering_grows_by_what_is_seen_and_a_margin():
    rendering = MapRendering(0.1, (-1, -1), (1, 1))
    scan = (np.array([[3.05, 0.05], [0.05, 3.05]]), np.array([True, True]))
    rendering.follow(np.array([[0.5, 0.0, 0.0]]), np.arange(1), [scan], np.zeros(2))
    grid = rendering.grid(0.25)
    assert (grid.cells[tuple(grid.cells_of([[3.55, 0.05], [0.55, 3.05]]).T)] == OCCUPIED).all()
    # About the robot as far as it saw and two cells, and MARGIN to each side
    far = np.hypot(3.05, 0.05) + 0.2 + MARGIN - 1e-6
    for side in ((far, 0.0), (-far, 0.0), (0.0, far), (0.0, -far)):
        assert grid.contains(grid.cells_of(np.add((0.5, 0.0), side)))
    assert max(grid.cells.shape) * 0.1 <= 2 * far + 0.2


def test_a_cell_is_occupied_where_more_than_the_threshold_of_the_beams_end():
    rendering = MapRendering(0.1, (0, 0), (1.05, 0.3))
    assert rendering.grid(0.25).cells.shape == (3, 11)
    scan = np.array([[0.55, 0.25]] + 3 * [[0.95, 0.25]]), np.array([True] + 3 * [False])
    rendering.follow(np.zeros((1, 3)), np.zeros(1, int), [scan], np.array([0.05, 0.25]))
    for threshold, expected in ((0.25, FREE), (0.2, OCCUPIED)):
        grid = rendering.grid(threshold)
        assert grid.cells[tuple(grid.cells_of((0.55, 0.25)))] == expected


def test_uncertain_steps_add_up():
    total = StepSum(0.1, 0.2, 0.0, 0.0)
    for x in range(4):
        total.add(np.array([x, 0, 0]), np.array([x + 1.0, 0, 0]))
    assert total.mean == pytest.approx((4, 0, 0))
    assert total.distance == pytest.approx(4)
    assert total.covariance[0, 0] == pytest.approx(4 * 0.1**2 + STILL[0])
    assert total.covariance[2, 2] == pytest.approx(4 * 0.2**2 + STILL[2])
    # A turn after the first metre carries the next three aside: 0.2 rad * (3, 2, 1, 0) m.
    aside = 4 * (0.3 * 0.1)**2 + 0.2**2 * (9 + 4 + 1) + STILL[1] + 16 * STILL[2]
    assert total.covariance[1, 1] == pytest.approx(aside)


def test_after_a_quarter_turn_a_step_is_uncertain_across():
    total = StepSum(0.1, 0.0, 0.0, 0.0)
    total.add(np.zeros(3), np.array([0, 0, np.pi / 2]))
    total.add(np.zeros(3), np.array([1.0, 0, 0]))
    wanted = np.diag(STILL) + np.diag([0.03**2 + STILL[2], 0.1**2, 0.0])
    wanted[0, 2] = wanted[2, 0] = -STILL[2]  # 1 m ahead, which is y
    assert total.covariance == pytest.approx(wanted)


def test_what_walls_show_of_the_odometry_is_learnt():
    posterior = np.diag([1e-6, 1e-6, 1e-8])
    for error, turning, wanted in ((0.0, 0.0, 0.01), (0.05, 0.1, 0.25), (9.0, 9.0, 4.0)):
        total = StepSum(0.1, 0.2, 0.0, 0.0)
        for _ in range(80):
            total.clear()
            total.add(np.zeros(3), np.array([1.0, 0, 0]))
            total.learn(np.array([error, 0.3 * error, turning]), posterior)
        assert total.scale == pytest.approx((wanted,) * 3, rel=0.1)


def test_what_is_learnt_at_first_is_the_mean_of_the_parameters_and_what_was_shown():
    total = StepSum(0.1, 0.2, 0.0, 0.0)
    shown = [1.0, 2.0, 0.6, 3.0]  # shares of the variance that the parameters give
    for count, share in enumerate(shown[1:], 2):
        total.clear()
        total.add(np.zeros(3), np.array([1.0, 0, 0]))
        error = np.sqrt(share * np.diag(total.covariance) / total.scale)
        total.learn(error, np.zeros((3, 3)))
        assert total.scale == pytest.approx([np.mean(shown[:count])] * 3)


def test_where_walls_show_nothing_nothing_is_learnt():
    total = StepSum(0.1, 0.2, 0.0, 0.0)
    total.add(np.zeros(3), np.array([1.0, 0, 0]))
    total.learn(np.zeros(3), 0.8 * total.covariance)
    assert total.scale.tolist() == [1, 1, 1]


def test_steps_add_up_to_the_way_between_their_ends():
    ends = np.random.default_rng(3).normal(size=(8, 3))
    total = StepSum(0.1, 0.2, 0.1, 0.2)
    for before, after in pairwise(ends):
        total.add(before, after)
    assert total.mean == pytest.approx(poses.relative(ends[0], ends[-1]))


def test_cholesky_and_its_solutions():
    random = np.random.default_rng(4).normal(size=(3, 3))
    matrix, lower, vector = random @ random.T, np.empty((3, 3)), np.array([1.0, 2.0, 3.0])
    assert cholesky(matrix, lower)
    assert lower == pytest.approx(np.linalg.cholesky(matrix))
    solve_forwards(lower, vector)
    solve_backwards(lower, vector)
    assert matrix @ vector == pytest.approx((1, 2, 3))
    assert not cholesky(-matrix, lower)
    assert not cholesky(np.diag([1.0, 1.0, -1e-3]), lower)
