"""Trajectories: splines, joining, tolerances and the outcome of goals, against known answers."""

import math

import pytest

from bullet_sim.control.handles import CommandHandle, JointHandle
from bullet_sim.control.pid import Pid, PidGains
from bullet_sim.control.trajectory.follower import (
    PidDrive,
    PositionDrive,
    TrajectoryFollower,
    Verdict,
)
from bullet_sim.control.trajectory.path import Path, Segment, Waypoint, stopping
from bullet_sim.control.trajectory.request import (
    GoalTolerances,
    InvalidJoints,
    InvalidTrajectory,
    RequestedPoint,
    Tolerance,
    TrajectoryRequest,
    check,
    chosen,
    join,
)

STEP = 0.001  # s


# --- splines

def test_positions_alone_make_a_line():
    segment = Segment(1.0, Waypoint(2.0), 3.0, Waypoint(6.0))
    assert segment.sample(2.0) == (4.0, 2.0, 0.0)
    assert segment.sample(3.0) == (6.0, 2.0, 0.0)


def test_velocities_make_a_cubic():
    segment = Segment(0.0, Waypoint(0.0, 0.0), 2.0, Waypoint(1.0, 0.0))
    assert segment.sample(1.0) == pytest.approx((0.5, 0.75, 0.0))  # 3/4 t^2 - t^3/4
    assert segment.sample(0.5).acceleration == pytest.approx(0.75)
    assert segment.sample(2.0)[:2] == pytest.approx((1.0, 0.0))


def test_accelerations_make_a_quintic():
    segment = Segment(0.0, Waypoint(0.0, 0.0, 0.0), 1.0, Waypoint(1.0, 0.0, 0.0))
    for t in (0.25, 0.5, 0.9):  # minimum jerk: 10 t^3 - 15 t^4 + 6 t^5
        assert segment.sample(t) == pytest.approx((
            10 * t**3 - 15 * t**4 + 6 * t**5, 30 * t**2 * (1 - t)**2,
            60 * t - 180 * t**2 + 120 * t**3))


def test_a_quintic_meets_all_six_conditions():
    start, end = Waypoint(0.3, -1.0, 2.0), Waypoint(-0.8, 0.4, -3.0)
    segment = Segment(5.0, start, 6.5, end)
    assert segment.sample(5.0) == pytest.approx(start)
    assert segment.sample(6.5) == pytest.approx(end)


def test_a_cubic_meets_all_four_conditions():
    segment = Segment(5.0, Waypoint(0.3, -1.0), 6.5, Waypoint(-0.8, 0.4))
    assert segment.sample(5.0)[:2] == pytest.approx((0.3, -1.0))
    assert segment.sample(6.5)[:2] == pytest.approx((-0.8, 0.4))


def test_an_end_without_velocity_makes_a_line_even_from_a_moving_joint():
    segment = Segment(0.0, Waypoint(0.0, 5.0, 1.0), 1.0, Waypoint(2.0))
    assert segment.sample(0.5) == (1.0, 2.0, 0.0)


def test_outside_of_its_time_a_segment_stands_at_the_nearer_end():
    segment = Segment(1.0, Waypoint(2.0, 3.0), 2.0, Waypoint(4.0, 3.0))
    assert segment.sample(0.5) == (2.0, 0.0, 0.0)
    assert segment.sample(2.5) == (4.0, 0.0, 0.0)


def test_no_time_means_at_once():
    segment = Segment(1.0, Waypoint(2.0, 0.0, 0.0), 1.0, Waypoint(4.0, 1.0, 0.0))
    assert segment.sample(1.0) == (4.0, 0.0, 0.0)


def test_stopping_brakes_evenly_and_then_stands():
    path = stopping(1.0, 0.0, 2.0, 0.5)
    assert path.sample(1.0)[:2] == pytest.approx((0.0, 2.0))
    assert path.sample(9.0) == (0.5, 0.0, 0.0)
    assert stopping(1.0, 0.7, 2.0, 0.0).sample(1.0) == (0.7, 0.0, 0.0)


# --- requests

JOINTS = ["one", "two"]


def request(*points, joints=JOINTS, start=None) -> TrajectoryRequest:
    return TrajectoryRequest(joints, [RequestedPoint(*point) for point in points], start)


def standing(*positions: float) -> list[Path]:
    return [stopping(0.0, position, 0.0, 0.0) for position in positions]


@pytest.mark.parametrize("joints", [["one"], ["one", "three"], ["one", "two", "two"], [],
                                    ["one", "two", "three"]])
def test_wrong_joints_are_told_with_the_right_ones(joints):
    point = (1.0, [0.0] * len(joints))
    with pytest.raises(InvalidJoints, match="this controller has one, two"):
        check(request(point, joints=joints), JOINTS, partial=False)


def test_some_of_the_joints_are_enough_where_that_is_allowed():
    check(request((1.0, [0.0]), joints=["two"]), JOINTS, partial=True)


