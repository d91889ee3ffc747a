"""Estimates whose right answer is known, poses relative to the first, and wrong parameters."""

import math

import numpy as np
import pytest
import rospy
from robot_localization.filtering.ekf import (
    SIZE,
    Ekf,
    angles_of,
    matrix_of,
    moved,
    pose_matrix,
    quaternion_of,
)
from robot_localization.filtering.measurements import (
    BadConfig,
    Filter,
    Measurement,
    chosen,
    moved_twist,
    of_block,
    square,
    turned,
    velocity_between,
    without_gravity,
)
from robot_localization.sources import Source, frame, number

ANGLES = (0.3, -0.4, 2.0)
VX, YAW, YAW_RATE = 6, 5, 11


def quiet():
    return Ekf(process_noise=np.zeros((SIZE, SIZE)))


@pytest.mark.parametrize("between", [1.0, np.nan])  # singular, and no number
def test_a_measurement_without_a_covariance_changes_nothing(between):
    ekf = quiet()
    ekf.covariance = np.zeros((SIZE, SIZE))
    covariance = np.array([[1.0, between], [between, 1.0]])
    assert not ekf.correct(np.array([0, 1]), np.ones(2), covariance)
    assert not ekf.state.any() and not ekf.covariance.any()


def test_a_first_measurement_without_a_covariance_is_none():
    covariance = np.eye(6)
    covariance[0, 1] = covariance[1, 0] = np.nan
    config = np.arange(SIZE) < 6
    assert of_block(1.0, config, 0, np.ones(6), covariance) is None
    config[1] = False  # what is not used may be anything
    assert of_block(1.0, config, 0, np.ones(6), covariance).indices.tolist() == [0, 2, 3, 4, 5]


def test_a_prediction_that_leads_nowhere_changes_nothing():
    ekf = quiet()
    ekf.state[VX] = 1e308
    before = ekf.state.copy()
    with np.errstate(all="ignore"):
        ekf.predict(1e10)
    assert (ekf.state == before).all() and np.isfinite(ekf.covariance).all()


def test_constant_acceleration_ahead():
    state = np.zeros(SIZE)
    state[[VX, 12]] = 2.0, 0.5
    after = moved(state[None], 4.0)[0]
    assert after[[0, VX]] == pytest.approx([2.0 * 4 + 0.5 * 0.5 * 16, 4.0])


def test_a_turned_body_goes_where_it_looks():
    state = np.zeros(SIZE)
    state[3:6], state[6:9] = ANGLES, (1.0, 2.0, 3.0)
    way = matrix_of(quaternion_of(ANGLES)) @ [1.0, 2.0, 3.0]
    assert moved(state[None], 0.1)[0, :3] == pytest.approx(way * 0.1)


def test_rates_turn_it_as_matrices_do():
    state, rates, dt = np.zeros(SIZE), np.array([0.4, -0.2, 0.7]), 1e-4
    state[3:6], state[9:12] = ANGLES, rates
    turn = np.eye(3) + dt * np.cross(np.eye(3), rates)
    after = angles_of(matrix_of(quaternion_of(ANGLES)) @ turn)
    assert moved(state[None], dt)[0, 3:6] == pytest.approx(after, abs=1e-8)


def test_variance_of_a_known_velocity_grows_as_the_time_squared():
    ekf = quiet()
    ekf.covariance = np.zeros((SIZE, SIZE))
    ekf.covariance[VX, VX] = 0.04
    ekf.predict(3.0)
    assert ekf.covariance[0, 0] == pytest.approx(0.04 * 9, rel=1e-6)
    assert ekf.covariance[0, VX] == pytest.approx(0.04 * 3, rel=1e-6)


def test_process_noise_is_a_variance_per_second():
    ekf = Ekf(covariance=np.zeros((SIZE, SIZE)))
    ekf.predict(2.0)
    assert np.diag(ekf.covariance)[[0, 5]] == pytest.approx([0.1, 0.12])


def test_two_equal_opinions_meet_in_the_middle():
    ekf = quiet()
    ekf.covariance = np.eye(SIZE)
    assert ekf.correct(np.array([0]), np.array([2.0]), np.array([[1.0]]))
    assert (ekf.state[0], ekf.covariance[0, 0]) == pytest.approx((1.0, 0.5))


def test_angles_meet_on_the_short_way():
    ekf = quiet()
    ekf.covariance, ekf.state[YAW] = np.eye(SIZE), math.pi - 0.1
    ekf.correct(np.array([YAW]), np.array([-math.pi + 0.1]), np.array([[1.0]]))
    assert abs(ekf.state[YAW]) == pytest.approx(math.pi)


def test_what_is_too_far_off_is_left_out():
    ekf = quiet()
    ekf.covariance = np.eye(SIZE)
    measurement = np.array([0]), np.array([10.0]), np.array([[1.0]])
    assert not ekf.correct(*measurement, rejection=5.0)
    assert ekf.state[0] == 0.0
    assert ekf.correct(*measurement, rejection=8.0)


