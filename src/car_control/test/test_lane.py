"""The lane follower on drawn roads: what it sees, how it steers, and whole laps."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from car_control.driving.ackermann import CarGeometry
from car_control.lane.lane_driver import (
    FOLLOWING,
    SEARCHING,
    STOPPED,
    WAITING,
    BendMemory,
    LaneDriver,
    bends_along,
)
from car_control.lane.line_finding import LaneSettings, find_line
from car_control.motor import MotorSettings
from drawn_road import FRAME, Road, drive, track
from node_basics.settings import load_settings

CONFIG = Path(__file__).parents[1] / "config"
SETTINGS = load_settings(LaneSettings, CONFIG / "lane_follow.yaml")
RACETRACK = track(
    (5.1, -3.2, 1.5), (4.9, 3.2, 1.35), (1.9, 3.2, 1.25), (1.1, -0.6, 1.3), (-1.9, -0.6, 1.4),
    (-1.4, 3.2, 1.2), (-5.1, 3.2, 1.6), (-4.9, -3.2, 1.25),
)
OVAL = track((4, -1.5, 1.5), (4, 1.5, 1.5), (-4, 1.5, 1.5), (-4, -1.5, 1.5))


def arc(radius, begin=0.6, end=2.0):
    """Points on a circle that touches the car's axis beneath it; left for a positive radius."""
    angles = np.arange(begin, end, 0.07) / abs(radius)
    return np.stack([abs(radius) * np.sin(angles), radius * (1 - np.cos(angles))], axis=1)


