"""Trajectory error, on paths whose answers are known."""

import numpy as np
import pytest

from evaluation.trajectory_error import align, at_moments, trajectory_error
from nav_algorithms.poses import compose, invert


def circle(count=50):
    angles = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return np.stack((np.cos(angles), np.sin(angles), angles + np.pi / 2), axis=1)


def test_a_path_that_is_only_moved_has_no_error_once_aligned():
    pose = np.array([1.0, 2.0, 2.5])
    moved = compose(pose, circle())
    found = trajectory_error(moved, circle())
    assert found.ate_rmse == pytest.approx(0.0, abs=1e-12)
    assert found.yaw_rmse == pytest.approx(0.0, abs=1e-12)
    assert found.alignment == pytest.approx(invert(pose))
    apart = np.hypot(*(moved - circle())[:, :2].T)
    assert found.rmse == pytest.approx(np.sqrt(np.mean(apart**2)))
    assert found.largest == pytest.approx(apart.max())


def test_scale_is_not_aligned_away():
    bigger = circle() * [1.1, 1.1, 1.0]
    found = trajectory_error(bigger, circle())
    assert (found.ate_rmse, found.rmse) == (pytest.approx(0.1), pytest.approx(0.1))


def test_alignment_is_the_best_there_is():
    random = np.random.default_rng(0)
    points, targets = random.normal(size=(2, 30, 2))
    best = align(points, targets)

    def error(pose):
        return trajectory_error(compose(pose, np.c_[points, np.zeros(30)]),
                                np.c_[targets, np.zeros(30)]).rmse

    for change in np.vstack((np.eye(3), -np.eye(3))) * 1e-3:
        assert error(best) < error(best + change)


def test_one_wrong_yaw():
    turned = circle()
    turned[0, 2] += 1.0
    assert trajectory_error(turned, circle()).yaw_rmse == pytest.approx(1.0 / np.sqrt(50))


@pytest.mark.parametrize("shape", [(49, 3), (50, 2), (0, 3)])
def test_wrong_shapes(shape):
    with pytest.raises(ValueError, match=r"poses are \(N, 3\) twice"):
        trajectory_error(np.zeros(shape), np.zeros(shape) if shape == (0, 3) else circle())


def test_between_moments():
    stamps = np.array([0.0, 1.0, 2.0])
    poses = np.array([[0.0, 0.0, 3.0], [1.0, 2.0, -3.0], [1.0, 2.0, -3.0]])
    found = at_moments(stamps, poses, np.array([0.5, 1.5, -0.1, 2.1]))
    assert found[0] == pytest.approx([0.5, 1.0, np.pi])  # the short way round
    assert found[1] == pytest.approx([1.0, 2.0, -3.0])
    assert np.isnan(found[2:]).all()
