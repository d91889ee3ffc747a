"""SLAM from scans alone, on made-up drives whose truth is known."""

import numpy as np
import pytest
from defaults import of
from slam_world import ANGLES, CELL, ORIGIN, PERIOD, RANGE_MAX, RING, drive, walls

from nav_algorithms import likelihood_field, poses
from nav_algorithms.cells import FREE, OCCUPIED, UNKNOWN
from nav_algorithms.scan_slam import ScanSlam, ScanSlamSettings

FINE = {"map_size": 800, "map_resolution": 0.05, "map_update_distance_thresh": 0.1,
        "map_update_angle_thresh": 0.04}
SETTINGS = of(ScanSlamSettings, **FINE)


def hits(ranges):
    seen = ranges < RANGE_MAX - 0.03
    return (ranges[seen, None] * np.column_stack((np.cos(ANGLES[seen]), np.sin(ANGLES[seen]))),
            ranges[seen])


def run(slam, scans, begin=0.0):
    """The pose after each scan, (N, 3), and how many fitted."""
    found, fitted = [], 0
    for number, ranges in enumerate(scans):
        fitted += slam.add(begin + number * PERIOD, *hits(ranges), ANGLES[1], np.zeros(2))
        found.append(slam.pose)
    return np.array(found), fitted


@pytest.fixture(scope="module")
def loop():
    made = drive(RING, 0.1, seed=1)
    return poses.relative(made.truth[:1], made.truth), made.scans


@pytest.mark.parametrize("changes, most", [(FINE, 0.1), ({}, 0.2)])
def test_a_loop_of_40_m_closes_without_odometry(loop, changes, most):
    """At 0.5 m/s and 0.5 rad/s, with the laser of a TurtleBot3."""
    truth, scans = loop
    found, fitted = run(ScanSlam(of(ScanSlamSettings, **changes)), scans)
    assert fitted == len(scans)
    assert np.hypot(*(found - truth)[:, :2].T).max() < most
    assert np.hypot(*(found[-1] - truth[-1])[:2]) < 0.03


def test_the_map_is_that_of_the_walls_and_stays_as_large_as_it_was_made():
    slam = ScanSlam(SETTINGS)
    run(slam, drive(RING[:2], 0.05, seed=1).scans)
    grid = slam.grid()
    assert grid.cells.shape == (800, 800) and grid.origin == (-20.0, -20.0)
    points = np.add(grid.centres_of(np.argwhere(grid.cells == OCCUPIED)), 1.0)  # its start
    world = np.floor((points - ORIGIN) / CELL).astype(int)
    off = likelihood_field.distances(walls())[world[:, 1], world[:, 0]] * CELL
    assert len(points) > 300
    assert (off <= 2 * SETTINGS.map_resolution).mean() > 0.95
    assert grid.cells[tuple(grid.cells_of((5.0, 0.0)))] == FREE
    assert grid.cells[tuple(grid.cells_of((6.0, 3.0)))] == UNKNOWN


def test_what_lies_beyond_the_map_is_left_out():
    slam = ScanSlam(of(ScanSlamSettings, map_resolution=0.1, map_size=20))
    ends = np.array([[0.5, 0.0], [5.0, 0.0]])
    slam.add(0.0, ends, ends[:, 0], 0.1, np.zeros(2))
    grid = slam.grid()
    assert grid.cells.shape == (20, 20)
    assert np.argwhere(grid.cells == OCCUPIED).tolist() == [[10, 15]]


def test_a_scan_that_fits_nowhere_leaves_the_pose(loop):
    truth, scans = loop
    slam = ScanSlam(SETTINGS)
    run(slam, scans[:50])
    before = slam.pose
    strange = np.full(360, 0.3)
    _, fitted = run(slam, [strange], 50 * PERIOD)
    assert not fitted and (slam.pose == before).all()
    found, fitted = run(slam, scans[50:60], 51 * PERIOD)
    assert fitted == 10 and np.hypot(*(found[-1] - truth[59])[:2]) < 0.05


def test_a_pose_may_be_given(loop):
    slam = ScanSlam(SETTINGS)
    run(slam, loop[1][:20])
    slam.place(np.array([0.1, 0.05, 0.2]))
    found, fitted = run(slam, loop[1][19:20], 20 * PERIOD)
    assert fitted and np.hypot(*(found[0] - loop[0][19])[:2]) > 0.0
    slam = ScanSlam(SETTINGS)
    slam.add(0.0, *hits(loop[1][0]), ANGLES[1], np.zeros(2), np.array([1.0, 2.0, 0.5]))
    assert slam.pose.tolist() == [1.0, 2.0, 0.5]


def test_the_covariance_is_large_along_a_corridor_and_small_across():
    x = np.linspace(-3, 3, 241)
    ends = np.concatenate((np.column_stack((x, np.full(241, -1.0))),
                           np.column_stack((x[::-1], np.ones(241)))))
    slam = ScanSlam(SETTINGS)
    for stamp in (0.0, 0.2):
        slam.add(stamp, ends, np.hypot(*ends.T), 0.02, np.zeros(2))
    along, across, _ = np.sqrt(np.diag(slam.covariance))
    assert along > 5 * across and across < 0.005
