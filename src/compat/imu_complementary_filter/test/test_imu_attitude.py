"""The filter on made-up measurements."""

import numpy as np
import pytest
from imu_complementary_filter.attitude import Attitude, product, rotation_by, turned

DOWN = np.array([0.0, 0.0, 9.81])  # what is felt at rest
NORTH = np.array([1.0, 0.0, -0.5])
DT = 0.01


def felt(quaternion, vector=DOWN):
    """A vector of the world in the IMU's frame."""
    return turned(quaternion * (-1, -1, -1, 1), vector)


def test_the_first_measurement_says_roll_and_pitch_and_north_the_yaw():
    true = product(rotation_by(np.array([0, 0, 0.7])), rotation_by(np.array([0.3, -0.2, 0.0])))
    attitude = Attitude()
    attitude.update(felt(true), np.zeros(3), 0.0)
    np.testing.assert_allclose(felt(attitude.quaternion), felt(true), atol=1e-9)
    attitude = Attitude()
    attitude.update(felt(true), np.zeros(3), 0.0, felt(true, NORTH))
    assert abs(attitude.quaternion @ true) == pytest.approx(1.0, abs=1e-9)


def test_turns_are_followed_and_a_wrong_attitude_is_put_right():
    true, attitude = rotation_by(np.zeros(3)), Attitude(do_bias_estimation=False)
    attitude.update(DOWN, np.zeros(3), 0.0)
    for step in range(300):
        rates = np.array([0.5 * np.cos(0.02 * step), 0.3, 0.2])
        true = product(true, rotation_by(rates * DT))
        attitude.update(felt(true), rates, DT)
    assert abs(attitude.quaternion @ true) > 0.9999
    attitude.quaternion = product(rotation_by(np.array([0.2, 0.0, 0.0])), attitude.quaternion)
    for _ in range(800):
        attitude.update(felt(true), np.zeros(3), DT)
    np.testing.assert_allclose(felt(attitude.quaternion), felt(true), atol=0.01)


def test_the_bias_is_learnt_at_rest_alone():
    bias, attitude = np.array([0.02, -0.01, 0.05]), Attitude()
    for _ in range(1000):
        attitude.update(DOWN, bias, DT)
    assert attitude.is_still
    np.testing.assert_allclose(attitude.bias, bias, atol=1e-4)
    for _ in range(100):
        attitude.update(DOWN, np.array([0.0, 0.0, 1.0]), DT)
    assert not attitude.is_still
    np.testing.assert_allclose(attitude.bias, bias, atol=1e-4)


def test_a_jolt_is_not_gravity():
    """6.6 m/s2 ahead for a second, standing level."""
    for adaptive, most in ((True, 0.001), (False, 0.25)):
        attitude = Attitude(gain_acc=0.05, do_adaptive_gain=adaptive)
        attitude.update(DOWN, np.zeros(3), 0.0)
        for _ in range(100):
            attitude.update(np.array([6.6, 0.0, 9.81]), np.zeros(3), DT)
        pitch = abs(attitude.angles()[1])
        assert pitch < most if adaptive else pitch > most
