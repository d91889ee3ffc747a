"""Distances against all pairs, counted one by one."""

import numpy as np
import pytest

from nav_algorithms import likelihood_field


@pytest.mark.parametrize("seed, share", [(0, 0.01), (1, 0.1), (2, 0.5), (3, 0.002)])
def test_distances_are_those_of_the_nearest_occupied_cell(seed, share):
    occupied = (np.random.default_rng(seed).random((37, 61)) < share).astype(np.uint8)
    occupied[5, 7] = 1
    cells = np.argwhere(np.ones_like(occupied))
    walls = np.argwhere(occupied)
    nearest = np.sqrt(((cells[:, None] - walls[None]) ** 2).sum(-1).min(1)).reshape(37, 61)
    assert likelihood_field.distances(occupied) == pytest.approx(nearest, abs=1e-12)


def test_nothing_occupied_is_infinitely_far():
    assert np.isinf(likelihood_field.distances(np.zeros((4, 3), np.uint8))).all()


def test_one_cell():
    assert likelihood_field.distances(np.ones((1, 1), np.uint8)).tolist() == [[0.0]]
