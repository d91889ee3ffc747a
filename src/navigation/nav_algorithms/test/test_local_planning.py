"""Local planners, one command at a time."""

import time
from itertools import pairwise

import numpy as np
import pytest
from defaults import of
from local_plans import ORIGIN, STILL, WAFFLE, straight, window_around

from nav_algorithms.costmap import footprint as footprints
from nav_algorithms.costmap.costs import INSCRIBED, LETHAL
from nav_algorithms.local_planning.dwa import DwaPlanner, DwaSettings
from nav_algorithms.local_planning.free_arcs import free_arc
from nav_algorithms.local_planning.pure_pursuit import PurePursuit, PurePursuitSettings
from nav_algorithms.local_planning.trajectory_rollout import (
    TrajectoryRollout,
    TrajectoryRolloutSettings,
)
from nav_algorithms.poses import relative

WAFFLE_DWA = dict(max_vel_x=0.26, min_vel_x=-0.26, max_vel_trans=0.26, min_vel_trans=0.13,
                  max_vel_theta=1.82, min_vel_theta=0.9, acc_lim_y=0.0, max_vel_y=0.0,
                  min_vel_y=0.0, xy_goal_tolerance=0.05, yaw_goal_tolerance=0.17, sim_time=2.0,
                  vx_samples=20, vy_samples=0, vth_samples=40, path_distance_bias=32.0,
                  goal_distance_bias=20.0, occdist_scale=0.02, controller_frequency=10.0)
SWIFT = dict(min_in_place_vel_theta=1.5, max_vel_theta=1.5, min_vel_theta=-1.5)


def dwa(**changed):
    return DwaPlanner(of(DwaSettings, **{**WAFFLE_DWA, **changed}))


def rollout(**changed):
    return TrajectoryRollout(of(TrajectoryRolloutSettings, **{
        **dict(max_vel_x=0.26, min_vel_x=0.05, holonomic_robot=False, sim_time=1.0, vx_samples=3,
               dwa=True), **changed}))


def pursuit(**changed):
    return PurePursuit(of(PurePursuitSettings, **changed))


PLANNERS = [dwa, rollout, pursuit]


def commanded(planner, path, costmap=None, velocity=STILL, pose=ORIGIN, **more):
    planner.set_path(path)
    return planner.command(window_around() if costmap is None else costmap, WAFFLE, pose,
                           np.array(velocity, float), **more)


@pytest.mark.parametrize("planner", PLANNERS)
def test_straight_on(planner):
    command = commanded(planner(), straight(), velocity=(0.2, 0, 0))
    assert command.vx > 0.1
    assert command.vy == 0.0
    assert abs(command.omega) < 0.25
    assert command.trajectory[0] == pytest.approx(ORIGIN)
    assert command.trajectory[-1, 0] > 0.1


@pytest.mark.parametrize("planner", PLANNERS)
@pytest.mark.parametrize("side", [1, -1])
def test_towards_a_path_that_leads_aside(planner, side):
    command = commanded(planner(), straight(yaw=side * 0.8), velocity=(0.15, 0, 0))
    assert command.omega * side > 0.0


@pytest.mark.parametrize("planner", PLANNERS)
def test_the_path_may_be_in_another_frame(planner):
    frame = np.array([0.3, -0.4, 0.7])
    command = commanded(planner(), straight(), velocity=(0.15, 0, 0), pose=frame,
                        path_frame=frame)
    assert command.vx > 0.1
    assert abs(command.omega) < 0.3


@pytest.mark.parametrize("planner", PLANNERS)
def test_nothing_is_commanded_into_obstacles(planner):
    costmap = window_around()
    costmap.cells[:, 33:] = LETHAL
    command = commanded(planner(), straight(), costmap, velocity=(0.2, 0, 0))
    if command is not None:
        assert (footprints.costs(costmap, WAFFLE, command.trajectory) >= 0).all()
    costmap.cells[:] = LETHAL
    assert commanded(planner(), straight(), costmap) is None


@pytest.mark.parametrize("planner", PLANNERS)
def test_a_robot_between_walls_goes_through(planner):
    costmap = window_around()
    costmap.cells[:26] = costmap.cells[34:] = LETHAL
    command = commanded(planner(), straight(), costmap, velocity=(0.15, 0, 0))
    assert command.vx > 0.05


