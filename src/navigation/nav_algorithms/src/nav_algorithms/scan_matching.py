"""Matches a scan to a map of hits: a search on a grid of poses, then Gauss-Newton.

The search is correlative (E. Olson, "Real-time correlative scan matching", 2009): it works from
far. The refinement moves each beam's end to the mean of the hits around it: across the wall
shown by the beam's neighbours, and hardly along it (A. Censi, "An ICP variant using a
point-to-line metric", 2008). So the end of a wall's known part does not hold the robot back.

All lengths are in cells of the map, all poses (column, row, yaw). `beams` (N, 5): the ends x, y
of beams in the robot's frame, and how much each constrains, xx, xy, yy (see beam_walls).
"""

from __future__ import annotations

import math

import numpy as np

from nav_algorithms.compiled import compiled
from nav_algorithms.hit_maps import HITS, NEAR, PATCH, SUM_COLUMN, SUM_ROW, patch_at, value_at
from nav_algorithms.small_matrices import cholesky, solve_backwards, solve_forwards

TRUSTED_HITS = 3.0  # with this many hits a wall counts fully
FULL_HITS = 10.0    # with this many hits a cell's weight among others no longer grows
MISS = 6.7          # subtracted from the log likelihood for a beam that ends at no wall


@compiled("UniTuple(f8, 3)(i4[:,::1], f4[:,:,:,::1], f8, f8, i8)")
def _wall_near(table: np.ndarray, pool: np.ndarray, x: float, y: float,
               kernel: int) -> tuple[float, float, float]:
    """(trust 0 to 1, mean x, mean y) of the hits around (x, y). Trust 0: there are none."""
    row, column = math.floor(y), math.floor(x)
    reach = (kernel + 0.5) ** 2
    hits = weights = sum_x = sum_y = 0.0
    for r in range(row - kernel, row + kernel + 1):
        for c in range(column - kernel, column + kernel + 1):
            patch = patch_at(table, r, c)
            if patch < 0:
                continue
            cell = pool[patch, r % PATCH, c % PATCH]
            if cell[HITS] == 0.0:
                continue
            dx = c + cell[SUM_COLUMN] / cell[HITS] - x
            dy = r + cell[SUM_ROW] / cell[HITS] - y
            near = 1.0 - (dx * dx + dy * dy) / reach
            if near > 0.0:
                weight = near * near * min(cell[HITS], FULL_HITS)
                hits += cell[HITS]
                weights += weight
                sum_x += weight * dx
                sum_y += weight * dy
    if weights == 0.0:
        return 0.0, 0.0, 0.0
    return min(1.0, hits / TRUSTED_HITS), x + sum_x / weights, y + sum_y / weights


@compiled("UniTuple(f8, 2)(i4[:,::1], f4[:,:,:,::1], f8[:,::1], f8[::1], i8, i8, f8[::1],"
          "f8[:,::1], f8[::1])")
def evaluate(table: np.ndarray, pool: np.ndarray, beams: np.ndarray, pose: np.ndarray,
             kernel: int, stride: int, widths: np.ndarray, hessian: np.ndarray,
             gradient: np.ndarray) -> tuple[float, float]:
    """(log likelihood, score) of every `stride`-th beam at a pose.

    The score is about how many beams end at a wall: each adds exp(-d^2 / widths[1]) for its
    distance d. `widths` (3,): the likelihood's deviation, cells; the score's width, cells squared;
    the deviation, cells, for `hessian` (3, 3) and `gradient` (3,), which become those of the
    negative log likelihood, for Gauss-Newton.
    """
    hessian[:] = 0.0
    gradient[:] = 0.0
    likelihood = score = 0.0
    variance, scatter = widths[0] ** 2, widths[2] ** 2
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    reach = (kernel + 0.5) ** 2
    for k in range(0, len(beams), stride):
        off_x = cos * beams[k, 0] - sin * beams[k, 1]
        off_y = sin * beams[k, 0] + cos * beams[k, 1]
        x, y = pose[0] + off_x, pose[1] + off_y
        trust, mean_x, mean_y = _wall_near(table, pool, x, y, kernel)
        if trust == 0.0:
            likelihood -= MISS
            continue
        dx, dy = x - mean_x, y - mean_y
        xx, xy, yy = beams[k, 2], beams[k, 3], beams[k, 4]
        aside = sin * xx + cos * xy
        xx, xy, yy = (cos * (cos * xx - sin * xy) - sin * (cos * xy - sin * yy),
                      cos * aside - sin * (sin * xy + cos * yy),
                      sin * aside + cos * (sin * xy + cos * yy))
        pull_x, pull_y = xx * dx + xy * dy, xy * dx + yy * dy
        square = dx * pull_x + dy * pull_y
        score += math.exp(-square / widths[1])
        likelihood -= min(MISS, 0.5 * square / variance)
        weight = trust * max(0.0, 1.0 - square / reach) / scatter
        turn_x, turn_y = xx * -off_y + xy * off_x, xy * -off_y + yy * off_x
        gradient[0] += weight * pull_x
        gradient[1] += weight * pull_y
        gradient[2] += weight * (pull_y * off_x - pull_x * off_y)
        hessian[0, 0] += weight * xx
        hessian[0, 1] += weight * xy
        hessian[1, 1] += weight * yy
        hessian[0, 2] += weight * turn_x
        hessian[1, 2] += weight * turn_y
        hessian[2, 2] += weight * (turn_y * off_x - turn_x * off_y)
    hessian[1, 0], hessian[2, 0], hessian[2, 1] = hessian[0, 1], hessian[0, 2], hessian[1, 2]
    return likelihood, score


