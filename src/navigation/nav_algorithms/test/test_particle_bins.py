"""How many particles are enough, which belong together, and what they say."""

import numpy as np
import pytest

from nav_algorithms.estimates import (
    bins_of,
    clusters_of,
    estimate,
    have_converged,
    particles_needed,
)


def test_bins_are_half_a_metre_and_ten_degrees():
    poses = np.array([[0.1, 0.1, 0.1], [0.4, 0.4, 0.01], [0.6, 0.1, 0.1], [-0.1, 0.1, 0.1],
                      [0.1, 0.6, 0.1], [0.1, 0.1, 0.2], [0.1, 0.1, 0.1 - 2 * np.pi]])
    bins = bins_of(poses)
    assert bins[0] == bins[1] == bins[6]
    assert len(set(bins)) == 5


def test_as_many_particles_as_fox_says():
    bins = np.arange(20000) % 21
    b = 2 / (9 * 20)
    expected = np.ceil(20 / (2 * 0.02) * (1 - b + np.sqrt(b) * 2.33)**3)
    assert particles_needed(bins, 0.02, 2.33, 10, 20000) == expected + 1
    assert particles_needed(bins[:300], 0.02, 2.33, 10, 300) == 300
    assert particles_needed(bins, 0.02, 2.33, 5000, 20000) == 5001
    assert particles_needed(bins[:50], 0.02, 2.33, 10, 20000) == 50
    assert particles_needed(np.zeros(900, int), 0.02, 2.33, 100, 900) == 101


def test_clusters_touch_and_close_the_circle():
    poses = np.array([[0.2, 0.2, 0.05], [0.7, 0.7, -0.05], [3.2, 0.2, 0.0], [0.2, 0.2, 1.0],
                      [-0.2, 0.2, 0.2]])
    assert clusters_of(poses).tolist() == [clusters_of(poses)[0]] * 2 + [
        clusters_of(poses)[2], clusters_of(poses)[3], clusters_of(poses)[0]]
    assert len(set(clusters_of(poses))) == 3


@pytest.mark.parametrize("side", [1, -1])
def test_clusters_touch_at_corners(side):
    poses = np.array([[0.2, 0.2 * side, 0.05], [0.7, 0.7 * side, 0.05], [1.2, 1.2 * side, -0.05]])
    assert len(set(clusters_of(poses))) == 1


def test_a_bin_in_between_parts_clusters():
    poses = np.array([[0.2, 0.2, 0.05], [1.2, 0.2, 0.05], [0.2, 1.2, 0.05], [0.2, 0.2, 0.4]])
    assert len(set(clusters_of(poses))) == 4


def test_the_estimate_is_of_the_heaviest_cluster_and_unsure_of_all():
    poses = np.array([[1.0, 1.0, np.pi - 0.05], [1.2, 1.0, -np.pi + 0.05], [9.0, 1.0, 0.0],
                      [9.0, 1.0, 0.0], [9.0, 1.0, 0.0]])
    found = estimate(poses, np.array([0.3, 0.3, 0.2, 0.1, 0.1]))
    assert found.pose[:2] == pytest.approx((1.1, 1.0))
    assert abs(found.pose[2]) == pytest.approx(np.pi)
    assert found.share == pytest.approx(0.6)
    assert found.covariance[0, 0] == pytest.approx(0.4 * 0.6 * 7.9**2 + 0.6 * 0.01)
    length = abs(0.6 * np.cos(np.pi - 0.05) + 0.4)
    assert found.covariance[2, 2] == pytest.approx(-2 * np.log(length))


def test_converged_means_all_within_half_a_metre():
    assert have_converged(np.array([[0, 0, 0], [0.9, 0, 3.0]], float))
    assert not have_converged(np.array([[0, 0, 0], [0, 1.1, 0]], float))


def test_particles_that_look_evenly_all_round_have_a_heading_that_nobody_knows():
    particles = np.array([[0.0, 0.0, yaw] for yaw in (0.0, np.pi, -np.pi)])
    covariance = estimate(particles, np.array([0.5, 0.25, 0.25])).covariance
    assert np.pi**2 / 3 < covariance[2, 2] < np.inf  # more than evenly round
