"""Moments of the drawn poses against the models' own formulas."""

import numpy as np
import pytest

from nav_algorithms import motion_models

ALPHAS = np.array([0.1, 0.2, 0.3, 0.05, 0.15])
NORMALS = np.random.default_rng(1).normal(size=(20000, 3))
START = np.tile([1.0, 2.0, np.pi / 2], (len(NORMALS), 1))


def drawn(model: str, before: tuple, after: tuple, alphas: np.ndarray = ALPHAS) -> np.ndarray:
    return motion_models.MODELS[model](START, np.array(before), np.array(after), alphas, NORMALS)


@pytest.mark.parametrize("model", motion_models.MODELS)
@pytest.mark.parametrize("step, end", [((2.0, 0, 0), (1, 4, np.pi / 2)),
                                       ((-1.0, 0, 0), (1, 1, np.pi / 2)),
                                       ((0, 0, 1.0), (1, 2, np.pi / 2 + 1)),
                                       ((1.0, 1.0, 0.5), (0, 3, np.pi / 2 + 0.5))])
def test_without_noise_the_odometry_is_followed(model, step, end):
    found = drawn(model, (0, 0, 0), step, np.zeros(5))
    assert found == pytest.approx(np.tile(end, (len(found), 1)))


@pytest.mark.parametrize("model, deviation", [("diff", 0.3 * 2**2),
                                              ("diff-corrected", np.sqrt(0.3 * 2**2)),
                                              ("omni", 0.3 * 2**2),
                                              ("omni-corrected", np.sqrt(0.3 * 2**2))])
def test_noise_along_a_straight_drive(model, deviation):
    only_drive = ALPHAS * [0, 0, 1, 0, 0]
    found = drawn(model, (5, 3, 0), (7, 3, 0), only_drive)
    assert found[:, 1].std() == pytest.approx(deviation, rel=0.03)
    assert found[:, 1].mean() == pytest.approx(4.0, abs=0.03)
    assert found[:, 0] == pytest.approx(np.ones(len(found)))


# diff turns twice, before and after the drive, each with this deviation; on the spot once.
@pytest.mark.parametrize("model, number, step, deviation", [
    ("diff", 1, (0.5, 0, 0), np.sqrt(2) * 0.2 * 0.5**2), ("diff", 0, (0, 0, 0.5), 0.1 * 0.5**2),
    ("omni-corrected", 1, (0.5, 0, 0), np.sqrt(0.2 * 0.5**2)),
    ("omni-corrected", 0, (0, 0, 0.5), np.sqrt(0.1 * 0.5**2))])
def test_turning_noise_of_a_drive_or_a_turn(model, number, step, deviation):
    turns = drawn(model, (0, 0, 0), step, ALPHAS * (np.arange(5) == number))[:, 2] - np.pi / 2
    assert turns.std() == pytest.approx(deviation, rel=0.03)


def test_backwards_is_as_certain_as_forwards():
    forwards = drawn("diff", (0, 0, 0), (1, 0, 0))
    backwards = drawn("diff", (0, 0, 0), (-1, 0, 0))
    assert backwards.std(axis=0) == pytest.approx(forwards.std(axis=0), rel=0.05)


def test_only_omni_drifts_aside():
    aside = ALPHAS * [0, 0, 0, 0, 1]
    assert drawn("diff", (0, 0, 0), (1, 0, 0), aside)[:, 0].std() == 0
    assert drawn("omni-corrected", (0, 0, 0), (1, 0, 0), aside)[:, 0].std() \
        == pytest.approx(np.sqrt(0.15), rel=0.03)


# omni takes the first alpha for it, omni-corrected the fourth, as amcl does.
@pytest.mark.parametrize("model, number, deviation", [
    ("omni", 0, 0.1 * 0.5**2), ("omni-corrected", 3, np.sqrt(0.05 * 0.5**2))])
def test_a_turn_makes_the_length_of_a_drive_unsure(model, number, deviation):
    alphas = ALPHAS * (np.arange(5) == number)
    found = drawn(model, (0, 0, 0), (1.0, 0, 0.5), alphas)
    assert found[:, 1].std() == pytest.approx(deviation, rel=0.03)
