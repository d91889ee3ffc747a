"""The arithmetic of fake_localization, on poses whose answers are known."""

import math

import numpy as np
import pytest
from fake_localization.poses import (
    map_to_odom,
    matrix_of,
    offset,
    pose_of,
    transform_matrix,
    transform_of,
)
from geometry_msgs.msg import Point, Pose, Quaternion


def pose(x, y, z=0.0, yaw=0.0):
    return Pose(Point(x, y, z), Quaternion(0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)))


def numbers(found):
    turn = found.orientation
    return [found.position.x, found.position.y, found.position.z, 2 * math.atan2(turn.z, turn.w)]


def test_messages_and_matrices():
    matrix = matrix_of(pose(1.0, 2.0, 3.0, math.pi / 2))
    assert matrix @ [1, 0, 0, 1] == pytest.approx([1, 3, 3, 1])
    assert numbers(pose_of(matrix)) == pytest.approx([1.0, 2.0, 3.0, math.pi / 2])
    assert transform_matrix(transform_of(matrix)) == pytest.approx(matrix)


@pytest.mark.parametrize("wrong", [pose(math.nan, 0.0), Pose(), pose(0.0, math.inf)])
def test_what_is_no_pose(wrong):
    with pytest.raises(ValueError, match="is none"):
        matrix_of(wrong)


def test_an_offset_turns_then_moves():
    moved = offset(1.0, 2.0, math.pi / 2) @ matrix_of(pose(5.0, 0.0))
    assert numbers(pose_of(moved)) == pytest.approx([-1.0, -7.0, 0.0, -math.pi / 2])


def test_the_base_lies_at_the_truth():
    truth, odometry = matrix_of(pose(3.0, 1.0, 0.1, 1.0)), matrix_of(pose(-2.0, 4.0, 0.0, -2.5))
    assert np.allclose(map_to_odom(truth, odometry) @ odometry, truth)
    assert numbers(pose_of(map_to_odom(matrix_of(pose(3.0, 1.0)), matrix_of(pose(2.0, 5.0))))
                   ) == pytest.approx([1.0, -4.0, 0.0, 0.0])
