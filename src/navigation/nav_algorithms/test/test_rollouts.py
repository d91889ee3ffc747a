"""Drives on paper over grids whose values are known, and what trajectory rollout makes of them."""

import numpy as np
import pytest
from defaults import of

from nav_algorithms.costmap.costs import LETHAL, Costmap
from nav_algorithms.local_planning import rollout
from nav_algorithms.local_planning.dwa import DwaPlanner, DwaSettings
from nav_algorithms.local_planning.following import Following
from nav_algorithms.local_planning.free_arcs import arc_of, free_arc, space
from nav_algorithms.local_planning.grids import distances_to
from nav_algorithms.local_planning.trajectory_rollout import TrajectoryRolloutSettings, _Scorer

SQUARE = np.array([[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]])
STILL = np.zeros(3)


def floor():
    """4 m x 4 m of free cells of 0.1 m about the origin."""
    return Costmap(np.zeros((40, 40), np.uint8), 0.1, (-2.0, -2.0))


def rolled(costmap, path_grid, sample, goal_range=9.0):
    """Of one drive of a second from the origin, in 10 steps."""
    grids = np.stack([path_grid, np.zeros((40, 40)), np.zeros((40, 40))])
    return rollout.rollouts(
        costmap.cells, costmap.resolution, *costmap.origin, np.full((40, 40), 99.0), 0.2, SQUARE,
        grids, np.array([1.0, 0.0, 0.0, 0.0]), np.array([sample], float), STILL, STILL,
        np.full(3, 9.0), True, 1.0, 0.1, 0.1, 0.0, goal_range, 0.0, np.inf, 0.0, 0.0)[0]


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
    blocked = floor()
    blocked.cells[:, 30] = LETHAL
    assert rolled(blocked, along, (1.0, 0.0, 0.0))[rollout.LEGAL] == 0.0


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


def test_inflated_ground_is_free_to_back_out_over():
    costmap = floor()
    costmap.cells[:] = 100
    scorer = _Scorer(of(TrajectoryRolloutSettings), costmap, SQUARE, STILL, STILL, STILL[None])
    assert scorer.first_free([[-0.1, 0.0, 0.0]]).tolist() == [-0.1, 0.0, 0.0]


def test_the_free_arc_with_the_carrot_straight_ahead_of_its_end_is_taken():
    """However far that is: what counts is how far beside its end the carrot lies."""
    costmap = floor()
    costmap.cells[18:22, 26] = LETHAL  # ahead
    end = arc_of(STILL, 1.0, 1.0, 0.1)[-1]
    carrot = end + 0.5 * np.array([np.cos(end[2]), np.sin(end[2]), 0.0])
    curvature, _ = free_arc(costmap, SQUARE / 10, STILL, 1.0, 0.0, 2.0, carrot)
    assert curvature == pytest.approx(1.0)