@pytest.mark.parametrize("width_px", [320, 640, 1280])
@pytest.mark.parametrize(("beside", "turned"), [(0.0, 0.0), (0.2, -0.17), (-0.15, 0.1)])
def test_a_straight_line_is_found_where_it_is(width_px, beside, turned):
    road = Road(OVAL, SETTINGS, width_px, width_px * 9 // 16)
    points = find_line(road.view(road.pose(0.0, beside, turned)), SETTINGS).ground
    c, s = math.cos(turned), math.sin(turned)
    across = points[:, 0] * s + points[:, 1] * c + beside  # m left of the line
    near = points[:, 0] < 1.5
    assert near.sum() >= 10 and np.abs(across[near]).max() < 0.01
    assert (np.diff(points[:, 0]) > 0).all()


@pytest.mark.parametrize("light", [0.7, 1.0, 1.3])
def test_light_and_noise_change_little(light):
    road = Road(RACETRACK, SETTINGS)
    plain = find_line(road.view(road.pose(5.0)), SETTINGS).ground
    noisy = find_line(road.view(road.pose(5.0), light, noise=0.04), SETTINGS).ground
    assert noisy[:12] == pytest.approx(plain[:12], abs=0.01)


def test_no_line_is_no_points():
    road = Road(OVAL, SETTINGS)
    assert len(find_line(road.view((0.0, 30.0, 0.0)), SETTINGS).ground) == 0
    assert len(find_line(np.full((360, 640, 3), 255, np.uint8), SETTINGS).ground) == 0
    sky = replace(SETTINGS, camera_pitch=-0.5)
    assert len(find_line(np.zeros((360, 640, 3), np.uint8), sky).ground) == 0


@pytest.mark.parametrize("shape", [(0, 0), (360, 0), (1, 640), (2, 2), (3, 3)])
def test_next_to_no_picture_is_no_points(shape):
    assert find_line(np.zeros((*shape, 3), np.uint8), SETTINGS).ground.shape == (0, 2)


@pytest.mark.parametrize("radius", [-1.0, 1.2, 5.0])
def test_bends_of_an_arc(radius):
    bends = bends_along(arc(radius), 0.2, 0.6)
    assert len(bends) == 7
    assert [bend.curvature for bend in bends] == pytest.approx([1 / radius] * 7, rel=0.03)
    assert bends[0].heading == pytest.approx(0.6 / radius, abs=0.02)


def test_what_was_seen_ahead_is_beneath_the_car_later():
    memory = BendMemory()
    for i in range(100):  # a straight of 1 m, then a bend of 1 m radius
        memory.see(0.5, 1.0 if i * 0.02 + 0.5 > 1.0 else 0.0)
        memory.drive(0.02)
        if i == 24:  # driven 0.5 m
            assert float(memory.curvature(0.2)) == 0.0
    assert float(memory.curvature(-0.9)) == pytest.approx(1.0)  # driven 2 m: the bend began here
    x, y, heading = memory.shape(0.5)[10]
    assert (x, y, heading) == pytest.approx((math.sin(0.5), 1 - math.cos(0.5), 0.5), abs=1e-3)


@pytest.mark.parametrize("radius", [-1.3, 1.3])
def test_on_a_circle_it_steers_the_circle(radius):
    driver = LaneDriver(SETTINGS)
    for frame in range(40):
        command = driver.drive(frame * FRAME, arc(radius))
    assert command.state == FOLLOWING
    assert math.tan(command.steering_angle) / 0.335 == pytest.approx(1 / radius, rel=0.08)
    assert driver.error == pytest.approx(0.0, abs=0.01)
    assert command.speed == pytest.approx(math.sqrt(3.5 * 1.3), rel=0.1)


def test_it_steers_to_a_line_beside_it():
    straight = np.stack([np.arange(0.6, 2.0, 0.1), np.full(14, 0.1)], axis=1)
    command = LaneDriver(SETTINGS).drive(0.0, straight)
    assert command.steering_angle == pytest.approx(SETTINGS.kp * 0.1)
    command = LaneDriver(SETTINGS).drive(0.0, straight * (1, -5))
    assert command.steering_angle == -SETTINGS.max_steering_angle


def states(driver, seen, frames, begin):
    return [driver.drive((begin + i) * FRAME, seen).state for i in range(frames)]


def test_without_ever_a_line_it_stays_where_it_is():
    driver = LaneDriver(SETTINGS)
    assert set(states(driver, np.zeros((0, 2)), 300, 0)) == {WAITING}
    assert driver.drive(10.0, np.zeros((0, 2))).speed == 0.0


def test_a_lost_line_is_searched_and_then_given_up():
    driver, nothing = LaneDriver(SETTINGS), np.zeros((0, 2))
    states(driver, arc(-1.3), 30, 0)
    told = states(driver, nothing, 200, 30)
    assert told[0] == FOLLOWING and told[-1] == STOPPED and SEARCHING in told
    assert told.count(SEARCHING) * FRAME == pytest.approx(SETTINGS.search_time - 0.3, abs=0.1)
    assert driver.drive(230 * FRAME, nothing).speed == 0.0
    assert driver.drive(231 * FRAME, arc(2.0)).state == FOLLOWING


def test_it_searches_slowly_on_the_side_where_the_line_was():
    for side in (-1, 1):
        driver = LaneDriver(SETTINGS)
        states(driver, arc(side * 1.3), 30, 0)
        states(driver, np.zeros((0, 2)), 20, 30)
        command = driver.drive(50 * FRAME, np.zeros((0, 2)))
        assert (command.state, command.speed) == (SEARCHING, SETTINGS.search_speed)
        assert command.steering_angle == side * SETTINGS.max_steering_angle


def test_after_a_pause_it_starts_from_standing():
    driver = LaneDriver(SETTINGS)
    states(driver, arc(5.0), 60, 0)
    assert driver.drive(60 * FRAME, arc(5.0)).speed > 1.5
    assert driver.drive(99.0, arc(5.0)).speed == SETTINGS.search_speed
    assert driver.drive(1.0, arc(5.0)).speed == SETTINGS.search_speed  # the clock was set back


@pytest.mark.parametrize(
    ("beside", "turned", "light"), [(0.2, -0.17, 0.7), (-0.2, 0.17, 1.3)]
)
def test_a_lap_of_the_racetrack(beside, turned, light):
    road, driver = Road(RACETRACK, SETTINGS), LaneDriver(SETTINGS)

    def follow(image, time):
        line = find_line(image, SETTINGS, driver.lateral)
        command = driver.drive(time, line.ground)
        return command.speed, command.steering_angle

    start = road.pose(0.0, beside, turned)
    lateral, seconds = drive(road, follow, start, 60, light=light, noise=0.03)
    assert RACETRACK.length / seconds > 1.5
    assert math.sqrt((lateral**2).mean()) < 0.05
    assert np.abs(lateral[90:]).max() < 0.05  # three seconds on, wherever it began


def test_a_wrong_latency_is_forgiven():
    for latency in (0.0, 0.2):
        settings = replace(SETTINGS, latency=latency)
        road, driver = Road(OVAL, settings), LaneDriver(settings)

        def follow(image, time, driver=driver, settings=settings):
            command = driver.drive(time, find_line(image, settings, driver.lateral).ground)
            return command.speed, command.steering_angle

        lateral, _seconds = drive(road, follow, road.pose(), 40)
        assert math.sqrt((lateral**2).mean()) < 0.03


def test_both_configuration_files_speak_of_one_car():
    motor = load_settings(MotorSettings, CONFIG / "car_control.yaml", "motor_control")
    assert isinstance(motor.geometry, CarGeometry)
    assert motor.wheelbase == SETTINGS.wheelbase
    assert SETTINGS.max_steering_angle <= motor.max_steering_angle
    assert SETTINGS.max_speed <= motor.max_speed
