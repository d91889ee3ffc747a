"""What particle SLAM is made of, each with answers worked out by hand."""

from itertools import pairwise

import numpy as np
import pytest

from nav_algorithms import poses
from nav_algorithms.beam_walls import ALONG, holds
from nav_algorithms.grid import FREE, OCCUPIED
from nav_algorithms.hit_maps import ABSENT, HITS, NEAR, HitMaps, value_at
from nav_algorithms.map_rendering import MARGIN, MapRendering
from nav_algorithms.pose_tree import PoseTree
from nav_algorithms.proposals import propose
from nav_algorithms.scan_matching import MISS, _wall_near, evaluate, prior_cost, refine, search
from nav_algorithms.slam_motion import STILL, StepSum
from nav_algorithms.small_matrices import cholesky, solve_backwards, solve_forwards

CORNER = np.vstack([np.column_stack((np.full(120, 2.0), np.linspace(-3, 1, 120))),
                    np.column_stack((np.linspace(-3, 2, 150), np.full(150, 1.0)))])
WIDTH = 0.03  # rad, about what lies between two of its points
LOOSE = np.diag([1e-4, 1e-4, 1e-3])  # information of an odometry that hardly counts
WIDTHS = np.array([1.5, 20.0, 1.0])


def beams_of(points: np.ndarray) -> np.ndarray:
    """As the matcher wants them."""
    ranges = np.hypot(points[:, 0], points[:, 1])
    return np.hstack((points / 0.05, holds(points, ranges, WIDTH)))


def corner_map(resolution: float = 0.05) -> HitMaps:
    maps = HitMaps(1, resolution, (-5, -5), (5, 5))
    for _ in range(3):
        maps.add(np.zeros((1, 3)), CORNER)
    return maps


@pytest.mark.parametrize("off", [(0.04, 0.0, 0.0), (-0.03, 0.05, 0.02), (0.0, 0.0, -0.04)])
def test_refinement_finds_the_pose_finer_than_a_cell(off):
    maps, off = corner_map(), np.array(off)
    pose = maps.in_cells(off[None])[0]
    lower = np.empty((3, 3))
    _, score = refine(maps.tables[0], maps.pool, beams_of(CORNER), pose.copy(), LOOSE, pose, 15, 1,
                      WIDTHS, lower)
    found = pose - maps.in_cells(np.zeros((1, 3)))[0]
    assert abs(found[:2] * 0.05).max() < 0.004
    assert abs(found[2]) < 0.002
    assert score > 0.95 * len(CORNER)


def test_along_a_single_wall_the_odometry_decides():
    maps = HitMaps(1, 0.05, (-5, -5), (5, 5))
    wall = np.column_stack((np.linspace(-2, 2, 200), np.full(200, 1.0)))
    maps.add(np.zeros((1, 3)), wall)
    prior = maps.in_cells(np.array([[0.2, 0.03, 0.0]]))[0]
    pose, lower = prior.copy(), np.empty((3, 3))
    inside = beams_of(wall[abs(wall[:, 0]) < 1.5])
    refine(maps.tables[0], maps.pool, inside, prior, np.diag([1.0, 0.1, 100.0]), pose, 10, 1,
           WIDTHS, lower)
    assert pose[0] == pytest.approx(prior[0], abs=0.3)
    assert pose[1] == pytest.approx(maps.in_cells(np.zeros((1, 3)))[0][1], abs=0.05)


def test_beyond_the_known_part_of_a_wall_nothing_holds_the_robot_back():
    maps = HitMaps(1, 0.05, (-5, -5), (5, 5))
    wall = np.column_stack((np.linspace(-2, 2, 60), np.full(60, 1.0)))
    for _ in range(5):
        maps.add(np.zeros((1, 3)), wall)
    prior = maps.in_cells(np.array([[0.15, 0.0, 0.0]]))[0]
    pose, lower = prior.copy(), np.empty((3, 3))
    refine(maps.tables[0], maps.pool, beams_of(wall), prior, np.diag([40.0, 40.0, 4e4]), pose, 10,
           1, np.array([1.5, 20.0, 0.25]), lower)
    assert abs(pose[0] - prior[0]) < 0.05