@pytest.mark.parametrize("points, text", [
    ([(1.0, [0.0, 0.0]), (1.0, [0.0, 0.0])], "strictly increasing.*point 2"),
    ([(1.0, [0.0])], "point 1 has 1 positions for 2 joints"),
    ([(1.0, [])], "point 1 has 0 positions"),
    ([(1.0, [0.0, 0.0], [1.0])], "point 1 has 1 velocities"),
    ([(1.0, [0.0, math.nan])], "point 1 has positions that are not finite numbers"),
])
def test_impossible_points_are_told(points, text):
    with pytest.raises(InvalidTrajectory, match=text):
        check(request(*points), JOINTS, partial=False)


def test_joints_may_come_in_another_order():
    paths = join(request((1.0, [5.0, 6.0]), joints=["two", "one"]), JOINTS, [False] * 2,
                 standing(0.0, 0.0), 0.0)
    assert [path.sample(1.0).position for path in paths] == [6.0, 5.0]


def test_the_present_trajectory_goes_on_until_the_new_one_begins():
    present = [Path([Segment(0.0, Waypoint(0.0), 10.0, Waypoint(10.0))])]
    wanted = request((1.0, [0.0]), joints=["one"], start=4.0)
    [path] = join(wanted, ["one"], [False], present, 2.0)
    assert path.sample(3.0).position == pytest.approx(3.0)
    assert path.sample(4.5).position == pytest.approx(2.0)  # half the way from 4 back to 0
    assert path.end_time == 5.0


def test_before_its_first_segment_a_path_stays_where_that_begins():
    path = Path([Segment(1.0, Waypoint(3.0), 2.0, Waypoint(4.0)),
                 Segment(2.0, Waypoint(4.0), 3.0, Waypoint(9.0))])
    assert [path.sample(time).position for time in (0.5, 1.0, 2.0, 3.0, 9.0)] == [3, 3, 4, 9, 9]
    assert path.between(0.0, 1.5) == path.segments[:1]


def test_points_of_the_past_are_left_out():
    wanted = request((1.0, [9.0]), (3.0, [4.0]), joints=["one"], start=10.0)
    [path] = join(wanted, ["one"], [False], standing(0.0), 12.0)
    assert path.sample(12.5).position == pytest.approx(2.0)
    with pytest.raises(InvalidTrajectory, match=r"all 2 points are in the past, the last by 7"):
        join(wanted, ["one"], [False], standing(0.0), 20.0)


def test_a_first_point_at_time_zero_is_left_out_silently():
    [path] = join(request((0.0, [9.0]), (1.0, [4.0]), joints=["one"]), ["one"], [False],
                  standing(0.0), 0.0)
    assert path.sample(0.5).position == pytest.approx(2.0)


def test_a_continuous_joint_takes_the_short_way_and_keeps_its_turns():
    turned = 4 * math.pi + 3.0
    wanted = request((1.0, [-3.0]), (2.0, [0.0]), joints=["one"])
    [path] = join(wanted, ["one"], [True], standing(turned), 0.0)
    assert path.sample(1.0).position == pytest.approx(6 * math.pi - 3.0)
    assert path.sample(2.0).position == pytest.approx(6 * math.pi)


def test_joints_that_are_not_asked_for_go_on():
    paths = join(request((1.0, [5.0]), joints=["two"]), JOINTS, [False] * 2,
                 standing(0.7, 0.0), 0.0)
    assert [path.sample(1.0).position for path in paths] == [0.7, 5.0]


# --- following

class Arm:
    """Two joints that go where a position command sends them, with a lag of their own."""

    def __init__(self, lag: float = 0.0, partial: bool = False, stop_duration: float = 0.0):
        self.lag = lag  # part of the error that stays in each step
        self.handles = [CommandHandle(JointHandle(name, "revolute"), "position") for name in JOINTS]
        self.follower = TrajectoryFollower([made.joint for made in self.handles],
                                           [PositionDrive(made) for made in self.handles],
                                           stop_duration, partial)
        self.time = 100.0
        self.follower.start(self.time)

    def run(self, seconds: float):
        """Until the goal is over, at most so long; how it ended."""
        for _ in range(round(seconds / STEP)):
            self.time += STEP
            outcome = self.follower.update(self.time, STEP)
            for made in self.handles:
                joint = made.joint
                position = made.command + self.lag * (joint.position - made.command)
                joint.velocity = (position - joint.position) / STEP
                joint.position = position
            if outcome:
                return outcome
        return None

    def positions(self):
        return [made.joint.position for made in self.handles]


def tolerances(path: float = 0.0, goal: float = 0.0, speed: float = 0.01, time: float = 0.0):
    return GoalTolerances({name: Tolerance(path) for name in JOINTS},
                          {name: Tolerance(goal, speed) for name in JOINTS}, time)


MOVE = request((0.5, [0.2, -0.1], [0.0, 0.0]), (1.0, [0.4, -0.4], [0.0, 0.0]))


