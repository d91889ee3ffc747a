"""Paths of navfn, global_planner and carrot_planner, with lengths worked out by hand."""

import time

import numpy as np
import pytest
from defaults import of

from nav_algorithms.costmap.costs import INSCRIBED, LETHAL, UNKNOWN, Costmap
from nav_algorithms.global_planning import astar, carrot, navfn
from nav_algorithms.global_planning.orientation import directions, orient
from nav_algorithms.global_planning.potential import (
    crossing_costs,
    spread,
    spread_everywhere,
    way_out,
)
from nav_algorithms.poses import wrap_angle

START, GOAL = np.array([-4.0, -3.0, 0.3]), np.array([4.0, 3.0, 1.0])
CARROT = carrot.CarrotSettings(step_size=0.0, min_dist_from_robot=0.1)
OUTLINE = np.array([[-0.1, -0.1], [-0.1, 0.1], [0.1, 0.1], [0.1, -0.1]])


def empty():
    return Costmap(np.zeros((200, 240), np.uint8), 0.05, (-6.0, -5.0))


def floor():
    """4 m x 4 m, free."""
    return Costmap(np.zeros((40, 40), np.uint8), 0.1, (0.0, 0.0))


def walled(gap=None):
    """A wall at x = 0 from edge to edge, with a gap 0.5 m wide around y = `gap`."""
    costmap = empty()
    costmap.cells[:, 119:122] = LETHAL
    if gap is not None:
        row = int(costmap.cells_of((0.0, gap))[0])
        costmap.cells[row - 5:row + 5, 119:122] = 0
    return costmap


def length(path):
    return np.hypot(*np.diff(path[:, :2], axis=0).T).sum()


def navfn_plan(*arguments, tolerance=None, **settings):
    return navfn.plan(*arguments, tolerance, settings=of(navfn.NavfnSettings, **settings))


def astar_plan(*arguments, **settings):
    return astar.plan(*arguments, settings=of(astar.GlobalPlannerSettings, **settings))


PLANNERS = [
    navfn_plan, astar_plan,
    lambda *arguments: astar_plan(*arguments, use_dijkstra=False),
    lambda *arguments: astar_plan(*arguments, use_dijkstra=False, use_quadratic=False),
    lambda *arguments: astar_plan(*arguments, old_navfn_behavior=True)]


@pytest.mark.parametrize("plan", PLANNERS)
def test_paths_begin_and_end_where_asked_and_lead_through_the_gap(plan):
    costmap = walled(gap=2.0)
    path = plan(costmap, START, GOAL)
    assert path[0] == pytest.approx(START)
    assert path[-1] == pytest.approx(GOAL)
    assert (costmap.cells[tuple(costmap.cells_of(path[:, :2]).T)] < INSCRIBED).all()
    crossing = path[np.abs(path[:, 0]).argmin()]
    assert crossing[1] == pytest.approx(2.0, abs=0.26)
    assert np.hypot(*np.diff(path[:, :2], axis=0).T).max() < 0.1


@pytest.mark.parametrize("plan", PLANNERS)
def test_no_way_is_none(plan):
    assert plan(walled(), START, GOAL) is None
    assert plan(empty(), np.array([-7.0, 0.0, 0.0]), GOAL) is None
    assert plan(empty(), np.array([7.0, 0.0, 0.0]), GOAL) is None
    assert plan(empty(), START, np.array([7.0, 0.0, 0.0])) is None


def test_a_free_path_is_straight():
    for x, y in ((4, 3), (-4, 3), (4, -3), (-4, -3)):
        way, middle = np.array([x, y, 0.0]), np.array([0.025, 0.025, 0.0])  # of a cell
        path = navfn_plan(empty(), middle - way, middle + way)
        assert length(path) == pytest.approx(10.0, rel=0.0003)
    streets = astar_plan(empty(), START, GOAL, use_grid_path=True, use_quadratic=False)
    assert 10.0 < length(streets) < 11.5


def test_the_potential_is_the_distance():
    middle = np.ones((101, 101)), np.array([[50, 50]]), np.zeros(1)
    potential = spread_everywhere(*middle)
    rows, columns = np.mgrid[-50:51, -50:51]
    distance = np.hypot(rows, columns)
    assert np.abs(potential - distance).max() < 1.5
    streets = spread(*middle, -1, -1, False, 0.0, 0.0)
    assert streets == pytest.approx(np.abs(rows) + np.abs(columns))


def test_dear_cells_are_gone_round():
    costmap = empty()
    costmap.cells[80:120, 60:180] = 200
    assert length(navfn_plan(costmap, np.array([-4.0, 0, 0]), np.array([4.0, 0, 0]))) > 8.3
    costmap.cells[80:120, 60:180] = 1
    assert length(navfn_plan(costmap, np.array([-4.0, 0, 0]), np.array([4.0, 0, 0]))) < 8.05