def test_beams_hold_across_a_wall_and_both_ways_at_a_corner_or_a_post():
    angles = np.arange(360) * 2 * np.pi / 360
    square = 2.0 / np.maximum(abs(np.cos(angles)), abs(np.sin(angles)))
    square[[20, 21]] = 1.0  # a post before the wall at x = 2
    ends = square[:, None] * np.column_stack((np.cos(angles), np.sin(angles)))
    held = holds(ends, square, angles[1])
    assert held[0] == pytest.approx((1, 0, ALONG), abs=1e-6)
    assert held[90] == pytest.approx((ALONG, 0, 1), abs=1e-6)
    for both_ways in (20, 45):
        assert held[both_ways] == pytest.approx((1, 0, 1), abs=1e-6)


def test_at_the_end_of_a_wall_that_stands_aslant_beams_hold_across_it():
    along = np.linspace(0.0, 2.0, 41)
    ends = np.column_stack((2.0 - along, along))
    held = holds(ends, np.hypot(*ends.T), 0.02)
    half = 0.5 * (1.0 - ALONG)
    assert held[[0, 20, 40]] == pytest.approx(np.tile((1.0 - half, half, 1.0 - half), (3, 1)))


def test_of_sparse_beams_three_to_either_side_say_which_way_the_wall_goes():
    angles = np.radians(np.arange(0, 360, 5))  # 17 cm and more apart
    square = 2.0 / np.maximum(abs(np.cos(angles)), abs(np.sin(angles)))
    ends = square[:, None] * np.column_stack((np.cos(angles), np.sin(angles)))
    held = holds(ends, square, angles[1])
    assert held[:6] == pytest.approx(np.tile((1, 0, ALONG), (6, 1)), abs=1e-6)
    assert held[8] != pytest.approx((1, 0, ALONG), abs=0.1)  # the corner is the ninth


@pytest.mark.parametrize("off", [(5.0, -3.0, 0.2), (-5.0, 5.0, -0.2), (0.0, -5.0, 0.0)])
def test_the_search_finds_its_way_from_far(off):
    maps = corner_map()
    truth = maps.in_cells(np.zeros((1, 3)))[0]
    prior = truth + off
    best = np.empty(3)
    search(maps.tables[0], maps.pool, beams_of(CORNER), prior, LOOSE,
           np.array([5, 5, 4]), np.array([1.0, 1.0, 0.05]), 2, best)
    assert best == pytest.approx(truth, abs=1e-9)


@pytest.mark.parametrize("yaw", [-2.0, 0.5, 1.0])
def test_the_search_finds_its_way_for_a_robot_that_looks_anywhere(yaw):
    maps = corner_map()
    truth = maps.in_cells(np.array([[0.0, 0.0, yaw]]))[0]
    turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    best = np.empty(3)
    search(maps.tables[0], maps.pool, beams_of(CORNER @ turn), truth + np.array([4.0, -3.0, 0.15]),
           LOOSE, np.array([5, 5, 4]), np.array([1.0, 1.0, 0.05]), 2, best)
    assert best[:2] == pytest.approx(truth[:2], abs=1.1)  # walls lie on the cells' edges
    assert best[2] == pytest.approx(truth[2], abs=0.06)


def test_a_match_worse_than_the_odometry_is_not_believed():
    maps = HitMaps(1, 0.05, (-5, -5), (5, 5))
    points = CORNER + 0.03  # within the cells, of which the search takes the first
    maps.add(np.zeros((1, 3)), points)
    prior, matched = maps.in_cells(np.zeros((1, 3))), np.empty((1, 3))
    drawn, factors = prior.copy(), np.empty((1, 3, 3))
    propose(maps.tables, maps.pool, beams_of(points), prior, drawn, 0.0 * LOOSE[None],
            np.zeros((1, 3)), np.array([1, 1, 0]), np.array([0.5, 0.5, 1.0]), 1, 0, 1, WIDTHS, 1.0,
            1, np.empty(1), matched, factors)
    assert matched[0].tolist() == prior[0].tolist() == drawn[0].tolist()


def test_a_scan_that_fits_too_little_leaves_the_odometry_s_draw():
    maps, off = corner_map(), np.array([[0.04, 0.0, 0.0]])
    prior, matched = maps.in_cells(off), np.empty((1, 3))
    for fewest, stays in ((100.0, False), (1000.0, True)):
        drawn, factors = prior + 0.3, np.empty((1, 3, 3))
        propose(maps.tables, maps.pool, beams_of(CORNER), prior, drawn, LOOSE[None],
                np.zeros((1, 3)), np.array([0, 0, 0]), np.array([0.5, 0.5, 1.0]), 1, 15, 1, WIDTHS,
                fewest, 1, np.empty(1), matched, factors)
        assert (drawn == (prior + 0.3 if stays else matched)).all()
        assert (matched == drawn).all() and (not factors.any()) == stays


