"""Lesson 7's planner, loaded as move_base loads it."""

from types import SimpleNamespace

import numpy as np
import pytest
import rospy

from move_base.exported_planners import GLOBAL, exported, load
from nav_algorithms.costmap.costs import LETHAL, UNKNOWN, Costmap
from nav_nodes.messages import pose_of, stamped_pose

START, GOAL = np.array([-1.0, -1.0, 0.5]), np.array([1.0, 1.0, 1.5])


@pytest.fixture
def costmap():
    """4 m by 4 m with a wall along y = 0 that has a gap at x = 1.5 to 1.8 m."""
    cells = np.zeros((80, 80), np.uint8)
    cells[40, :70], cells[40, 76:] = LETHAL, LETHAL
    return Costmap(cells, 0.05, (-2.0, -2.0))


def plan(costmap):
    planner = load(exported(GLOBAL)["nav_demo/BreadthFirst"])()
    planner.initialize("BreadthFirst", SimpleNamespace(snapshot=lambda: costmap))
    poses = [stamped_pose(pose, "map", rospy.Time(1)) for pose in (START, GOAL)]
    return np.array([pose_of(each.pose) for each in planner.make_plan(*poses)])


def test_it_goes_through_the_gap(costmap):
    path = plan(costmap)
    assert path[0] == pytest.approx(START) and path[-1] == pytest.approx(GOAL)
    assert (costmap.cells[tuple(costmap.cells_of(path[:, :2]).T)] < 253).all()
    assert np.hypot(*np.diff(path[:, :2], axis=0).T).max() < 0.12
    in_the_wall = path[(path[:, 1] > 0.0) & (path[:, 1] < 0.05), 0]
    assert len(in_the_wall) and (np.abs(in_the_wall - 1.65) < 0.15).all()


@pytest.mark.parametrize("cost", [LETHAL, UNKNOWN])
def test_no_way_is_an_empty_plan(costmap, cost):
    costmap.cells[40] = cost
    assert len(plan(costmap)) == 0
