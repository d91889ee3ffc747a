"""Robots that drive through random narrow worlds: they arrive and touch nothing.

The worlds are made in the manner of the BARN benchmark (D. Perille et al., 2020): pillars placed by
a cellular automaton in a yard, between a start and a goal. The robot obeys with its acceleration.
"""

from __future__ import annotations

import numpy as np
import pytest
from defaults import of

from nav_algorithms import likelihood_field
from nav_algorithms.costmap import footprint as footprints
from nav_algorithms.costmap.costs import INSCRIBED, LETHAL, Costmap
from nav_algorithms.global_planning import hybrid_astar, navfn
from nav_algorithms.global_planning.hybrid_astar import HybridAstarSettings
from nav_algorithms.local_planning.dwa import DwaPlanner, DwaSettings
from nav_algorithms.local_planning.pure_pursuit import PurePursuit, PurePursuitSettings
from nav_algorithms.local_planning.trajectory_rollout import (
    TrajectoryRollout,
    TrajectoryRolloutSettings,
)

WAFFLE = np.array([[-0.205, -0.155], [-0.205, 0.155], [0.077, 0.155], [0.077, -0.155]])
CAR = np.array([[-0.1, -0.15], [-0.1, 0.15], [0.45, 0.15], [0.45, -0.15]])
FINE, RESOLUTION, TICK = 0.025, 0.05, 0.02  # m, m, s
START, GOAL = np.array([2.7, 0.8, np.pi / 2]), np.array([2.7, 7.3, np.pi / 2])


def inflated(occupied, resolution, inscribed, radius=1.0, scaling=3.0):
    """Costs as the inflation layer makes them."""
    distance = likelihood_field.distances(occupied) * resolution
    cost = np.where(distance <= radius, 252 * np.exp(-scaling * (distance - inscribed)), 0)
    cost = np.where(distance <= inscribed, INSCRIBED, np.minimum(cost, 252)).astype(np.uint8)
    cost[occupied > 0] = LETHAL
    return cost


def world(seed, clearance):
    """Occupied fine cells of a yard 5.4 x 8 m in which there is a way of that clearance, m."""
    generator = np.random.default_rng(seed)
    while True:
        full = generator.random((32, 32)) < generator.uniform(0.15, 0.3)
        for _ in range(int(generator.integers(1, 4))):
            around = sum(np.roll(np.pad(full, 1), (i, j), (0, 1)) for i in (-1, 0, 1)
                         for j in (-1, 0, 1) if i or j)[1:-1, 1:-1]
            full = np.where(around >= 5, True, np.where(around <= 1, False, full))
        centres = np.argwhere(full) * 0.15 + (1.6, 0.3)
        occupied = np.zeros((320, 216), np.uint8)
        rows, columns = np.mgrid[-4:5, -4:5]
        for row, column in np.round(centres / FINE).astype(int):
            disc = occupied[row - 4:row + 5, column - 4:column + 5]
            disc[rows ** 2 + columns ** 2 <= 9] = 1
        occupied[:8] = occupied[-8:] = 1
        occupied[:, :8] = occupied[:, -8:] = 1
        if navfn.plan(Costmap(inflated(occupied, FINE, clearance), FINE, (0, 0)),
                      START, GOAL, settings=of(navfn.NavfnSettings)) is not None:
            return occupied


def drive(occupied, planner, global_plan, outline, replan, rate, acceleration, goal, limit):
    """'reached', 'contact' or 'late', and the s it took, of a drive from START to `goal`."""
    truth = Costmap(occupied * np.uint8(LETHAL), FINE, (0, 0))
    coarse = occupied.reshape(160, 2, 108, 2).max(axis=(1, 3))
    padded = footprints.padded(outline, 0.01)
    local = Costmap(inflated(coarse, RESOLUTION, footprints.radii(padded)[0]), RESOLUTION, (0, 0))
    pose, velocity, blocked, known = START.copy(), np.zeros(3), 0, False
    for period in range(int(limit * rate)):
        if period == 0 or (replan and period % replan == 0) or blocked == 5:
            path = global_plan(coarse, pose, goal)
            if path is not None:
                planner.set_path(path, again=known)
                known = True
        row, column = (int(n) for n in np.clip(local.cells_of(pose[:2]) - 30, 0, (100, 48)))
        near = Costmap(local.cells[row:row + 60, column:column + 60], RESOLUTION,
                       (column * RESOLUTION, row * RESOLUTION))
        if planner.reached(pose, velocity):
            return "reached", period / rate
        command = planner.command(near, padded, pose, velocity)
        blocked = blocked + 1 if command is None else 0
        wanted = np.zeros(3) if command is None else command.velocity
        for _ in range(round(1 / rate / TICK)):
            step = np.asarray(acceleration) * TICK
            velocity = velocity + np.clip(wanted - velocity, -step, step)
            cos, sin = np.cos(pose[2]), np.sin(pose[2])
            pose = pose + TICK * np.array([velocity[0] * cos - velocity[1] * sin,
                                           velocity[0] * sin + velocity[1] * cos, velocity[2]])
            if footprints.costs(truth, outline, pose)[0] < 0:
                return "contact", period / rate
    return "late", limit


