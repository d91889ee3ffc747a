"""Poses relative to the first one, without topics."""

import numpy as np
import pytest
from robot_localization.filtering.ekf import pose_matrix
from robot_localization.sources import Source


@pytest.fixture
def source():
    made = Source.__new__(Source)
    made.differential, made.relative, made.first = False, True, None
    made.rejections = {"pose": np.inf}
    return made


def at(x):
    return pose_matrix([x, 0, 0], np.eye(3))


def test_what_follows_is_relative_to_the_first_that_is_a_pose(source):
    found = [source.placed(float(time), at(x), np.eye(6), np.ones(6, dtype=bool))
             for time, x in enumerate([np.nan, 5.0, 7.0])]
    assert found[0] is None
    assert [each.values[0] for each in found[1:]] == pytest.approx([0.0, 2.0])