def test_a_heading_alone_is_refined_step_by_step():
    """In the middle of a square room nothing moves the robot aside."""
    along = np.linspace(-1.975, 1.975, 80)
    wall = np.column_stack((np.full(80, 2.0125), along))
    square = np.vstack([wall @ turn for turn in (np.eye(2), [[0, 1], [-1, 0]], -np.eye(2),
                                                 [[0, -1], [1, 0]])])
    maps = HitMaps(1, 0.05, (-5, -5), (5, 5))
    for _ in range(3):
        maps.add(np.zeros((1, 3)), square)
    middle = maps.in_cells(np.zeros((1, 3)))[0]
    pose = middle + np.array([0.0, 0.0, 0.04])
    refine(maps.tables[0], maps.pool, beams_of(square), pose.copy(), LOOSE, pose, 30, 1, WIDTHS,
           np.empty((3, 3)))
    assert pose == pytest.approx(middle, abs=1e-3)


def test_where_nothing_is_known_the_odometry_s_pose_is_the_best():
    maps = HitMaps(1, 0.05, (-5, -5), (5, 5))
    prior = maps.in_cells(np.array([[0.2, 0.1, 0.3]]))[0]
    pose = prior + np.array([1.0, -1.0, 0.1])
    refine(maps.tables[0], maps.pool, beams_of(CORNER), prior, np.diag([1.0, 2.0, 300.0]), pose, 1,
           1, WIDTHS, np.empty((3, 3)))
    assert pose == pytest.approx(prior)


@pytest.mark.parametrize("place", [(0.2, 0.3), (50.5, 60.5), (-9.0, -9.0)])
def test_a_beam_that_ends_at_no_wall_is_a_miss_wherever_that_is(place):
    maps = corner_map()
    beams = np.array([[0.0, 0.0, 1.0, 0.0, 1.0]])
    found = evaluate(maps.tables[0], maps.pool, beams, np.array([*place, 0.0]), 1, 1, WIDTHS,
                     np.empty((3, 3)), np.empty(3))
    assert found == (-MISS, 0.0)


def test_a_beam_counts_by_how_far_from_the_wall_it_ends():
    maps = HitMaps(1, 0.05, (-5, -5), (5, 5))
    for _ in range(3):
        maps.add(np.zeros((1, 3)), np.array([[1.0, 1.0]]))
    pose = maps.in_cells(np.array([[1.0, 1.0, 0.0]]))[0] + np.array([0.6, -0.3, 0.0])
    for across, square in (((1.0, 0.0, 0.0), 0.36), ((1.0, 0.0, 1.0), 0.45)):
        found = evaluate(maps.tables[0], maps.pool, np.array([[0.0, 0.0, *across]]), pose, 1, 1,
                         WIDTHS, np.empty((3, 3)), np.empty(3))
        assert found == pytest.approx((-0.5 * square / 1.5**2, np.exp(-square / 20.0)))


def test_two_deviations_off_the_odometry_cost_2():
    assert prior_cost(np.array([1.0, 0.2, 0.0]), np.array([1.0, 0.0, 0.0]),
                      np.diag([1.0, 1 / 0.1**2, 1.0])) == pytest.approx(2.0)


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


def test_maps_keep_their_hits_when_they_grow():
    maps = HitMaps(1, 0.1, (0, 0), (1, 1.7))
    assert maps.tables.shape == (1, 2, 1)  # a patch is 1.6 m wide
    maps.add(np.zeros((1, 3)), np.array([[0.55, 0.55]]))
    maps.add(np.zeros((1, 3)), np.array([[-0.95, 9.05]]))
    for column, row in maps.in_cells(np.array([[0.55, 0.55, 0], [-0.95, 9.05, 0]]))[:, :2]:
        assert value_at(maps.tables[0], maps.pool, int(row), int(column), HITS) == 1.0


def test_a_wall_counts_in_full_from_three_hits_on():
    maps = HitMaps(1, 1.0, (0, 0), (8, 8))
    for hits in range(1, 7):
        maps.add(np.zeros((1, 3)), np.array([[4.3, 5.6]]))
        x, y = maps.in_cells(np.array([[4.3, 5.6, 0.0]]))[0, :2]
        found = _wall_near(maps.tables[0], maps.pool, x - 0.2, y + 0.1, 1)
        assert found == pytest.approx((min(1.0, hits / 3), x, y))


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
