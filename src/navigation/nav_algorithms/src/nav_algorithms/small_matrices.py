"""Symmetric 3 x 3 matrices in compiled loops, where numpy.linalg would need SciPy."""

from __future__ import annotations

import math

import numpy as np

from nav_algorithms.compiled import compiled


@compiled("b1(f8[:,::1], f8[:,::1])")
def cholesky(matrix: np.ndarray, lower: np.ndarray) -> bool:
    """`lower` becomes L with L L^T = matrix; False if the matrix is not positive definite."""
    for i in range(3):
        for j in range(i + 1):
            left = matrix[i, j]
            for k in range(j):
                left -= lower[i, k] * lower[j, k]
            if i == j:
                if not left > 0.0:
                    return False
                lower[i, i] = math.sqrt(left)
            else:
                lower[i, j] = left / lower[j, j]
                lower[j, i] = 0.0
    return True


@compiled("void(f8[:,::1], f8[::1])")
def solve_forwards(lower: np.ndarray, vector: np.ndarray) -> None:
    """`vector` becomes L^-1 vector."""
    for i in range(3):
        for k in range(i):
            vector[i] -= lower[i, k] * vector[k]
        vector[i] /= lower[i, i]


@compiled("void(f8[:,::1], f8[::1])")
def solve_backwards(lower: np.ndarray, vector: np.ndarray) -> None:
    """`vector` becomes (L^T)^-1 vector."""
    for i in range(2, -1, -1):
        for k in range(i + 1, 3):
            vector[i] -= lower[k, i] * vector[k]
        vector[i] /= lower[i, i]
