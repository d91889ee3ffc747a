"""What local planners are made of, each with answers worked out by hand."""

import numpy as np
import pytest
from local_plans import ORIGIN, STILL, WAFFLE, straight, window_around

from nav_algorithms.costmap.costs import LETHAL, UNKNOWN
from nav_algorithms.local_planning.following import Following, within
from nav_algorithms.local_planning.goal import Arrival, StopAndTurn
from nav_algorithms.local_planning.local_planner import Oscillation
from nav_algorithms.local_planning.pure_pursuit import cut
from nav_algorithms.local_planning.velocities import samples, slowed, turning, window


def test_the_window_of_velocities():
    low, high = window(np.array([0.2, 0, 0]), np.array([-0.3, 0, -1]), np.array([0.3, 0, 1]),
                       np.array([1.0, 0, 2.0]), 0.05)
    assert low == pytest.approx([0.15, 0, -0.1])
    assert high == pytest.approx([0.25, 0, 0.1])
    low, high = window(np.array([0.9, 0, 0]), np.array([-0.3, 0, -1]), np.array([0.3, 0, 1]),
                       np.array([1.0, 0, 2.0]), 0.05)
    assert (low[0], high[0]) == (0.3, 0.3)


def test_who_stands_can_have_the_least_velocity():
    low, high = window(STILL, np.array([-0.3, 0, -1]), np.array([0.3, 0, 1]),
                       np.array([1.0, 0, 2.0]), 0.05, np.array([0.1, 0, 0.4]))
    assert low == pytest.approx([-0.1, 0, -0.4])
    assert high == pytest.approx([0.1, 0, 0.4])
    low, _ = window(np.array([0.3, 0, 0]), np.array([-0.3, 0, -1]), np.array([0.3, 0, 1]),
                    np.array([1.0, 0, 2.0]), 0.05, np.array([0.1, 0, 0.4]))
    assert low[0] == pytest.approx(0.25)


def test_samples_have_zero_between_them():
    assert samples(-0.1, 0.2, 3) == pytest.approx([-0.1, 0.0, 0.05, 0.2])
    assert samples(-0.1, 0.2, 4) == pytest.approx([-0.1, 0.0, 0.1, 0.2])  # there already
    assert samples(0.3, 0.3, 5) == pytest.approx([0.3])
    assert slowed(np.array([0.5, 0, -1.0]), (1.0, 1.0, 2.0), 0.1) == pytest.approx([0.4, 0, -0.8])


def test_turning_slows_down_before_the_end():
    assert turning(2.0, 1.0, 0.3, 1.0, 2.0, 0.1) == pytest.approx(1.0)
    assert turning(0.05, 0.5, 0.3, 1.0, 2.0, 0.1) == pytest.approx(np.sqrt(0.2))
    assert turning(-0.001, -0.4, 0.3, 1.0, 2.0, 0.1) == pytest.approx(-0.3)
    assert turning(2.0, 0.0, 0.3, 1.0, 2.0, 0.1) == pytest.approx(0.2)


def test_oscillation_is_stopped_until_the_robot_has_moved():
    for place in (ORIGIN, np.array([5.0, -3.0, 2.0])):
        flags = Oscillation(0.1, 0.5)
        flags.took(np.array([0.2, 0, 0]), place, 0.1)
        flags.took(np.array([-0.2, 0, 0]), place, 0.1)
        both = np.array([[0.2, 0, 0], [-0.2, 0, 0]])
        assert flags.allowed(both).tolist() == [False, True]
        flags.at(place - np.array([0.05, 0, 0]))
        assert flags.allowed(both).tolist() == [False, True]
        flags.at(place - np.array([0.2, 0, 0]))
        assert flags.allowed(both).tolist() == [True, True]