def test_a_goal_is_reached_at_the_end_and_not_before():
    arm = Arm()
    arm.follower.follow(MOVE, tolerances(path=0.1, goal=0.01, time=0.1))
    assert arm.run(0.99) is None
    assert arm.run(0.1).verdict is Verdict.REACHED
    assert arm.positions() == pytest.approx([0.4, -0.4], abs=1e-4)
    assert arm.run(0.5) is None  # once


def test_a_lagging_joint_leaves_the_path_and_the_trajectory_goes_on():
    arm = Arm(lag=0.99)
    arm.follower.follow(MOVE, tolerances(path=0.02))
    outcome = arm.run(2.0)
    assert outcome.verdict is Verdict.LEFT_PATH
    assert outcome.text.startswith(("one: path position error", "two: path position error"))
    assert arm.time < 100.9
    arm.run(3.0)
    assert arm.positions() == pytest.approx([0.4, -0.4], abs=1e-3)


def test_a_late_joint_gets_the_goal_time_and_no_more():
    for allowed, verdict in ((1.0, Verdict.REACHED), (0.01, Verdict.MISSED_GOAL)):
        arm = Arm(lag=0.99)
        arm.follower.follow(MOVE, tolerances(goal=0.001, time=allowed))
        assert arm.run(3.0).verdict is verdict


def test_the_joint_that_missed_is_named():
    arm = Arm(lag=1.0)
    arm.follower.follow(MOVE, tolerances(goal=0.3))
    outcome = arm.run(3.0)
    assert (outcome.verdict, outcome.text) == (
        Verdict.MISSED_GOAL, "one: goal position error 0.4, tolerance 0.3")


def test_tolerances_begin_with_the_trajectory():
    arm = Arm(lag=1.0)
    arm.handles[0].joint.position = 0.5  # away from what is held
    later = TrajectoryRequest(MOVE.joints, MOVE.points, start=arm.time + 1.0)
    arm.follower.follow(later, tolerances(path=0.1))
    assert arm.run(0.99) is None
    assert arm.run(0.05).verdict is Verdict.LEFT_PATH


def test_another_trajectory_ends_the_judging():
    arm = Arm()
    arm.follower.follow(MOVE, tolerances(path=0.1))
    arm.run(0.3)
    arm.follower.follow(request((0.2, [0.0, 0.0])))
    assert arm.run(2.0) is None
    assert arm.positions() == pytest.approx([0.0, 0.0], abs=1e-4)


def test_no_points_means_to_hold():
    arm = Arm()
    arm.follower.follow(MOVE)
    arm.run(0.5)
    before = arm.positions()
    arm.follower.follow(TrajectoryRequest([], []))
    arm.run(1.0)
    assert arm.positions() == pytest.approx(before)


def test_a_bad_request_changes_nothing():
    arm = Arm()
    arm.follower.follow(MOVE, tolerances(goal=0.01, time=0.1))
    arm.run(0.3)
    with pytest.raises(InvalidTrajectory):
        arm.follower.follow(request((0.0, [1.0, 1.0])))
    assert arm.run(2.0).verdict is Verdict.REACHED
    assert arm.positions() == pytest.approx([0.4, -0.4], abs=1e-4)


def test_a_part_of_the_joints_is_judged_alone():
    arm = Arm(partial=True)
    arm.follower.follow(request((0.5, [0.3]), joints=["two"]), tolerances(goal=0.01, time=0.1))
    assert arm.run(1.0).verdict is Verdict.REACHED
    assert arm.positions() == pytest.approx([0.0, 0.3], abs=1e-4)


def test_a_state_in_the_future_can_be_asked_for():
    arm = Arm()
    arm.follower.follow(request((1.0, [1.0, 2.0])))
    arm.run(0.1)
    sampled = arm.follower.sample(arm.time + 0.4)
    assert [state.position for state in sampled] == pytest.approx([0.5, 1.0], abs=0.002)


def test_a_reset_of_time_does_not_disturb():
    arm = Arm()
    arm.follower.follow(MOVE, tolerances(goal=0.01, time=0.1))
    arm.run(0.5)
    arm.time = 0.0
    assert arm.run(1.0).verdict is Verdict.REACHED


def test_a_pid_drive_adds_feed_forward_and_both_errors():
    made = CommandHandle(JointHandle("one", "revolute"), "effort")
    drive = PidDrive(made, Pid(PidGains(p=10.0, d=2.0)), velocity_ff=0.5)
    drive(Waypoint(1.0, 4.0, 0.0), Waypoint(0.3, 0.1), STEP)
    assert made.command == pytest.approx(4.0 * 0.5 + 10 * 0.3 + 2 * 0.1)
    drive.restart()
    assert made.command == 0.0


@pytest.mark.parametrize("wish, result", [(0.0, 0.5), (0.2, 0.2), (-1.0, 0.0)])
def test_a_goal_may_change_tolerances(wish, result):
    assert Tolerance(position=0.5).replaced(wish, 0.0, 0.0).position == result
    assert chosen(wish, 0.5) == result