@compiled("f8(f8[::1], f8[::1], f8[:,::1])")
def prior_cost(pose: np.ndarray, prior: np.ndarray, information: np.ndarray) -> float:
    """Half the squared Mahalanobis distance of a pose from the odometry's."""
    cost = 0.0
    for i in range(3):
        for j in range(3):
            cost += 0.5 * (pose[i] - prior[i]) * information[i, j] * (pose[j] - prior[j])
    return cost


@compiled("void(i4[:,::1], f4[:,:,:,::1], f8[:,::1], f8[::1], f8[:,::1], i8[::1], f8[::1],"
          "i8, f8[::1])")
def search(table: np.ndarray, pool: np.ndarray, beams: np.ndarray, prior: np.ndarray,
           information: np.ndarray, halves: np.ndarray, steps: np.ndarray, stride: int,
           best: np.ndarray) -> None:
    """`best` (3,) becomes the pose on a grid around the prior at which most beams fit.

    The grid has halves[i] steps of steps[i] to either side along axis i.
    """
    best[:] = prior
    most = -math.inf
    pose = np.empty(3)
    for k in range(-halves[2], halves[2] + 1):
        pose[2] = prior[2] + k * steps[2]
        cos, sin = math.cos(pose[2]), math.sin(pose[2])
        for j in range(-halves[1], halves[1] + 1):
            pose[1] = prior[1] + j * steps[1]
            for i in range(-halves[0], halves[0] + 1):
                pose[0] = prior[0] + i * steps[0]
                fit = -prior_cost(pose, prior, information)
                for b in range(0, len(beams), stride):
                    x = pose[0] + cos * beams[b, 0] - sin * beams[b, 1]
                    y = pose[1] + sin * beams[b, 0] + cos * beams[b, 1]
                    fit += value_at(table, pool, math.floor(y), math.floor(x), NEAR)
                if fit > most:
                    most = fit
                    best[:] = pose


@compiled("UniTuple(f8, 2)(i4[:,::1], f4[:,:,:,::1], f8[:,::1], f8[::1], f8[:,::1], f8[::1], i8,"
          "i8, f8[::1], f8[:,::1])")
def refine(table: np.ndarray, pool: np.ndarray, beams: np.ndarray, prior: np.ndarray,
           information: np.ndarray, pose: np.ndarray, iterations: int, kernel: int,
           widths: np.ndarray, lower: np.ndarray) -> tuple[float, float]:
    """(log likelihood, score) at `pose` (3,), which is moved to where scan and prior agree best.

    `lower` (3, 3) becomes the Cholesky factor of the posterior's information there.
    """
    hessian, gradient = np.empty((3, 3)), np.empty(3)
    for step in range(iterations + 1):
        likelihood, score = evaluate(table, pool, beams, pose, kernel, 1, widths, hessian,
                                     gradient)
        hessian += information
        if not cholesky(hessian, lower) or step == iterations:
            break
        for i in range(3):
            for j in range(3):
                gradient[i] += information[i, j] * (pose[j] - prior[j])
        solve_forwards(lower, gradient)
        solve_backwards(lower, gradient)
        pose -= gradient
        if abs(gradient[0]) + abs(gradient[1]) + 50.0 * abs(gradient[2]) < 2e-3:
            break
    return likelihood, score
