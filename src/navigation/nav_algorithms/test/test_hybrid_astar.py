"""Paths for cars: within the turning radius, free, and with as many cusps as are needed."""

from bisect import bisect_left

import numpy as np
import pytest
from defaults import of

from nav_algorithms.costmap import footprint
from nav_algorithms.costmap.costs import LETHAL, UNKNOWN, Costmap
from nav_algorithms.costmap.footprint import Ground
from nav_algorithms.global_planning import hybrid_astar
from nav_algorithms.global_planning.analytic_expansion import free_way, shoot
from nav_algorithms.global_planning.hybrid_astar import HybridAstarSettings
from nav_algorithms.global_planning.motion_primitives import (
    DRIVE,
    REVERSE,
    TURN,
    TURNING,
    Vehicle,
    change_cost,
    cost_of,
)
from nav_algorithms.local_planning.pure_pursuit import cut
from nav_algorithms.poses import wrap_angle

CAR = np.array([[-0.1, -0.15], [-0.1, 0.15], [0.45, 0.15], [0.45, -0.15]])
BACK = (-6 * np.cos(0.5) - np.sin(0.9), np.cos(0.9) - 1 - 6 * np.sin(0.5), 0.9)  # see the test
WAFFLE = np.array([[-0.205, -0.155], [-0.205, 0.155], [0.077, 0.155], [0.077, -0.155]])


def plan(*arguments, **settings):
    return hybrid_astar.plan(*arguments, of(HybridAstarSettings, **settings))


def road(width=1.2):
    """A straight road along x, 10 m long, between walls."""
    costmap = Costmap(np.full((80, 200), LETHAL, np.uint8), 0.05, (0.0, -2.0))
    half = round(width / 2 / 0.05)
    costmap.cells[40 - half:40 + half, 2:-2] = 0
    return costmap


def length(path):
    return np.hypot(*np.diff(path[:, :2], axis=0).T).sum()


def check(path, costmap, start, goal, outline=CAR, radius=0.6):
    assert path[0] == pytest.approx(start)
    assert path[-1] == pytest.approx(goal)
    assert (footprint.costs(costmap, outline, path) >= 0).all()
    steps = np.hypot(*np.diff(path[:, :2], axis=0).T)
    assert steps.max() <= 0.05 + 1e-9
    driven = steps > 1e-3
    turns = np.abs(wrap_angle(np.diff(path[:, 2])))
    assert turns.max() * footprint.reach(outline) < 0.05  # no corner passes over a cell unseen
    assert (steps + turns > 1e-6).all()
    assert (turns[driven] <= 1.05 * steps[driven] / radius + 1e-6).all()


def test_straight_on_is_straight():
    start, goal = np.array([1.0, 0, 0]), np.array([9.0, 0, 0])
    path = plan(road(), start, goal, CAR)
    check(path, road(), start, goal)
    assert length(path) == pytest.approx(8.0, abs=0.05)
    assert [piece.direction for piece in cut(path)] == [1]


def test_turning_round_in_a_road_takes_three_points_or_more():
    start, goal = np.array([5.0, 0, 0]), np.array([3.0, 0, np.pi])
    path = plan(road(1.1), start, goal, CAR)
    check(path, road(1.1), start, np.array([3.0, 0, path[-1, 2]]))
    assert abs(wrap_angle(path[-1, 2] - np.pi)) < 1e-9
    assert {piece.direction for piece in cut(path)} == {1, -1}
    assert 3 <= len(cut(path)) <= 5
    assert plan(road(), start, goal, CAR, allow_reverse=False) is None


def test_backwards_where_that_is_shorter():
    start, goal = np.array([5.0, 0, 0]), np.array([4.0, 0, 0])
    assert [piece.direction for piece in cut(plan(road(), start, goal, CAR))] == [-1]


def test_a_car_that_cannot_turn_there_finds_no_way():
    goal = np.array([3.0, 0, np.pi])
    assert plan(road(0.5), np.array([5.0, 0, 0]), goal, CAR) is None


def test_a_robot_that_turns_on_the_spot():
    start, goal = np.array([5.0, 0, 0]), np.array([3.0, 0, np.pi])
    path = plan(road(), start, goal, WAFFLE, turn_in_place=True)
    check(path, road(), start, np.array([3.0, 0, path[-1, 2]]), WAFFLE)
    assert 0 in {piece.direction for piece in cut(path)}
    drives = np.hypot(*np.diff(path[:, :2], axis=0).T) > 1e-6
    assert wrap_angle(np.diff(path[:, 2]))[drives] == pytest.approx(0.0, abs=1e-6)  # no bends
    assert length(path) == pytest.approx(2.0, abs=0.1)


def test_a_robot_that_turns_on_the_spot_goes_round_a_wall_without_bends():
    costmap = road(2.4)
    costmap.cells[30:, 78:82] = LETHAL
    start, goal = np.array([5.0, 0.3, 0]), np.array([3.0, 0.3, 0])
    path = plan(costmap, start, goal, WAFFLE, turn_in_place=True)
    check(path, costmap, start, goal, WAFFLE)
    drives = np.hypot(*np.diff(path[:, :2], axis=0).T) > 1e-6
    assert wrap_angle(np.diff(path[:, 2]))[drives] == pytest.approx(0.0, abs=1e-6)


