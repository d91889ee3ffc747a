"""How scans are matched to a map of hits, with answers worked out by hand."""

import numpy as np
import pytest

from nav_algorithms.beam_walls import ALONG, holds
from nav_algorithms.hit_maps import HitMaps
from nav_algorithms.proposals import Matching, Odometry, propose
from nav_algorithms.scan_matching import _wall_near, evaluate, prior_cost, refine, search

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
    prior = maps.in_cells(np.zeros((1, 3)))
    drawn, _, matched, _ = propose(
        maps.tables, maps.pool, beams_of(points),
        Odometry(prior, 0.0 * LOOSE[None], prior.copy(), np.zeros((1, 3))),
        Matching(np.array([1, 1, 0]), np.array([0.5, 0.5, 1.0]), 1, 0, 1, WIDTHS, 1, 1.0))
    assert matched[0].tolist() == prior[0].tolist() == drawn[0].tolist()


def test_a_scan_that_fits_too_little_leaves_the_odometry_s_draw():
    maps, off = corner_map(), np.array([[0.04, 0.0, 0.0]])
    prior = maps.in_cells(off)
    for fewest, stays in ((100.0, False), (1000.0, True)):
        drawn, _, matched, factors = propose(
            maps.tables, maps.pool, beams_of(CORNER),
            Odometry(prior, LOOSE[None], prior + 0.3, np.zeros((1, 3))),
            Matching(np.zeros(3, np.int64), np.array([0.5, 0.5, 1.0]), 1, 15, 1, WIDTHS, 1, fewest))
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
    assert found == (-6.7, 0.0)  # as much as 3.7 deviations off a wall


def test_a_beam_counts_by_how_far_from_the_wall_it_ends():
    maps = HitMaps(1, 0.05, (-5, -5), (5, 5))
    for _ in range(3):
        maps.add(np.zeros((1, 3)), np.array([[1.0, 1.0]]))
    pose = maps.in_cells(np.array([[1.0, 1.0, 0.0]]))[0] + np.array([0.6, -0.3, 0.0])
    for across, square in (((1.0, 0.0, 0.0), 0.36), ((1.0, 0.0, 1.0), 0.45)):
        found = evaluate(maps.tables[0], maps.pool, np.array([[0.0, 0.0, *across]]), pose, 1, 1,
                         WIDTHS, np.empty((3, 3)), np.empty(3))
        assert found == pytest.approx((-0.5 * square / 1.5**2, np.exp(-square / 20.0)))


@pytest.mark.parametrize("yaw", [0.0, 0.5, -2.0])
@pytest.mark.parametrize("across", [0.0, 0.4, -1.2])
def test_only_how_far_off_across_its_wall_a_beam_ends_counts(yaw, across):
    """The way across the wall as the robot sees it turns with the robot."""
    maps = HitMaps(1, 0.05, (-5, -5), (5, 5))
    for _ in range(3):
        maps.add(np.zeros((1, 3)), np.array([[1.0, 1.0]]))
    off = np.array([0.6, -0.3])
    pose = maps.in_cells(np.array([[1.0, 1.0, yaw]]))[0] + np.array([*off, 0.0])
    x, y = np.cos(across), np.sin(across)
    found = evaluate(maps.tables[0], maps.pool, np.array([[0.0, 0.0, x * x, x * y, y * y]]), pose,
                     1, 1, WIDTHS, hessian := np.empty((3, 3)), np.empty(3))
    seen = np.array([np.cos(yaw + across), np.sin(yaw + across)])
    assert found[0] == pytest.approx(-0.5 * (seen @ off)**2 / 1.5**2)
    weight = 1.0 - (seen @ off)**2 / 1.5**2  # less the farther off it is within the kernel
    assert hessian[:2, :2] == pytest.approx(weight * np.outer(seen, seen))


def test_two_deviations_off_the_odometry_cost_2():
    assert prior_cost(np.array([1.0, 0.2, 0.0]), np.array([1.0, 0.0, 0.0]),
                      np.diag([1.0, 1 / 0.1**2, 1.0])) == pytest.approx(2.0)


def test_a_wall_counts_in_full_from_three_hits_on():
    maps = HitMaps(1, 1.0, (0, 0), (8, 8))
    for hits in range(1, 7):
        maps.add(np.zeros((1, 3)), np.array([[4.3, 5.6]]))
        x, y = maps.in_cells(np.array([[4.3, 5.6, 0.0]]))[0, :2]
        found = _wall_near(maps.tables[0], maps.pool, x - 0.2, y + 0.1, 1)
        assert found == pytest.approx((min(1.0, hits / 3), x, y))