def test_who_only_turns_to_and_fro_must_turn_farther_each_time():
    flags = Oscillation(0.1, 0.2)
    pose, sign, ends = ORIGIN.copy(), 1.0, []
    for _ in range(4):
        flags.took(np.array([0, 0, sign]), pose, 0.1)
        sign = -sign
        flags.took(np.array([0, 0, sign]), pose, 0.1)
        start = pose[2]
        while not flags.allowed(np.array([[0, 0, -sign]]))[0]:
            pose[2] += 0.05 * sign
            flags.at(pose)
        ends.append(abs(pose[2] - start))
    assert ends == pytest.approx([0.25, 0.45, 0.85, 1.65], abs=0.051)
    flags.at(pose + np.array([0.2, 0, 0]))
    assert flags.angle == 0.2


def test_turns_oscillate_only_where_the_robot_does_not_drive():
    flags = Oscillation(0.1, 0.5)
    for omega in (0.5, -0.5):
        flags.took(np.array([0.3, 0, omega]), ORIGIN, 0.1)
    assert flags.allowed(np.array([[0, 0, 0.5]])).all()
    for omega in (0.5, -0.5):
        flags.took(np.array([0.0, 0, omega]), ORIGIN, 0.1)
    assert not flags.allowed(np.array([[0, 0, 0.5]])).any()


def test_the_place_on_the_path_never_goes_back():
    out_and_back = np.vstack((straight(2.0), straight(2.0)[::-1]))
    following = Following(out_and_back)
    assert len(following.left(np.array([1.0, 0, 0]))) == 80 - 19
    assert len(following.left(np.array([0.5, 0, 0]))) == 80 - 19
    assert following.left(ORIGIN, np.array([1.0, 1.0, 0.0]))[-1, :2] == pytest.approx([1.0, 1.0])
    with pytest.raises(ValueError, match="path"):
        Following(np.zeros((0, 3)))


def test_the_path_is_cut_at_the_edge_and_at_the_unknown():
    costmap = window_around()
    assert within(costmap, straight(5.0, count=200))[-1, 0] == pytest.approx(1.5, abs=0.03)
    costmap.cells[:, 45:] = UNKNOWN
    assert within(costmap, straight(5.0, count=200))[-1, 0] == pytest.approx(0.75, abs=0.03)
    assert len(within(costmap, np.array([9.0, 9.0, 0.0]) + straight())) == 0


def test_a_goal_that_was_reached_may_stay_so():
    for latch in (False, True):
        end = StopAndTurn(Arrival(0.1, 0.1, latch, 0.1, 0.1, 0.4, 1.0, (1.0, 1.0, 3.0), 0.05))
        goal = np.array([1.0, 0.0, 0.0])
        assert end.reached(np.array([0.95, 0, 0]), STILL, goal)
        assert end.reached(np.array([0.8, 0, 0]), STILL, goal) == latch
        end.reset()
        assert not end.reached(np.array([0.8, 0, 0]), STILL, goal)


def test_a_blocked_turn_is_made_the_other_way_round():
    costmap = window_around()
    at_left = costmap.cells_of((-0.08, 0.215))
    costmap.cells[tuple(at_left)] = LETHAL
    end = StopAndTurn(Arrival(0.1, 0.1, False, 0.1, 0.1, 0.4, 1.0, (1.0, 1.0, 3.0), 0.05))
    goal = np.array([0.0, 0.0, -1.2])
    free = end.command(window_around(), WAFFLE, ORIGIN, STILL, goal)
    assert free.omega < 0.0
    blocked = end.command(costmap, WAFFLE, ORIGIN, STILL, goal)
    assert blocked is None or blocked.omega > 0.0


def test_a_path_is_cut_where_the_motion_changes():
    forwards, backwards = straight(1.0), straight(1.0)[::-1]
    turn = np.column_stack((np.zeros((5, 2)), np.linspace(0, 1.0, 5)))
    pieces = cut(np.vstack((forwards, backwards, turn)))
    assert [piece.direction for piece in pieces] == [1, -1, 0]
    assert [piece.lengths[-1] for piece in pieces] == pytest.approx([1.0, 1.0, 1.0])
    assert cut(np.zeros((3, 3))) == []
    steps = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.0, 0.0]])
    assert [piece.direction for piece in cut(steps)] == [1, -1]
    assert [piece.lengths.tolist() for piece in cut(steps[:2])] == [[0.0, 1.0]]