def test_the_unknown_is_crossed_if_allowed():
    costmap = empty()
    costmap.cells[:, 110:130] = UNKNOWN
    assert navfn_plan(costmap, START, GOAL) is not None
    assert navfn_plan(costmap, START, GOAL, allow_unknown=False) is None
    assert astar_plan(costmap, START, GOAL) is not None
    assert astar_plan(costmap, START, GOAL, allow_unknown=False) is None


def test_a_goal_in_a_wall_is_moved_within_the_tolerance():
    costmap = empty()
    costmap.cells[150:170, 190:210] = LETHAL
    goal = np.array([4.0, 3.0, 1.0])
    assert navfn_plan(costmap, START, goal) is None
    path = navfn_plan(costmap, START, goal, tolerance=0.8)
    assert 0.45 < np.hypot(*(path[-1, :2] - goal[:2])) < 0.8
    assert path[-1, 2] == 1.0
    assert navfn_plan(costmap, START, goal, tolerance=0.3) is None
    assert navfn_plan(costmap, START, goal,
                      default_tolerance=0.8) is not None


def test_a_start_too_near_to_a_wall_is_left():
    costmap = empty()
    costmap.cells[60:, 30:60] = INSCRIBED
    costmap.cells[60:, 44:46] = LETHAL
    path = navfn_plan(costmap, np.array([-3.6, 0.0, 0.0]), GOAL)
    assert path is not None
    assert (costmap.cells[tuple(costmap.cells_of(path[:, :2]).T)] != LETHAL).all()


def test_lethal_cost_and_costs_are_honoured():
    costmap = walled(gap=0.0)
    costmap.cells[95:105, 119:122] = 150
    assert astar_plan(costmap, START, GOAL, lethal_cost=150) is None
    assert astar_plan(costmap, START, GOAL, lethal_cost=253) is not None
    near, far = (length(astar_plan(_dear(), np.array([-4.0, 0, 0]), np.array([4.0, 0, 0]),
                                   cost_factor=factor)) for factor in (0.1, 3.0))
    assert near < 8.05 < far
    cheap = length(astar_plan(_dear(), np.array([-4.0, 0, 0]), np.array([4.0, 0, 0]),
                              neutral_cost=5000.0, lethal_cost=253))
    assert cheap < 8.05


def _dear():
    costmap = empty()
    costmap.cells[80:120, 60:180] = 60
    return costmap


@pytest.mark.parametrize("mode, yaw", [(0, 0.0), (1, np.pi / 2), (4, -np.pi / 2), (5, np.pi),
                                       (6, 0.0)])
def test_orientation_modes_along_a_straight_path(mode, yaw):
    path = np.column_stack((np.zeros(9), np.arange(9.0), np.zeros(9)))
    path[-1, 2] = 1.0
    found = orient(path, mode)
    assert np.cos(found[1:-1, 2] - yaw) == pytest.approx(np.ones(7))
    assert found[0, 2] == 0.0
    assert found[-1, 2] == 1.0


def test_orientations_that_interpolate():
    path = np.column_stack((np.arange(9.0), np.zeros(9), np.zeros(9)))
    path[-1, 2] = 0.8
    assert orient(path, 2)[:, 2] == pytest.approx(np.arange(9) * 0.1)
    assert orient(path, 3)[-1, 2] == 0.8
    with pytest.raises(ValueError, match="0 to 6"):
        orient(path, 7)
    assert astar_plan(empty(), START, GOAL, orientation_mode=4)[5, 2] == pytest.approx(
        np.arctan2(-3, -4), abs=0.1)


def test_a_path_is_followed_up_to_its_last_bend_away_from_the_goal_s_yaw():
    bends = np.repeat([0.0, -0.5, -1.0], 5)  # rad, of each step: two to the right, then a left turn
    steps = np.column_stack((np.cos(bends), np.sin(bends), np.zeros(15)))
    path = np.vstack((np.zeros(3), np.cumsum(steps, axis=0)))
    path[-1, 2] = -0.5
    found = orient(path, 3)[:, 2]
    assert found[[2, 7]] == pytest.approx([0.0, -0.5])
    assert found[11:] == pytest.approx(np.linspace(-1.0, -0.5, 5), abs=0.01)
    assert directions(path[:1, :2], 1).tolist() == [0.0]
    assert directions(path[[0, 1], :2], 1) == pytest.approx([0.0, 0.0])
    assert directions(np.array([[0.0, 0.0], [0.0, 1.0]]), 1) == pytest.approx([np.pi / 2] * 2)