def test_the_unknown_is_crossed_if_allowed():
    costmap = road()
    costmap.cells[:, 100:110] = UNKNOWN
    start, goal = np.array([1.0, 0, 0]), np.array([9.0, 0, 0])
    assert plan(costmap, start, goal, CAR) is not None
    assert plan(costmap, start, goal, CAR, allow_unknown=False) is None
    assert plan(costmap, np.array([5.2, 0, 0]), goal, CAR) is not None
    settings = of(HybridAstarSettings)
    estimates = [hybrid_astar._estimate(one, goal, settings) for one in (costmap, road())]
    assert estimates[0][40] == pytest.approx(estimates[1][40])  # as long as if it were free


def test_round_obstacles_and_twice_the_same():
    generator = np.random.default_rng(4)
    costmap = Costmap(np.zeros((160, 160), np.uint8), 0.05, (0.0, 0.0))
    for row, column in generator.integers(20, 140, (25, 2)):
        costmap.cells[row:row + 4, column:column + 4] = LETHAL
    costmap.cells[:20] = costmap.cells[-20:] = 0
    start, goal = np.array([1.0, 0.5, 0.0]), np.array([7.0, 7.5, 3.0])
    path = plan(costmap, start, goal, CAR)
    check(path, costmap, start, goal)
    assert (plan(costmap, start, goal, CAR) == path).all()


@pytest.mark.parametrize("turned", [False, True])
def test_a_way_between_walls_that_stand_far_out_on_a_long_map(turned):
    """Two walls across the road near its far end, one open at its left and one at its right."""
    costmap = road(2.4)
    costmap.cells[:46, 140:142] = costmap.cells[34:, 170:172] = LETHAL
    start, goal = np.array([1.0, 0.0, 0.0]), np.array([9.2, 0.0, 0.0])
    if turned:
        costmap = Costmap(np.ascontiguousarray(costmap.cells.T), 0.05, (-2.0, 0.0))
        start, goal = (np.array([0.0, pose[0], np.pi / 2]) for pose in (start, goal))
    check(plan(costmap, start, goal, CAR), costmap, start, goal)


def test_outside_and_in_walls_is_none():
    start = np.array([1.0, 0, 0])
    assert plan(road(), start, np.array([20.0, 0, 0]), CAR) is None
    assert plan(road(), start, np.array([5.0, 1.0, 0]), CAR) is None
    assert plan(road(), np.array([1.0, 1.5, 0]), np.array([5.0, 0, 0]), CAR) is None


def test_a_start_that_touches_is_left():
    start, goal = np.array([1.0, 0.43, 0]), np.array([9.0, 0, 0])
    costmap = road(1.1)
    assert footprint.costs(costmap, CAR, start)[0] < 0
    path = plan(costmap, start, goal, CAR)
    assert path is not None
    assert (footprint.costs(costmap, CAR, path[-40:]) >= 0).all()


@pytest.mark.parametrize("wall, looked_at", [(80, [(81, 161)]), (130, [(81, 161), (161, 201)])])
def test_on_a_large_map_a_near_goal_is_sought_near_by_first(monkeypatch, wall, looked_at):
    """Where the only way round a wall leads farther, it is found all the same."""
    costmap = Costmap(np.zeros((161, 201), np.uint8), 0.05, (-5.0, -4.0))
    costmap.cells[:wall, 98:102] = LETHAL
    sizes, estimate = [], hybrid_astar._estimate
    monkeypatch.setattr(hybrid_astar, "_estimate", lambda part, *others: sizes.append(
        part.cells.shape) or estimate(part, *others))
    for name, value in (("LARGE", 10_000), ("AROUND", 2.0)):
        monkeypatch.setattr(hybrid_astar, name, value)
    start, goal = np.array([-2.0, 0.0, 0.0]), np.array([2.0, 0.0, 0.0])
    path = plan(costmap, start, goal, CAR)
    check(path, costmap, start, goal)
    assert sizes == looked_at


def test_without_steps_to_improve_it_the_first_path_counts():
    generator = np.random.default_rng(1)
    costmap = Costmap(np.zeros((120, 120), np.uint8), 0.05, (0.0, 0.0))
    for row, column in generator.integers(20, 100, (25, 2)):
        costmap.cells[row:row + 4, column:column + 4] = LETHAL
    start, goal = np.array([1.0, 0.5, 0.0]), np.array([5.0, 5.3, 3.0])
    fewest = 1 + bisect_left(range(1, 10_000), True, key=lambda steps: plan(
        costmap, start, goal, CAR, max_expansions=steps) is not None)
    first = plan(costmap, start, goal, CAR, max_expansions=fewest)
    assert (plan(costmap, start, goal, CAR, improve_expansions=0) == first).all()
    assert length(plan(costmap, start, goal, CAR)) < length(first)


