"""The proposal distribution of particles: the Gaussian from odometry and scan, and a draw from it.

The improved proposal of G. Grisetti, C. Stachniss, W. Burgard, "Improved techniques for grid
mapping with Rao-Blackwellized particle filters" (2007); the Gaussian is that of the Gauss-Newton
matrix at the matched pose, whereas they sample poses around it. Units as in scan_matching.
"""

from __future__ import annotations

import numpy as np

from nav_algorithms.compiled import compiled
from nav_algorithms.scan_matching import evaluate, refine, search
from nav_algorithms.small_matrices import cholesky, solve_backwards


@compiled("void(i4[:,:,::1], f4[:,:,:,::1], f8[:,::1], f8[:,::1], f8[:,::1], f8[:,:,::1],"
          "f8[:,::1], i8[::1], f8[::1], i8, i8, i8, f8[::1], f8, i8, f8[::1], f8[:,::1],"
          "f8[:,:,::1])")
def propose(tables: np.ndarray, pool: np.ndarray, beams: np.ndarray, priors: np.ndarray,
            drawn: np.ndarray, informations: np.ndarray, normals: np.ndarray, halves: np.ndarray,
            steps: np.ndarray, stride: int, iterations: int, kernel: int, widths: np.ndarray,
            fewest: float, skip: int, likelihoods: np.ndarray, matched: np.ndarray,
            factors: np.ndarray) -> None:
    """Moves particles (N): `drawn` (N, 3) become draws from the posterior of odometry and scan.

    They are draws from the odometry before, and stay so if the best score is below `fewest`.
    `priors` (N, 3) and `informations` (N, 3, 3) are the odometry's Gaussian, `normals` (N, 3)
    standard normal draws; `halves`, `steps` and `stride` are the search's, `kernel`, `widths` and
    `skip` the evaluation's. `likelihoods` (N,) become the log likelihoods of the matched poses,
    `matched` (N, 3) those poses, and `factors` (N, 3, 3) the Cholesky factors of the information
    of the draw; 0 if nothing matched.
    """
    hessian = np.empty((3, 3))
    pose, from_prior, gradient, offset = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    searching = halves.max() > 0
    for i in range(len(priors)):
        table, prior, information, lower = tables[i], priors[i], informations[i], factors[i]
        if searching:
            search(table, pool, beams, prior, information, halves, steps, stride, pose)
        else:
            pose[:] = prior
        found, score = refine(table, pool, beams, prior, information, pose, iterations, kernel,
                              widths, lower)
        from_prior[:] = prior
        # Never worse than trusting the odometry.
        staying, there = evaluate(table, pool, beams, from_prior, kernel, 1, widths, hessian,
                                  gradient)
        if staying > found:
            hessian += information
            if cholesky(hessian, lower):
                pose[:] = prior
                score = there
        if score < max(fewest, 1.0):
            pose[:] = drawn[i]
            offset[:] = 0.0
            lower[:] = 0.0
        else:
            offset[:] = normals[i]
            solve_backwards(lower, offset)
        likelihoods[i], score = evaluate(table, pool, beams, pose, kernel, skip, widths, hessian,
                                           gradient)
        matched[i] = pose
        drawn[i] = pose + offset
