"""Quaternions of messages as a turn of the robot."""

import math

import pytest
from geometry_msgs.msg import Quaternion

from nav_nodes.messages import is_valid, quaternion_of, yaw_of

HUGE = 1e308  # its square is beyond float64


@pytest.mark.parametrize("yaw", [0.0, 1.0, -3.0])
@pytest.mark.parametrize("length", [1.0, 1e-3, 1e3])
def test_a_turn_about_z_of_any_length(yaw, length):
    q = quaternion_of(yaw)
    q.z, q.w = q.z * length, q.w * length
    assert is_valid(q) and yaw_of(q) == pytest.approx(yaw)


@pytest.mark.parametrize("q", [
    (0, 0, 0, 0), (math.nan, 0, 0, 1), (0, 0, math.inf, 1), (1, 0, 0, 1), (0, 0, HUGE, HUGE)])
def test_what_is_no_turn_about_z_is_no_error(q):
    assert not is_valid(Quaternion(*q))
    yaw_of(Quaternion(*q))