@pytest.mark.parametrize("planner", PLANNERS)
def test_no_path_no_command(planner):
    assert planner().command(window_around(), WAFFLE, ORIGIN, STILL) is None
    assert not planner().reached(ORIGIN, STILL)
    with pytest.raises(ValueError, match="path"):
        planner().set_path(np.full((3, 3), np.nan))


@pytest.mark.parametrize("planner", [dwa, rollout])
def test_at_the_goal_the_robot_stops_and_turns(planner):
    chosen = planner()
    path = np.array([[0.0, 0.0, 0.0], [0.02, 0.0, 1.5]])
    stopping = commanded(chosen, path, velocity=(0.25, 0, 0))
    assert 0.0 <= stopping.vx < 0.25
    assert stopping.omega == 0.0
    turn = commanded(chosen, path)
    assert turn.vx == 0.0
    assert turn.omega > 0.0
    assert not chosen.reached(ORIGIN, STILL)
    assert chosen.reached(np.array([0.0, 0.0, 1.5]), STILL)
    assert not chosen.reached(np.array([0.0, 0.0, 1.5]), np.array([0.3, 0, 0]))
    assert not chosen.reached(np.array([0.5, 0.0, 1.5]), STILL)


@pytest.mark.parametrize("planner", [dwa, rollout])
def test_it_stops_with_its_acceleration(planner):
    chosen = planner(acc_lim_x=0.5, controller_frequency=10.0)
    stopping = commanded(chosen, np.array([[0.0, 0.0, 0.0], [0.02, 0.0, 1.5]]),
                         velocity=(0.25, 0, 0))
    assert stopping.vx == pytest.approx(0.25 - 0.5 / 10.0)


def test_dwa_keeps_to_its_limits():
    samples_ = dwa().samples(np.array([0.1, 0, 0]), 5.0)
    slow = np.hypot(samples_[:, 0], samples_[:, 1]) < 0.13 - 1e-3
    assert (np.abs(samples_[slow, 2]) >= 0.9 - 1e-3).all()
    assert np.abs(samples_[:, 0]).max() <= 0.26 + 1e-9
    assert samples_[:, 1].tolist() == [0.0] * len(samples_)
    assert np.abs(dwa(acc_lim_x=0.5).samples(np.array([0.2, 0, 0]), 5.0)[:, 0] - 0.2).max() < 0.051
    wide = dwa(use_dwa=False, acc_lim_x=0.1).samples(STILL, 5.0)
    assert wide[:, 0].max() == pytest.approx(0.2)
    turning_ = dwa().samples(np.array([0.0, 0.0, 1.5]), 5.0)
    assert (np.abs(turning_[turning_[:, 0] == 0.0, 2]) > 0.95).sum() > 30
    near = dwa(use_dwa=False).samples(STILL, 0.3)
    assert near[:, 0].max() == pytest.approx(0.15)


def test_dwa_strafes_where_the_robot_can():
    settings = dict(max_vel_y=0.26, min_vel_y=-0.26, acc_lim_y=2.5, vy_samples=9,
                    forward_point_distance=0.0, max_vel_theta=0.2, min_vel_theta=0.2)
    command = commanded(dwa(**settings), straight(yaw=np.pi / 2))
    assert command.vy > 0.1


def test_dwa_honours_its_scales():
    costmap = window_around()
    costmap.cells[30:45, 36:] = 250
    careless = commanded(dwa(occdist_scale=0.0), straight(), costmap, velocity=(0.2, 0, 0))
    careful = commanded(dwa(occdist_scale=5.0), straight(), costmap, velocity=(0.2, 0, 0))
    assert careless.trajectory[-1, 0] > careful.trajectory[-1, 0] + 0.05
    still = commanded(dwa(twirling_scale=1000.0), straight(yaw=0.5), velocity=(0.2, 0, 0))
    assert still.omega == pytest.approx(0.0, abs=0.05)


def test_a_fast_robot_is_taken_for_a_wider_one():
    costmap = window_around()
    costmap.cells[:26] = costmap.cells[34:] = LETHAL
    settings = dict(scaling_speed=0.15, max_scaling_factor=0.5)
    assert commanded(dwa(), straight(), costmap, (0.2, 0, 0)).vx > 0.2
    assert commanded(dwa(**settings), straight(), costmap, (0.2, 0, 0)).vx < 0.2


