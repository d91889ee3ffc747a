"""The proposal distribution of particles: the Gaussian from odometry and scan, and a draw from it.

The improved proposal of G. Grisetti, C. Stachniss, W. Burgard, "Improved techniques for grid
mapping with Rao-Blackwellized particle filters" (2007); the Gaussian is that of the Gauss-Newton
matrix at the matched pose, whereas they sample poses around it. Units as in scan_matching.
"""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np
from numba import f4, f8, i4
from numba.types import Tuple

from nav_algorithms.compiled import compiled
from nav_algorithms.scan_matching import evaluate, refine, search
from nav_algorithms.small_matrices import cholesky, solve_backwards


class Odometry(NamedTuple):
    """What the odometry tells of N particles, in cells and rad."""

    priors: np.ndarray        # (N, 3), the middles of its Gaussians
    informations: np.ndarray  # (N, 3, 3)
    drawn: np.ndarray         # (N, 3), draws from them
    normals: np.ndarray       # (N, 3), standard normal draws for the posterior


class Matching(NamedTuple):
    """How scans are matched, as in scan_matching."""

    halves: np.ndarray  # (3,) int64, of the search, as `steps` and `stride`; 0: no search
    steps: np.ndarray   # (3,)
    stride: int
    iterations: int     # of the refinement
    kernel: int         # of the evaluation, as `widths` and `skip`
    widths: np.ndarray  # (3,)
    skip: int
    fewest: float       # the score below which the odometry is believed


ODOMETRY = numba.typeof(Odometry(*[np.zeros((1,) * n) for n in (2, 3, 2, 2)]))
MATCHING = numba.typeof(Matching(np.zeros(3, np.int64), np.zeros(3), 1, 1, 1, np.zeros(3), 1, 1.0))


@compiled(Tuple((f8[:, ::1], f8[::1], f8[:, ::1], f8[:, :, ::1]))(
    i4[:, :, ::1], f4[:, :, :, ::1], f8[:, ::1], ODOMETRY, MATCHING))
def propose(tables: np.ndarray, pool: np.ndarray, beams: np.ndarray, odometry: Odometry,
            matching: Matching) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Draws (N, 3) of particles from the posterior of odometry and scan, and how they came about.

    Those are the log likelihoods (N,) of the matched poses, these poses (N, 3), and the Cholesky
    factors (N, 3, 3) of the draws' information. A particle whose best score is below `fewest` keeps
    the odometry's draw; its factor is 0.
    """
    priors, kernel, widths = odometry.priors, matching.kernel, matching.widths
    moved, likelihoods = np.empty_like(priors), np.empty(len(priors))
    matched, factors = np.empty_like(priors), np.zeros((len(priors), 3, 3))
    hessian = np.empty((3, 3))
    pose, from_prior, gradient, offset = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    searching = matching.halves.max() > 0
    for i in range(len(priors)):
        table, prior, information, lower = (tables[i], priors[i], odometry.informations[i],
                                            factors[i])
        if searching:
            search(table, pool, beams, prior, information, matching.halves, matching.steps,
                   matching.stride, pose)
        else:
            pose[:] = prior
        found, score = refine(table, pool, beams, prior, information, pose,
                              matching.iterations, kernel, widths, lower)
        from_prior[:] = prior
        # Never worse than trusting the odometry.
        staying, there = evaluate(table, pool, beams, from_prior, kernel, 1, widths, hessian,
                                  gradient)
        if staying > found:
            hessian += information
            if cholesky(hessian, lower):
                pose[:] = prior
                score = there
        if score < max(matching.fewest, 1.0):
            pose[:] = odometry.drawn[i]
            offset[:] = 0.0
            lower[:] = 0.0
        else:
            offset[:] = odometry.normals[i]
            solve_backwards(lower, offset)
        likelihoods[i], score = evaluate(table, pool, beams, pose, kernel, matching.skip, widths,
                                         hessian, gradient)
        matched[i] = pose
        moved[i] = pose + offset
    return moved, likelihoods, matched, factors