def test_odometry_of_a_circle_comes_round():
    drive = Filter(flat=True)
    speed, rate = 0.5, 2.0 * math.pi / 10.0
    for i in range(501):
        drive.take([Measurement(1.0 + i / 50.0, np.array([VX, 7, YAW_RATE]),
                                np.array([speed, 0.0, rate]), np.eye(3) * 1e-4)])
    x, y, z = drive.ekf.state[:3]
    assert math.hypot(x, y) < 0.05 and z == pytest.approx(0.0, abs=1e-6)
    assert abs(drive.ekf.state[YAW]) < 0.05
    assert drive.ekf.covariance[0, 0] > 1e-3  # nothing has said where it is


def test_velocity_is_found_from_places_alone():
    drive = Filter()
    for i in range(100):
        drive.take([Measurement(i / 10.0, np.array([0, 1]), np.array([0.3 * i / 10.0, 0.0]),
                                np.eye(2) * 1e-4)])
    assert drive.ekf.state[VX] == pytest.approx(0.3, abs=0.01)


def test_measurements_are_taken_by_their_stamps():
    first, second = (Measurement(t, np.array([0]), np.array([v]), np.eye(1) * 1e-6)
                     for t, v in ((1.0, 5.0), (2.0, 6.0)))
    drive = Filter()
    drive.take([second, first])
    assert drive.stamp == 2.0 and drive.ekf.state[0] == pytest.approx(6.0, abs=0.01)


def test_set_pose_begins_anew():
    drive = Filter()
    drive.take([Measurement(1.0, np.array([VX]), np.array([3.0]), np.eye(1))])
    drive.place(2.0, np.array([1, 2, 0, 0, 0, 0.5]), np.eye(6) * 0.25)
    assert drive.ekf.state[[0, 1, YAW, VX]] == pytest.approx([1.0, 2.0, 0.5, 0.0])
    assert drive.ekf.covariance[0, 0] == 0.25


def test_lever_arm_of_a_sensor_on_a_mast():
    # A sensor 1 m ahead of the base, looking left, while the base turns by 2 rad/s on the spot.
    base = pose_matrix([1.0, 0.0, 0.0], matrix_of(quaternion_of([0, 0, math.pi / 2])))
    assert moved_twist(np.array([2.0, 0, 0, 0, 0, 2.0]), base) == pytest.approx(
        [0, 0, 0, 0, 0, 2.0], abs=1e-12)


def test_velocity_between_two_poses_is_in_the_bodys_frame():
    left = matrix_of(quaternion_of([0, 0, math.pi / 2]))
    before, after = pose_matrix([0, 0, 0], left), pose_matrix([0, 1.0, 0], left)
    assert velocity_between(before, after, 0.5) == pytest.approx([2, 0, 0, 0, 0, 0], abs=1e-12)


def test_a_tilted_accelerometer_at_rest_feels_nothing_else():
    rotation = matrix_of(quaternion_of(ANGLES))
    felt = rotation.T @ [0, 0, 9.8]
    assert without_gravity(felt, rotation, 9.8) == pytest.approx([0, 0, 0], abs=1e-12)


def test_covariances_turn_with_the_frame():
    left = matrix_of(quaternion_of([0, 0, math.pi / 2]))
    assert np.diag(turned(np.diag([1.0, 4, 9, 1, 4, 9]), left)) == pytest.approx(
        [4, 1, 9, 4, 1, 9])


def test_angles_and_quaternions_agree():
    assert angles_of(matrix_of(quaternion_of(ANGLES))) == pytest.approx(ANGLES)
    assert matrix_of([0, 0, 0, 0]) == pytest.approx(np.eye(3))


def test_only_what_is_chosen_and_is_a_number_counts():
    config = chosen([True] * 3 + [False] * 12, "odom0_config")
    found = of_block(1.0, config, 0, np.array([1, np.nan, 3, 4, 5, 6]), np.eye(6))
    assert found.indices.tolist() == [0, 2] and found.values.tolist() == [1, 3]
    assert of_block(1.0, config, 6, np.zeros(6), np.eye(6)) is None


@pytest.mark.parametrize("config", [[True] * 14, "true", None, [0.5] * 15])
def test_configs_that_are_none(config):
    with pytest.raises(BadConfig, match="odom0_config has to be a list of 15 true or false"):
        chosen(config, "odom0_config")


def test_noise_as_matrix_or_diagonal():
    assert square([2.0] * 15, "q") == pytest.approx(np.eye(15) * 2)
    assert square(np.eye(15).ravel().tolist(), "q") == pytest.approx(np.eye(15))
    with pytest.raises(BadConfig, match=r"q has to be .* it has 3"):
        square([1, 2, 3], "q")


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


@pytest.mark.parametrize("value", ["x", [1.0], {}])
def test_what_is_no_number_is_named(monkeypatch, value):
    monkeypatch.setattr(rospy, "get_param", lambda *_: value)
    with pytest.raises(BadConfig, match=r"^frequency is .*; it has to be a number$"):
        number("frequency", 30.0)


def test_numbers_and_frames(monkeypatch):
    monkeypatch.setattr(rospy, "get_param", lambda *_: 20)
    assert number("frequency", 30.0) == 20.0 and frame("map_frame", "map") == "20"
    monkeypatch.setattr(rospy, "get_param", lambda *_: "/map")
    assert frame("map_frame", "map") == "map"