def test_trajectory_rollout_turns_backs_out_and_strafes():
    behind = commanded(rollout(), straight(yaw=np.pi))
    assert behind.vx == 0.0 or abs(behind.omega) > 0.1
    costmap = window_around()
    costmap.cells[:, 32:] = LETHAL
    costmap.cells[:26, 20:] = costmap.cells[34:, 20:] = LETHAL
    backing = commanded(rollout(**SWIFT), straight(), costmap)
    assert (backing.vx, backing.omega) == (-0.1, 0.0)
    strafing = rollout(holonomic_robot=True, min_in_place_vel_theta=9.0, max_vel_theta=0.0,
                       min_vel_theta=0.0)
    costmap = window_around()
    costmap.cells[:, 32:] = LETHAL
    assert commanded(strafing, straight(yaw=1.5), costmap).vy != 0.0


def test_an_escape_goes_on_until_the_robot_has_moved():
    planner = rollout(escape_reset_dist=0.1, **SWIFT)
    costmap = window_around()
    costmap.cells[:, 32:] = LETHAL
    costmap.cells[:26, 20:] = costmap.cells[34:, 20:] = LETHAL
    assert commanded(planner, straight(), costmap).vx == -0.1
    planner.set_path(straight())
    assert planner.command(window_around(), WAFFLE, np.array([-0.05, 0, 0]), STILL).vx == -0.1
    assert planner.command(window_around(), WAFFLE, np.array([-0.12, 0, 0]), STILL).vx > 0.0


def test_a_robot_that_cannot_strafe_is_not_asked_to_though_it_slides():
    command = commanded(rollout(), straight(), velocity=(0.15, -0.02, 0.0))
    assert command.vx > 0.1 and command.vy == 0.0
    assert relative(*command.trajectory[-2:])[1] == pytest.approx(0.0)  # where it leads, too


@pytest.mark.parametrize("changed", [dict(heading_scoring=True), dict(meter_scoring=True),
                                     dict(dwa=False)])
def test_trajectory_rollout_in_its_other_ways(changed):
    command = commanded(rollout(**changed), straight(yaw=0.5), velocity=(0.2, 0, 0))
    assert command.vx > 0.0
    assert command.omega > 0.0


@pytest.mark.parametrize("make", [dwa, rollout])
def test_a_robot_that_cannot_change_its_turn_rate_has_an_answer(make):
    assert np.isfinite(commanded(make(acc_lim_theta=0.0), straight(yaw=1.5)).velocity).all()


def test_pursuit_drives_backwards_and_turns():
    back = straight(1.0)[::-1] - np.array([1.0, 0.0, 0.0])
    command = commanded(pursuit(), back)
    assert command.vx < 0.0
    aside = back.copy()
    aside[:, 1] = -0.3 * np.linspace(0, 1, 40) ** 2
    aside[:, 2] = np.arctan2(0.6 * np.linspace(0, 1, 40), 1.0)
    assert commanded(pursuit(), aside, velocity=(-0.3, 0, 0)).omega > 0.0
    turn = np.column_stack((np.zeros((5, 2)), np.linspace(0, 1.0, 5)))
    assert commanded(pursuit(), turn) is None
    assert commanded(pursuit(turn_in_place=True), turn).omega > 0.0


def test_pursuit_regulates_its_speed():
    fast = dict(desired_linear_vel=1.0, acc_lim_x=100.0, max_vel_theta=9.0)
    free = commanded(pursuit(**fast), straight(1.2))
    assert free.vx == pytest.approx(1.0)
    curve = commanded(pursuit(**fast), straight(1.2, yaw=0.7), velocity=(0.3, 0, 0))
    assert 0.15 <= curve.vx < 0.8
    assert commanded(pursuit(**fast, use_regulated_linear_velocity_scaling=False),
                     straight(1.2, yaw=0.7), velocity=(0.3, 0, 0)).vx == pytest.approx(1.0)
    costmap = window_around()
    costmap.cells[:25] = costmap.cells[35:] = LETHAL
    assert commanded(pursuit(**fast), straight(1.2), costmap).vx < 0.5
    assert commanded(pursuit(**fast, use_cost_regulated_linear_velocity_scaling=False),
                     straight(1.2), costmap).vx == pytest.approx(1.0)
    assert commanded(pursuit(**fast), straight(0.2)).vx < 0.5


def test_pursuit_keeps_to_the_turning_radius():
    command = commanded(pursuit(minimum_turning_radius=0.6), straight(yaw=1.3),
                        velocity=(0.2, 0, 0))
    assert abs(command.omega / command.vx) <= 1.0 / 0.6 + 1e-9


