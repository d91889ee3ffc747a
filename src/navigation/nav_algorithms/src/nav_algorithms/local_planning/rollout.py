"""The outcome of many velocities: each trajectory is simulated on a costmap and its grids."""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np
from numba import f8, i8

from nav_algorithms.compiled import compiled
from nav_algorithms.costmap.footprint import GROUND, Ground, cost_at

LEGAL, OCCUPANCY, WORST, DISTANCE, PATH, GOAL, FRONT, ALIGNMENT = range(8)
ON_PATH = 0.5  # cells; points nearer to the path than this count as on it


class Motion(NamedTuple):
    """How trajectories are simulated."""

    acceleration: np.ndarray  # (3,)
    at_once: bool  # the robot has a sample's velocity from the beginning, else it accelerates
    sim_time: float  # s
    sim_granularity: float          # m, between two poses
    angular_sim_granularity: float  # rad
    stop_time: float  # s, besides braking, for which a turn on the spot has to be free


class Scoring(NamedTuple):
    """What trajectories are scored by."""

    grids: np.ndarray    # (3, rows, columns): distances to the path, the goal, the goal's front
    weights: np.ndarray  # (4,), of PATH, GOAL, FRONT and ALIGNMENT
    forward: float       # m ahead of the pose for FRONT and ALIGNMENT
    goal_range: float    # m: what goes past the goal is scored where it has gone so far


class Growth(NamedTuple):
    """How the footprint grows above a speed."""

    scaling_speed: float       # m/s
    max_scaling_factor: float  # at max_vel_trans
    max_vel_trans: float       # m/s


MOTION = numba.typeof(Motion(np.zeros(3), True, 1.0, 1.0, 1.0, 1.0))
SCORING = numba.typeof(Scoring(np.zeros((3, 1, 1)), np.zeros(4), 1.0, 1.0))
GROWTH = numba.typeof(Growth(1.0, 1.0, 1.0))


@compiled("void(f8[::1], f8[::1], f8[::1], f8[::1], f8, f8[::1])")
def advance(pose, velocity, wanted, acceleration, dt, found):
    """One step: the velocity approaches `wanted`, in place, and `found` becomes the new pose."""
    for n in range(3):
        change = min(max(wanted[n] - velocity[n], -acceleration[n] * dt), acceleration[n] * dt)
        velocity[n] += change
    cos, sin = np.cos(pose[2]), np.sin(pose[2])
    found[0] = pose[0] + (velocity[0] * cos - velocity[1] * sin) * dt
    found[1] = pose[1] + (velocity[0] * sin + velocity[1] * cos) * dt
    found[2] = pose[2] + velocity[2] * dt


@compiled(i8(f8[::1], MOTION))
def steps_of(sample, motion: Motion):
    """Steps of a trajectory: each no longer than its granularity, m or rad."""
    return max(int(np.ceil(np.hypot(sample[0], sample[1]) * motion.sim_time
                           / motion.sim_granularity)),
               int(np.ceil(abs(sample[2]) * motion.sim_time / motion.angular_sim_granularity)), 1)


@compiled(f8[:, ::1](f8[::1], f8[::1], f8[::1], MOTION))
def trajectory(pose, velocity, sample, motion: Motion):
    """Poses (M, 3) of one sample (vx, vy, omega), beginning with the current one."""
    steps = steps_of(sample, motion)
    poses = np.empty((steps + 1, 3))
    poses[0] = pose
    now = sample.copy() if motion.at_once else velocity.copy()
    for n in range(steps):
        advance(poses[n], now, sample, motion.acceleration, motion.sim_time / steps, poses[n + 1])
    return poses


@compiled("f8(f8[:,::1], f8, f8, f8, f8, f8)")
def _look_up(grid, resolution, origin_x, origin_y, x, y):
    """The grid's value at a point; inf outside."""
    row, column = np.floor((y - origin_y) / resolution), np.floor((x - origin_x) / resolution)
    if 0 <= row < grid.shape[0] and 0 <= column < grid.shape[1]:
        return grid[int(row), int(column)]
    return np.inf


@compiled("f8(f8[:,::1], f8, f8, f8, f8, f8)")
def _between(grid, resolution, origin_x, origin_y, x, y):
    """The grid's value at a point, interpolated between four cells; the cell's own next to inf.

    Without this, a robot that drives less than a cell in all would see no difference of samples.
    """
    row, column = (y - origin_y) / resolution - 0.5, (x - origin_x) / resolution - 0.5
    r, c = int(np.floor(row)), int(np.floor(column))
    if 0 <= r < grid.shape[0] - 1 and 0 <= c < grid.shape[1] - 1:
        v, u = row - r, column - c
        value = ((grid[r, c] * (1.0 - u) + grid[r, c + 1] * u) * (1.0 - v)
                 + (grid[r + 1, c] * (1.0 - u) + grid[r + 1, c + 1] * u) * v)
        if value < np.inf:
            return value
    return _look_up(grid, resolution, origin_x, origin_y, x, y)


