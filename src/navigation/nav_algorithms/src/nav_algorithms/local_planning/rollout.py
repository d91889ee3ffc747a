"""The outcome of many velocities: each trajectory is simulated on a costmap and its grids."""

from __future__ import annotations

import numpy as np

from nav_algorithms.compiled import compiled
from nav_algorithms.costmap.footprint import cost_at

LEGAL, OCCUPANCY, WORST, DISTANCE, PATH, GOAL, FRONT, ALIGNMENT = range(8)
ON_PATH = 0.5  # cells; points nearer to the path than this count as on it


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


@compiled("i8(f8[::1], f8, f8, f8)")
def steps_of(sample, sim_time, sim_granularity, angular_sim_granularity):
    """Steps of a trajectory: each no longer than its granularity, m or rad."""
    return max(int(np.ceil(np.hypot(sample[0], sample[1]) * sim_time / sim_granularity)),
               int(np.ceil(abs(sample[2]) * sim_time / angular_sim_granularity)), 1)


@compiled("f8[:,::1](f8[::1], f8[::1], f8[::1], f8[::1], b1, f8, f8, f8)")
def trajectory(pose, velocity, sample, acceleration, at_once, sim_time, sim_granularity,
               angular_sim_granularity):
    """Poses (M, 3) of one sample (vx, vy, omega), beginning with the current one.

    `at_once`: the robot has the sample's velocity from the beginning; else it approaches it from
    `velocity` with `acceleration`, (3,).
    """
    steps = steps_of(sample, sim_time, sim_granularity, angular_sim_granularity)
    poses = np.empty((steps + 1, 3))
    poses[0] = pose
    now = sample.copy() if at_once else velocity.copy()
    for n in range(steps):
        advance(poses[n], now, sample, acceleration, sim_time / steps, poses[n + 1])
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


@compiled("f8[:,::1](u1[:,::1], f8, f8, f8, f8[:,::1], f8, f8[:,::1], f8[:,:,::1], f8[::1], "
          "f8[:,::1], f8[::1], f8[::1], f8[::1], b1, f8, f8, f8, f8, f8, f8, f8, f8, f8)")
def rollouts(cells, resolution, origin_x, origin_y, free_radii, circumscribed, footprint, grids,
             weights, samples, pose, velocity, acceleration, at_once, sim_time, sim_granularity,
             angular_sim_granularity, forward, goal_range, stop_time, scaling_speed,
             max_scaling_factor, max_vel_trans):
    """The results of the samples (S, 3): (S, 8), with the columns named at the top of this file.

    `free_radii` (rows, columns), cells: the distance of each cell from those not to be touched;
    beyond the `circumscribed` radius, m, the footprint is not checked. `grids` (3, rows, columns):
    distances to the path, the goal and the goal's front. LEGAL is 1, or 0 if the footprint touched
    something. OCCUPANCY is the highest cost below the last pose, WORST below any. PATH and GOAL
    are looked up at the last pose, FRONT and ALIGNMENT `forward`, m, ahead of it; if that point is
    in an obstacle, they are those of the pose plus twice the way to the point. DISTANCE is the sum
    of these four by `weights` (4,). `goal_range`, m: a trajectory that goes past the goal is scored
    where it has gone so far. A turn on the spot can be ended anywhere: it is scored where its
    DISTANCE is lowest among the poses where it can stand again, and only has to be free for the
    time that it takes to brake plus `stop_time`, s. Above `scaling_speed`, m/s, the footprint
    grows, by `max_scaling_factor` at `max_vel_trans`.
    """
    found = np.zeros((len(samples), 8))
    poses = np.empty((2, 3))
    grown = np.empty(footprint.shape)
    here = np.empty(8)
    for s in range(len(samples)):
        sample = samples[s]
        speed = np.hypot(sample[0], sample[1])
        on_the_spot = speed < 1e-6
        scale = 1.0
        if speed > scaling_speed and max_vel_trans > scaling_speed:
            scale += max_scaling_factor * min((speed - scaling_speed)
                                              / (max_vel_trans - scaling_speed), 1.0)
        grown[:] = footprint * scale
        clear = circumscribed * scale / resolution + 1.5
        steps = steps_of(sample, sim_time, sim_granularity, angular_sim_granularity)
        dt = sim_time / steps
        last = steps
        if not on_the_spot:
            last = min(steps, max(int(np.ceil(goal_range / (speed * dt))), 1))
        braked = sim_time
        if on_the_spot and acceleration[2] > 0.0:
            braked = min(abs(sample[2]) / acceleration[2] + stop_time, sim_time)
        now = sample.copy() if at_once else velocity.copy()
        poses[0] = pose
        worst, best = 0, np.inf
        for n in range(1, steps + 1):
            before, after = (n - 1) & 1, n & 1
            advance(poses[before], now, sample, acceleration, dt, poses[after])
            x, y, yaw = poses[after]
            free = _look_up(free_radii, resolution, origin_x, origin_y, x, y)
            stands = on_the_spot and n * dt * acceleration[2] >= 0.5 * abs(sample[2])
            cost = 0
            if not clear < free < np.inf or n == last or stands:
                cost = cost_at(cells, resolution, origin_x, origin_y, grown, x, y, yaw)
                if cost < 0:
                    if n * dt <= braked:
                        best = np.inf
                    break
                worst = max(worst, cost)
            if stands or (n == last and not on_the_spot):
                value = _look(grids, weights, resolution, origin_x, origin_y, poses[after],
                              forward, here)
                if value < best:
                    best = value
                    found[s] = here
                    found[s, OCCUPANCY], found[s, DISTANCE] = cost, value
        found[s, WORST] = worst
        found[s, LEGAL] = 1.0 if best < np.inf else 0.0
    return found