def test_pursuit_says_when_it_has_left_its_path_and_when_it_is_there():
    planner = pursuit()
    assert commanded(planner, np.array([0.0, 0.9, 0.0]) + straight()) is None
    for aside, left in ((0.5, False), (0.51, True)):
        command = commanded(pursuit(max_deviation=0.5), straight(), pose=np.array([0, aside, 0.0]))
        assert (command is None) == left
    planner.set_path(straight())
    assert planner.reached(np.array([1.2, 0, 0]), STILL)
    assert not planner.reached(np.array([1.2, 0, 0]), np.array([0.4, 0, 0]))
    assert not planner.reached(np.array([1.2, 0, 1.0]), STILL)
    at_end = planner.command(window_around(), WAFFLE, np.array([1.2, 0, 0]), STILL)
    assert at_end.velocity.tolist() == [0, 0, 0]
    planner.set_path(straight())
    assert planner.command(window_around(), WAFFLE, np.array([1.2, 0.2, 0]), STILL) is None


def test_a_robot_that_seems_to_touch_may_leave():
    costmap = window_around()
    costmap.cells[33:] = LETHAL
    assert footprints.costs(costmap, WAFFLE, ORIGIN)[0] < 0
    for planner in PLANNERS:
        assert commanded(planner(), straight(yaw=-0.3), costmap) is not None


@pytest.mark.parametrize("planner", PLANNERS)
def test_a_command_takes_less_than_10_ms(planner):
    generator = np.random.default_rng(0)
    costmap = window_around()
    for row, column in generator.integers(0, 60, (12, 2)):
        if abs(row - 30) > 6:
            costmap.cells[row:row + 3, column:column + 3] = LETHAL
    costmap.cells[(costmap.cells == 0) & (generator.random((60, 60)) < 0.05)] = INSCRIBED - 50
    chosen = planner()
    times = []
    for _ in range(5):
        begin = time.process_time()
        commanded(chosen, straight(), costmap, velocity=(0.2, 0, 0))
        times.append(time.process_time() - begin)
    assert min(times) < 0.01


@pytest.mark.parametrize("planner", [dwa, rollout])
def test_another_path_to_the_same_goal_forgets_nothing(planner):
    chosen = planner()
    chosen.set_path(straight())
    chosen.oscillation.only[0], chosen.end.latched = 1.0, True
    chosen.set_path(straight(), again=True)
    assert chosen.oscillation.only[0] == 1.0 and chosen.end.latched
    chosen.set_path(straight())
    assert chosen.oscillation.only[0] == 0.0 and not chosen.end.latched


def test_what_oscillation_forbids_is_allowed_where_nothing_else_is_free():
    chosen = dwa(min_vel_x=0.0, max_vel_theta=0.0)  # forwards only
    chosen.set_path(straight())
    chosen.oscillation.only[0] = -1.0
    commands = [chosen.command(window_around(), WAFFLE, ORIGIN, STILL) for _ in range(2)]
    assert commands[0] is None
    assert commands[1].vx > 0.0


@pytest.mark.parametrize("simple", [False, True])
def test_a_simple_attractor_takes_no_notice_of_the_path(simple):
    corners = np.array([[0.0, 0.0], [0.0, 0.8], [0.8, 0.8], [0.8, 0.0]])
    path = np.concatenate([np.linspace(a, b, 30) for a, b in pairwise(corners)])
    path = np.column_stack((path, np.zeros(len(path))))
    command = commanded(rollout(simple_attractor=simple), path)
    assert command.vx > 0.0 if simple else command.omega > 0.3
    assert not simple or abs(command.omega) < 0.2


def test_beside_a_blocked_arc_the_free_one_is_driven_that_ends_nearest_to_the_carrot():
    costmap = window_around()
    costmap.cells[29:31, 38:46] = LETHAL  # 0.4 m ahead
    dot = np.array([[0.02, 0.02], [-0.02, 0.02], [-0.02, -0.02], [0.02, -0.02]])
    for side in (1.0, -1.0):
        carrot = np.array([np.sin(0.8), side * (1.0 - np.cos(0.8)), side * 0.8])
        curvature, arc = free_arc(costmap, dot, ORIGIN, 0.8, 0.0, 2.0, carrot)
        assert curvature == pytest.approx(side, abs=0.2)
        assert arc[-1] == pytest.approx(carrot, abs=0.1)
