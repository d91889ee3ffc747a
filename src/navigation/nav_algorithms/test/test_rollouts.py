"""Drives on paper over grids whose values are known, and what trajectory rollout makes of them."""

import numpy as np
import pytest
from defaults import of

from nav_algorithms.costmap.costs import LETHAL, Costmap
from nav_algorithms.costmap.footprint import Ground
from nav_algorithms.local_planning import rollout
from nav_algorithms.local_planning.dwa import DwaPlanner, DwaSettings
from nav_algorithms.local_planning.following import Following
from nav_algorithms.local_planning.free_arcs import arc_of, free_arc, space
from nav_algorithms.local_planning.local_planner import distances_to
from nav_algorithms.local_planning.trajectory_rollout import (
    NO_GROWTH,
    TrajectoryRolloutSettings,
    _Scorer,
)

SQUARE = np.array([[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]])
STILL = np.zeros(3)


def floor():
    """4 m x 4 m of free cells of 0.1 m about the origin."""
    return Costmap(np.zeros((40, 40), np.uint8), 0.1, (-2.0, -2.0))


def rolled(costmap, path_grid, sample, goal_range=9.0, outline=SQUARE,
           forward=0.0):
    """Of one drive of a second from the origin, in 10 steps."""
    grids = np.stack([path_grid, np.zeros((40, 40)), np.zeros((40, 40))])
    ground = Ground(costmap.cells, costmap.resolution, *costmap.origin, np.full((40, 40), 99.0),
                    0.2, outline)
    motion = rollout.Motion(np.full(3, 9.0), True, 1.0, 0.1, 0.1, 0.0)
    scoring = rollout.Scoring(grids, np.array([1.0, 0.0, 0.0, 0.0]), forward, goal_range)
    return rollout.rollouts(ground, motion, scoring, NO_GROWTH, np.array([sample], float), STILL,
                            STILL)[0]


def test_beside_what_cannot_be_reached_a_cell_s_own_value_counts():
    alone = np.full((40, 40), np.inf)
    alone[24, 30] = 7.0  # about (1.05, 0.45)
    found = rolled(floor(), alone, (1.05, 0.45, 0.0))
    assert found[rollout.LEGAL] == 1.0
    assert found[rollout.PATH] == 7.0 - rollout.ON_PATH


def test_a_drive_is_legal_or_not_and_ends_at_the_goal_where_that_is_on_the_way():
    along = np.tile(np.arange(40) - 19.5, (40, 1))  # cells ahead of the origin
    assert rolled(floor(), along, (1.0, 0.0, 0.0))[rollout.PATH] == pytest.approx(9.5)
    for goal_range, cells in ((0.25, 3.0), (0.0, 1.0)):  # one step at least
        found = rolled(floor(), along, (1.0, 0.0, 0.0), goal_range)
        assert found[rollout.LEGAL] == 1.0
        assert found[rollout.PATH] == pytest.approx(cells - rollout.ON_PATH)
    ahead = rolled(floor(), along, (0.5, 0.0, 0.0), forward=0.3)
    assert ahead[[rollout.PATH, rollout.ALIGNMENT]] == pytest.approx(
        np.array([5.0, 8.0]) - rollout.ON_PATH)
    blocked = floor()
    blocked.cells[:, 30] = LETHAL
    assert rolled(blocked, along, (1.0, 0.0, 0.0))[rollout.LEGAL] == 0.0


@pytest.mark.parametrize("sample", [(-1.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0),
                                    (0.0, 1.0, 0.0)])
def test_between_the_outermost_cells_values_are_in_between(sample):
    """Off the grid's edge by 1.2 cells a drive ends 0.7 cells from the outermost centres."""
    cells = np.arange(40.0)
    along = np.tile(cells, (40, 1)) if sample[0] else np.tile(cells[:, None], (1, 40))
    way = sum(sample)
    low = np.where(np.array(sample[:2]) == 0.0, -2.0, -1.12 if way < 0.0 else 1.12 - 4.0)
    costmap = Costmap(floor().cells, 0.1, tuple(low.tolist()))
    found = rolled(costmap, along, sample)
    assert found[rollout.LEGAL] == 1.0
    assert found[rollout.PATH] == pytest.approx((0.7 if way < 0.0 else 38.3) - rollout.ON_PATH)


@pytest.mark.parametrize("angle, legal", [(0.5, 1.0), (0.03, 0.0)])
def test_a_turn_must_be_free_only_as_long_as_it_takes_to_stop(angle, legal):
    """From 1 rad/s by 9 rad/s^2 that is a ninth of a second, or as many rad."""
    costmap, corner = floor(), np.arctan2(0.05, 1.0)
    row, column = costmap.cells_of((np.cos(angle + corner), np.sin(angle + corner)))
    costmap.cells[row, column] = LETHAL
    bar = np.array([[1.0, 0.05], [-0.1, 0.05], [-0.1, -0.05], [1.0, -0.05]])
    found = rolled(costmap, np.zeros((40, 40)), (0.0, 0.0, 1.0), outline=bar)
    assert found[rollout.LEGAL] == legal


def test_ways_over_free_cells_are_as_the_crow_flies():
    place = np.array([[-1.95, -1.95]])
    away = distances_to(floor(), place, place)
    assert away[30, 30] == pytest.approx(np.hypot(30, 30), rel=0.03)
    assert away[0, 30] == pytest.approx(30.0)
    beside = distances_to(floor(), place + 20 * 0.1 - 0.03, place)[19:22, 19:22]
    rows, columns = np.indices((3, 3)) - 1
    assert beside == pytest.approx(np.hypot(rows + 0.3, columns + 0.3))


