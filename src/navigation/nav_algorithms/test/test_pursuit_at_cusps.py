"""Pure pursuit where a car changes between forwards and backwards: steering takes a while."""

from itertools import pairwise

import numpy as np
import pytest
from defaults import of

from nav_algorithms.costmap import footprint as footprints
from nav_algorithms.costmap.costs import LETHAL, Costmap
from nav_algorithms.global_planning.hybrid_astar import HybridAstarSettings, plan
from nav_algorithms.local_planning.pure_pursuit import PurePursuit, PurePursuitSettings
from nav_algorithms.poses import wrap_angle

CAR = np.array([[-0.1, -0.15], [-0.1, 0.15], [0.45, 0.15], [0.45, -0.15]])
WHEELBASE, LOCK = 0.335, 0.5     # m; rad, of the front wheels
STEERING, LATENCY = 0.1, 2       # s, time constant of the front wheels; periods until they obey
RATE, TICKS = 20, 5              # commands a second; steps of the car a command
SETTINGS = of(PurePursuitSettings, desired_linear_vel=0.8, minimum_turning_radius=0.63,
                               min_approach_linear_velocity=0.1,
                               approach_velocity_scaling_dist=0.2, yaw_goal_tolerance=0.15)


def road(width, wall=None):
    """A straight road along x, 10 m long, between walls; another across it at x = `wall`, m."""
    costmap = Costmap(np.full((80, 200), LETHAL, np.uint8), 0.05, (0.0, -2.0))
    half = round(width / 2 / 0.05)
    costmap.cells[40 - half:40 + half, 2:-2] = 0
    if wall is not None:
        costmap.cells[:, round(wall / 0.05):] = LETHAL
    return costmap


def straight(*ends):
    """Along x from one of the ends, m, to the next, and so on."""
    legs = [np.linspace(a, b, round(abs(b - a) / 0.05) + 1) for a, b in pairwise(ends)]
    x = np.concatenate([legs[0], *(leg[1:] for leg in legs[1:])])
    return np.column_stack((x, np.zeros((len(x), 2))))


def curve(radius, length=0.8):
    """To the left from x = 1 m; m."""
    s = np.arange(0.0, length, 0.04)
    return np.column_stack((1.0 + radius * np.sin(s / radius),
                            radius * (1 - np.cos(s / radius)), s / radius))


@pytest.mark.parametrize("turned, fast", [(0.0, False), (-1.0, False), (1.3, True)])
def test_it_gathers_speed_when_its_wheels_are_turned(turned, fast):
    planner = PurePursuit(SETTINGS)
    planner.set_path(curve(0.7))
    velocity = np.array([0.12, 0.0, 0.12 * turned])
    command = planner.command(road(2.0), CAR, np.array([1.0, 0, 0]), velocity)
    assert (command.vx > 0.12) == fast


def test_it_does_not_wait_for_ever_for_odometry_that_never_turns():
    planner = PurePursuit(SETTINGS)
    planner.set_path(curve(0.7))
    speeds = [planner.command(road(2.0), CAR, np.array([1.0, 0, 0]), np.array([0.12, 0, 0])).vx
              for _ in range(RATE)]
    assert speeds[0] == pytest.approx(0.1) and speeds[-1] > 0.12


def test_it_goes_on_behind_a_cusp_that_a_wall_is_a_little_too_near_to():
    """The outline ends 0.45 m ahead: 0.1 m before the first piece's end it would touch."""
    planner = PurePursuit(SETTINGS)
    planner.set_path(straight(1.0, 2.0, 1.0))
    costmap = road(1.2, wall=2.4)
    assert planner.command(costmap, CAR, np.array([1.2, 0, 0]), np.zeros(3)).vx > 0.0
    assert planner.command(costmap, CAR, np.array([1.9, 0, 0]), np.zeros(3)).vx < 0.0


def test_it_does_not_go_on_far_before_a_cusp():
    planner = PurePursuit(SETTINGS)
    planner.set_path(straight(1.0, 2.0, 1.0))
    assert planner.command(road(1.2, wall=2.1), CAR, np.array([1.6, 0, 0]), np.zeros(3)) is None


def turn_about(x, width):
    """(plans, changes between forwards and backwards, s) until it stands at x, m, turned about."""
    costmap, planner = road(width), PurePursuit(SETTINGS)
    wide = footprints.padded(CAR, 0.02)  # what is planned with, and what follows
    settings = of(HybridAstarSettings, minimum_turning_radius=0.7)
    pose, speed, steering, waiting = np.array([x, 0.0, 0.0]), 0.0, 0.0, [(0.0, 0.0)] * LATENCY
    goal, plans, directions = np.array([x, 0.0, np.pi]), 0, []
    for period in range(60 * RATE):
        velocity = np.array([speed, 0.0, speed * np.tan(steering) / WHEELBASE])
        command = None if not plans else planner.command(costmap, CAR, pose, velocity)
        if plans and planner.reached(pose, velocity):
            assert abs(wrap_angle(pose[2] - goal[2])) < 0.15
            return plans, int((np.diff(directions) != 0).sum()), period / RATE
        if command is None and speed == 0.0:
            planner.set_path(plan(costmap, pose, goal, wide, settings))
            plans += 1
        vx, omega = (command.vx, command.omega) if command else (0.0, 0.0)
        waiting.append((vx, np.arctan(WHEELBASE * omega / vx) if vx else 0.0))
        speed, wanted = waiting.pop(0)
        directions += [np.sign(speed)] if speed else []
        for _ in range(TICKS):
            step = 1 / RATE / TICKS
            steering += (np.clip(wanted, -LOCK, LOCK) - steering) * step / STEERING
            pose = pose + step * np.array([speed * np.cos(pose[2]), speed * np.sin(pose[2]),
                                           speed * np.tan(steering) / WHEELBASE])
            assert footprints.costs(costmap, CAR * [1.0, 0.97], pose)[0] >= 0, (pose, plans)
    raise AssertionError(f"not within 60 s; {plans} plans")


@pytest.mark.parametrize("x", [4.0, 4.02, 4.04])
def test_it_turns_about_in_a_narrow_road(x):
    plans, changes, seconds = turn_about(x, 1.1)
    assert plans <= 2 and 2 <= changes <= 6 and seconds < 20.0


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("speed", [0.4, 0.8])
def test_a_robot_on_an_arc_stays_on_it_however_far_ahead_it_looks(side, speed):
    """The carrot is on the circle, so the arc to it is that circle's."""
    radius, angles = 2.0, np.linspace(0.0, 1.5, 600)
    path = np.column_stack((radius * np.sin(angles), side * radius * (1 - np.cos(angles)),
                            side * angles))
    planner = PurePursuit(SETTINGS)
    planner.set_path(path)
    costmap = Costmap(np.zeros((160, 160), np.uint8), 0.05, (-4.0, -4.0))
    command = planner.command(costmap, CAR, np.zeros(3), np.array([speed, 0, side * speed / 2]))
    assert command.omega / command.vx == pytest.approx(side / radius, rel=0.01)