def test_the_number_of_steps_is_bounded():
    assert plan(road(), np.array([5.0, 0, 0]), np.array([3.0, 0, np.pi]), CAR,
                max_expansions=10) is None


def test_the_cost_of_free_ground_is_its_length_by_what_each_drive_weighs():
    terms = np.ones(6)
    terms[REVERSE], terms[TURNING] = 2.0, 0.5

    def to(*goal, radius=1.0, reverse=True, turns=False):
        goal = np.array([*goal, 9.0])[:3]  # what lies behind is not read
        return free_way(Vehicle(radius, reverse, turns, True, terms), np.zeros(3), goal)

    assert to(5.0, 0.0, 0.0) == pytest.approx(5.0)
    assert to(-5.0, 0.0, 0.0) == pytest.approx(10.0)
    assert to(0.0, 4.0, np.pi, radius=2.0, reverse=False) == pytest.approx(2 * np.pi)
    assert to(0.0, 0.0, 1.0, turns=True) == pytest.approx(0.5)


@pytest.mark.parametrize("goal, radius, reverse, turns, cost", [
    ((5.0, 0.0, 0.0), 1.0, True, False, 5.0), ((-5.0, 0.0, 0.0), 1.0, True, False, 2 * 5.0 + 4.0),
    ((0.0, 4.0, np.pi), 2.0, False, False, 2 * np.pi * (1 + 0.5 * 5.0) + 0.5 * 6.0),
    (BACK, 1.0, True, False, 2 * (6.0 + (0.5 + 0.4) * (1 + 5.0)) + 4.0 + 3 * 6.0),
    ((0.0, 0.0, 1.0), 1.0, True, True, 7.0),
    ((0.0, 2.0, np.pi / 2), 1.0, True, True, 2 + 3.5 * np.pi)])
def test_the_last_stretch_on_free_ground_costs_what_its_cheapest_drive_does(goal, radius, reverse,
                                                                            turns, cost):
    """After a piece straight ahead: a cusp costs 4, and 6 for each 1/m that the wheel turns.

    BACK is 0.5 m back to the right, 6 m straight back, and 0.4 m back to the right.
    """
    terms = np.array([3.0, 2.0, 4.0, 5.0, 6.0, 7.0])  # as in `motion_primitives`
    cells, found = np.zeros((400, 400), np.uint8), np.empty((5, 3))
    ground = Ground(cells, 0.05, -10.0, -10.0, np.full((400, 400), 99.0), 0.2, WAFFLE)
    vehicle = Vehicle(radius, reverse, turns, True, terms)
    for limit, expected in ((99.0, cost), (cost - 0.1, np.inf)):
        assert shoot(ground, vehicle, np.zeros(3), np.array(goal), DRIVE, 1.0, 0.0, limit,
                     found) == pytest.approx(expected)


def test_cusps_and_the_wheel_cost_between_drives_alone():
    terms = np.array([3.0, 2.0, 4.0, 5.0, 6.0, 7.0])
    for before, after, cost in (
            ((DRIVE, 1.0, 0.5), (DRIVE, 1.0, -0.5), 6.0),
            ((DRIVE, 1.0, 0.5), (DRIVE, -1.0, 0.5), 4.0),
            ((DRIVE, 1.0, 0.0), (TURN, 1.0, 0.0), 0.0),
            ((TURN, -1.0, 0.0), (DRIVE, 1.0, 0.0), 0.0),
            ((DRIVE, 0.0, 0.0), (DRIVE, 1.0, 0.5), 0.0)):
        assert change_cost(terms, *before, *after) == cost


@pytest.mark.parametrize("kind, amount, curvature, cost", [
    (DRIVE, 0.5, 0.0, 0.5), (DRIVE, -0.5, 0.0, 0.5 * 2), (DRIVE, 0.5, -0.4, 0.5 * (1 + 5 * 0.4)),
    (TURN, -1.0, 0.0, 7.0)])
@pytest.mark.parametrize("cell, factor", [(0, 1.0), (126, 1 + 3 * 0.5)])
def test_the_cost_of_a_piece_is_its_length_by_what_it_weighs(kind, amount, curvature, cost, cell,
                                                             factor):
    terms = np.array([3.0, 2.0, 4.0, 5.0, 6.0, 7.0])  # cells count by 252
    cells, radii = np.full((99, 40), cell, np.uint8)[:60], np.full((99, 40), 99.0)[:60]

    ground = Ground(cells, 0.05, -1.0, -1.5, radii, 0.2, WAFFLE)
    vehicle = Vehicle(1.0, True, True, True, terms)

    def of_piece(x, y):
        return cost_of(ground, vehicle, np.array([x, y, np.pi / 2]), kind, amount, curvature,
                       np.empty(3))

    assert of_piece(0.0, 0.0) == pytest.approx(cost * factor)
    for x, y in ((-1.1, 0.0), (1.1, 0.0), (0.0, -2.1), (0.0, 2.1)):
        assert of_piece(x, y) == np.inf  # outside