def navfn_for(inscribed):
    return lambda coarse, pose, goal: navfn.plan(
        Costmap(inflated(coarse, RESOLUTION, inscribed), RESOLUTION, (0, 0)), pose, goal,
        settings=of(navfn.NavfnSettings))


def hybrid_for(outline, settings):
    inscribed = footprints.radii(outline)[0]
    return lambda coarse, pose, goal: hybrid_astar.plan(
        Costmap(inflated(coarse, RESOLUTION, inscribed), RESOLUTION, (0, 0)), pose, goal,
        footprints.padded(outline, 0.015), settings)


@pytest.mark.parametrize("seed", [0, 4, 7])
def test_dwa_with_the_waffle(seed):
    planner = DwaPlanner(of(DwaSettings,
        max_vel_x=0.26, min_vel_x=-0.26, max_vel_trans=0.26, min_vel_trans=0.13, max_vel_y=0.0,
        min_vel_y=0.0, acc_lim_y=0.0, max_vel_theta=1.82, min_vel_theta=0.9, sim_time=2.0,
        vx_samples=20, vy_samples=0, vth_samples=40, path_distance_bias=32.0,
        goal_distance_bias=20.0, occdist_scale=0.02, controller_frequency=10.0,
        xy_goal_tolerance=0.05, yaw_goal_tolerance=0.17))
    assert drive(world(seed, 0.25), planner, navfn_for(0.2), WAFFLE, 5, 10, (2.5, 0, 3.2), GOAL,
                 60)[0] == "reached"


@pytest.mark.parametrize("seed", [1, 5])
def test_trajectory_rollout_with_the_waffle(seed):
    planner = TrajectoryRollout(of(TrajectoryRolloutSettings,
        max_vel_x=0.26, min_vel_x=0.05, max_vel_theta=1.8, min_vel_theta=-1.8,
        holonomic_robot=False, controller_frequency=10.0, angular_sim_granularity=0.05,
        vx_samples=6, yaw_goal_tolerance=0.1, trans_stopped_velocity=0.05,
        rot_stopped_velocity=0.1))
    assert drive(world(seed, 0.25), planner, navfn_for(0.2), WAFFLE, 5, 10, (2.5, 0, 3.2), GOAL,
                 60)[0] == "reached"


@pytest.mark.parametrize("seed", [4, 13])
def test_pursuit_with_the_waffle_where_it_hardly_fits(seed):
    planner = PurePursuit(of(PurePursuitSettings,
        desired_linear_vel=0.26, turn_in_place=True, min_lookahead_dist=0.15,
        max_lookahead_dist=0.3, minimum_turning_radius=0.15, acc_lim_x=2.5,
        controller_frequency=10.0, xy_goal_tolerance=0.05))
    plan = hybrid_for(WAFFLE, of(HybridAstarSettings, turn_in_place=True))
    assert drive(world(seed, 0.2), planner, plan, WAFFLE, 0, 10, (2.5, 0, 3.2), GOAL,
                 180)[0] == "reached"


@pytest.mark.parametrize("seed, yaw", [(0, np.pi / 2), (3, -np.pi / 2)])
def test_pursuit_with_a_car(seed, yaw):
    plan = hybrid_for(CAR, of(HybridAstarSettings))
    goal = np.array([*GOAL[:2], yaw])
    planner = PurePursuit(of(PurePursuitSettings))
    assert drive(world(seed, 0.35), planner, plan, CAR, 0, 20, (2.0, 0, 6.0), goal,
                 60)[0] == "reached"