@compiled("f8(f8[:,:,::1], f8[::1], f8, f8, f8, f8[::1], f8, f8[::1])")
def _look(grids, weights, resolution, origin_x, origin_y, pose, forward, found):
    """Fill PATH, GOAL, FRONT and ALIGNMENT of one pose; returns their weighted sum."""
    x, y, yaw = pose
    ahead_x, ahead_y = x + forward * np.cos(yaw), y + forward * np.sin(yaw)
    blocked = 2 * forward / resolution
    for grid in range(3):
        found[PATH + grid] = _between(grids[grid], resolution, origin_x, origin_y, x, y)
    front = _between(grids[2], resolution, origin_x, origin_y, ahead_x, ahead_y)
    found[FRONT] = min(front, found[FRONT] + blocked)
    alignment = _between(grids[0], resolution, origin_x, origin_y, ahead_x, ahead_y)
    found[ALIGNMENT] = max(min(alignment, found[PATH] + blocked) - ON_PATH, 0.0)
    found[PATH] = max(found[PATH] - ON_PATH, 0.0)
    if found[FRONT] == np.inf:
        found[FRONT] = 0.0
    return (weights[0] * found[PATH] + weights[1] * found[GOAL] + weights[2] * found[FRONT]
            + weights[3] * found[ALIGNMENT])


@compiled(f8[:, ::1](GROUND, MOTION, SCORING, GROWTH, f8[:, ::1], f8[::1], f8[::1]))
def rollouts(ground: Ground, motion: Motion, scoring: Scoring, growth: Growth, samples, pose,
             velocity):
    """The results of the samples (S, 3): (S, 8), with the columns named at the top of this file.

    LEGAL is 1, or 0 if the footprint touched something. OCCUPANCY is the highest cost below the
    last pose, WORST below any. PATH and GOAL are looked up at the last pose, FRONT and ALIGNMENT
    ahead of it; if that point is in an obstacle, they are those of the pose plus twice the way to
    the point. DISTANCE is the weighted sum of these four. A turn on the spot can be ended anywhere:
    it is scored where its DISTANCE is lowest among the poses where it can stand again, and only has
    to be free for the time that it takes to brake plus `stop_time`.
    """
    resolution, origin_x, origin_y = ground.resolution, ground.origin_x, ground.origin_y
    footprint, scaling_speed = ground.footprint, growth.scaling_speed
    acceleration, sim_time = motion.acceleration, motion.sim_time
    found = np.zeros((len(samples), 8))
    poses = np.empty((2, 3))
    grown = np.empty(footprint.shape)
    here = np.empty(8)
    for s in range(len(samples)):
        sample = samples[s]
        speed = np.hypot(sample[0], sample[1])
        on_the_spot = speed < 1e-6
        scale = 1.0
        if speed > scaling_speed and growth.max_vel_trans > scaling_speed:
            scale += growth.max_scaling_factor * min(
                (speed - scaling_speed) / (growth.max_vel_trans - scaling_speed), 1.0)
        grown[:] = footprint * scale
        clear = ground.circumscribed * scale / resolution + 1.5
        steps = steps_of(sample, motion)
        dt = sim_time / steps
        last = steps
        if not on_the_spot:
            last = min(steps, max(int(np.ceil(scoring.goal_range / (speed * dt))), 1))
        braked = sim_time
        if on_the_spot and acceleration[2] > 0.0:
            braked = min(abs(sample[2]) / acceleration[2] + motion.stop_time, sim_time)
        now = sample.copy() if motion.at_once else velocity.copy()
        poses[0] = pose
        worst, best = 0, np.inf
        for n in range(1, steps + 1):
            before, after = (n - 1) & 1, n & 1
            advance(poses[before], now, sample, acceleration, dt, poses[after])
            x, y, yaw = poses[after]
            free = _look_up(ground.free_radii, resolution, origin_x, origin_y, x, y)
            stands = on_the_spot and n * dt * acceleration[2] >= 0.5 * abs(sample[2])
            cost = 0
            if not clear < free < np.inf or n == last or stands:
                cost = cost_at(ground.cells, resolution, origin_x, origin_y, grown, x, y, yaw)
                if cost < 0:
                    if n * dt <= braked:
                        best = np.inf
                    break
                worst = max(worst, cost)
            if stands or (n == last and not on_the_spot):
                value = _look(scoring.grids, scoring.weights, resolution, origin_x, origin_y,
                              poses[after], scoring.forward, here)
                if value < best:
                    best = value
                    found[s] = here
                    found[s, OCCUPANCY], found[s, DISTANCE] = cost, value
        found[s, WORST] = worst
        found[s, LEGAL] = 1.0 if best < np.inf else 0.0
    return found