@pytest.mark.parametrize("end, yaw", [((5, 9), np.pi / 2), ((5, 1), -np.pi / 2), ((1, 5), np.pi),
                                      ((9, 5), 0.0)])
def test_a_corridor_one_cell_wide_is_followed_either_way(end, yaw):
    costmap = Costmap(np.full((11, 11), LETHAL, np.uint8), 1.0, (0.0, 0.0))
    costmap.cells[5, :] = costmap.cells[:, 5] = 0
    goal = np.array([end[0] + 0.5, end[1] + 0.5, yaw])
    path = navfn_plan(costmap, np.array([5.5, 5.5, 0.0]), goal)
    assert length(path) == pytest.approx(4.0)
    assert wrap_angle(path[1:, 2] - yaw) == pytest.approx(np.zeros(len(path) - 1), abs=1e-6)


@pytest.mark.parametrize("turned", [slice(None), slice(None, None, -1)])
def test_the_way_out_of_a_wall_is_the_nearest_over_what_is_not_solid(turned):
    cells = np.full((3, 6), LETHAL, np.uint8)
    cells[1, 1:5] = [0, INSCRIBED, UNKNOWN, INSCRIBED]
    cells = np.ascontiguousarray(cells[turned, turned])
    columns = np.arange(6)[turned]
    found = way_out(cells, 1, int(columns[4]))
    assert found.tolist() == [[1, columns[column]] for column in (4, 3, 2, 1)]
    assert way_out(cells.T.copy(), int(columns[4]), 1).tolist() == found[:, ::-1].tolist()
    cells[1, columns[1]] = LETHAL
    assert len(way_out(cells, 1, int(columns[4]))) == 0


def test_navfn_s_costs_are_those_of_upstream():
    # COST_NEUTRAL 50 and COST_FACTOR 0.8 of navfn.h: a cell of cost 100 counts 130
    cells = np.zeros((3, 4), np.uint8)
    cells[1, 2] = 100
    costs = crossing_costs(cells, navfn.NEUTRAL, navfn.FACTOR, INSCRIBED, np.inf)
    assert costs[1, 1:3] == pytest.approx([50.0, 130.0])
    costs[1, 1:3] = np.inf
    assert (costs == np.inf).all()  # no way along the edge of the map


def test_navfn_is_dijkstra_s_and_takes_no_heuristic(monkeypatch):
    asked = []
    monkeypatch.setattr(navfn, "spread", lambda *words: asked.append(words) or spread(*words))
    assert navfn_plan(empty(), START, GOAL) is not None
    assert asked[0][5:7] == (True, 0.0)  # quadratic, and no heuristic


def test_the_window_of_orientations_smooths():
    path = np.column_stack((np.arange(20.0), np.arange(20) % 2, np.zeros(20)))
    rough, smooth = orient(path, 1, 1), orient(path, 1, 5)
    assert np.abs(smooth[6:-6, 2]).max() <= np.abs(rough[6:-6, 2]).max()


def test_a_large_map_takes_less_than_50_ms():
    costmap = Costmap(np.zeros((400, 400), np.uint8), 0.05, (0.0, 0.0))
    times = []
    for _ in range(3):
        begin = time.process_time()
        navfn_plan(costmap, np.array([1.0, 1.0, 0]), np.array([19.0, 19.0, 0]))
        times.append(time.process_time() - begin)
    assert min(times) < 0.05


def test_carrot_goes_to_the_goal_or_what_is_free_before_it_or_nowhere():
    costmap = floor()
    start, goal = np.array([1.0, 2.0, 0.0]), np.array([3.0, 2.0, 1.0])
    assert carrot.plan(costmap, start, goal, OUTLINE, CARROT)[-1] == pytest.approx(goal)
    costmap.cells[:, 25:] = LETHAL
    end = carrot.plan(costmap, start, goal, OUTLINE, CARROT)[-1]
    assert end[0] == pytest.approx(2.4, abs=0.11) and end[1] == 2.0
    assert 0.0 < end[2] < 1.0
    costmap.cells[:] = LETHAL
    assert carrot.plan(costmap, start, goal, OUTLINE, CARROT) is None


def test_a_carrot_may_be_however_far_away_and_the_path_ends_at_the_costmap_s_edge():
    costmap = floor()
    for far in (50.0, 1e9, 1e300):
        end = carrot.plan(costmap, np.array([1.0, 2.0, 0.0]), np.array([far, 2.0, 0.0]), OUTLINE,
                          CARROT)[1]
        assert end[0] == pytest.approx(3.9, abs=0.11) and end[1] == 2.0