@pytest.mark.parametrize("path", [np.zeros(3), np.zeros((2, 2)), np.zeros((0, 3))])
def test_what_is_no_path_is_refused(path):
    with pytest.raises(ValueError, match="path"):
        Following(path)


def test_the_room_of_a_robot_is_from_its_corners_and_the_middles_of_its_sides():
    costmap = floor()
    costmap.cells[20, 32] = LETHAL
    wide = np.array([[0.65, 0.95], [-0.65, 0.95], [-0.65, -0.95], [0.65, -0.95]])
    assert space(costmap, wide, np.array([0.0, 0.05, 0.0])) == pytest.approx(0.6)
    for ahead in (0.4, -0.4):  # wherever on the robot its frame is
        place = np.array([-ahead, 0.05, 0.0])
        assert space(costmap, wide + np.array([ahead, 0.0]), place) == pytest.approx(0.6)
    assert space(costmap, SQUARE, np.array([9.0, 0.0, 0.0])) == 0.0
    assert space(costmap, SQUARE[:2], STILL) == np.inf


@pytest.mark.parametrize("limit, speed", [(0.3, 0.3), (0.0, 0.0), (-1.0, np.inf)])
def test_below_0_the_speed_of_dwa_has_no_limit(limit, speed):
    assert DwaPlanner(of(DwaSettings, max_vel_trans=limit)).limits().speed == speed


@pytest.mark.parametrize("hidden, seen", [(False, (1.65, 1.05)), (True, (1.65, 0.05))])
def test_headings_are_to_the_farthest_point_in_sight(hidden, seen):
    """The path goes ahead and then to the left; a wall may hide where it ends."""
    costmap = floor()
    if hidden:
        costmap.cells[21:33, 26:36] = LETHAL
    path = np.array([(x, 0.05, 0) for x in np.arange(0.45, 1.7, 0.1)]
                    + [(1.65, y, 0) for y in np.arange(0.15, 1.1, 0.1)])
    pose = np.array([0.25, -0.15, 0.3])
    bearing = np.arctan2(seen[1] - pose[1], seen[0] - pose[0])
    costs = [_Scorer(of(TrajectoryRolloutSettings, heading_scoring=scoring), costmap, SQUARE, pose,
                     STILL, path).costs(np.zeros((1, 3)))[1] for scoring in (False, True)]
    assert costs[1] - costs[0] == pytest.approx(0.3 * abs(bearing - 0.3))  # upstream's 0.3


def test_headings_are_those_after_the_drive_on_its_arc():
    """1 rad/s for 0.8 s from 0.3 rad: a chord along 0.7 rad, and 1.1 rad at its end."""
    pose = np.array([0.05, 0.05, 0.3])
    end = pose[:2] + 0.4 * np.array([np.cos(0.7), np.sin(0.7)])
    path = np.array([[*(end + way * np.array([np.cos(1.1), np.sin(1.1)])), 1.1]
                     for way in (0.2, 0.7)])
    for speed, off in ((0.5, 0.0), (0.0, 1.1 - np.arctan2(*(path[-1, :2] - pose[:2])[::-1]))):
        costs = [_Scorer(of(TrajectoryRolloutSettings, heading_scoring=scoring,
                            heading_scoring_timestep=0.8), floor(), SQUARE, pose, STILL, path
                         ).costs(np.array([[speed, 0.0, 1.0]]))[1] for scoring in (False, True)]
        assert costs[1] - costs[0] == pytest.approx(0.3 * abs(off))


def test_the_goal_is_the_path_s_last_point_alone():
    path = np.array([[0.05, 0.05, 0.0], [1.05, 0.05, 0.0]])
    settings = of(TrajectoryRolloutSettings, pdist_scale=0.6, gdist_scale=0.8, occdist_scale=0.0)
    scorer = _Scorer(settings, floor(), SQUARE, path[0], STILL, path)
    assert scorer.costs(np.zeros((1, 3)))[1] == pytest.approx(0.8 * 10)  # cells


def test_inflated_ground_is_free_to_back_out_over():
    costmap = floor()
    costmap.cells[:] = 100
    scorer = _Scorer(of(TrajectoryRolloutSettings), costmap, SQUARE, STILL, STILL, STILL[None])
    assert scorer.first_free([[-0.1, 0.0, 0.0]]).tolist() == [-0.1, 0.0, 0.0]


def test_an_arc_s_poses_are_evenly_apart_and_no_more_than_a_step():
    for length in (1.0, -1.0):
        assert arc_of(STILL, length, 0.0, 0.3) == pytest.approx(
            np.linspace(STILL, (length, 0.0, 0.0), 5))


def test_the_free_arc_with_the_carrot_straight_ahead_of_its_end_is_taken():
    """However far that is: what counts is how far beside its end the carrot lies."""
    costmap = floor()
    costmap.cells[18:22, 26] = LETHAL  # ahead
    end = arc_of(STILL, 1.0, 1.0, 0.1)[-1]
    carrot = end + 0.5 * np.array([np.cos(end[2]), np.sin(end[2]), 0.0])
    curvature, _ = free_arc(costmap, SQUARE / 10, STILL, 1.0, 0.0, 2.0, carrot)
    assert curvature == pytest.approx(1.0)
