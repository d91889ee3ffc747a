"""The keys' arithmetic against upstream's steps, slopes and limits; needs no master."""

import pytest
from turtlebot3_teleop.keys import KeyedSpeeds, limits, press, smooth

WAFFLE = limits("waffle")


def after(keys, model="waffle"):
    drive = KeyedSpeeds()
    for key in keys:
        drive = press(drive, key, limits(model))
    return drive


@pytest.mark.parametrize("keys, linear, angular", [
    ("www", 0.03, 0.0), ("x", -0.01, 0.0), ("wwx", 0.01, 0.0),
    ("aa", 0.0, 0.2), ("d", 0.0, -0.1), ("wawd", 0.02, 0.0), ("q", 0.0, 0.0), ("W", 0.0, 0.0),
])
def test_keys_move_the_targets(keys, linear, angular):
    drive = after(keys)
    assert (drive.linear_target, drive.angular_target) == (linear, angular)
    assert (drive.linear, drive.angular) == (0.0, 0.0)  # nothing is sent before `smooth`


@pytest.mark.parametrize("model, linear, angular", [
    ("burger", 0.22, 2.84), ("waffle", 0.26, 1.82), ("waffle_pi", 0.26, 1.82),
    ("robot", 0.22, 2.84),
])
def test_targets_end_at_the_limits_of_the_model(model, linear, angular):
    up, down = after("w" * 50 + "a" * 50, model), after("x" * 50 + "d" * 50, model)
    assert (up.linear_target, up.angular_target) == (linear, angular)
    assert (down.linear_target, down.angular_target) == (-linear, -angular)


def test_what_is_sent_follows_in_small_steps():
    drive = after("wwaaa")  # 0.02 m/s, 0.3 rad/s
    sent = []
    for _ in range(7):
        drive = smooth(drive)
        sent.append((drive.linear, drive.angular))
    assert sent == [(0.005, 0.05), (0.01, 0.1), (0.015, 0.15), (0.02, 0.2), (0.02, 0.25),
                    (0.02, 0.3), (0.02, 0.3)]


def test_slowing_down_is_smooth_too():
    drive = KeyedSpeeds(linear_target=0.0, linear=0.012, angular_target=-0.02, angular=0.04)
    assert smooth(drive) == KeyedSpeeds(0.0, -0.02, 0.007, -0.01)
    assert smooth(smooth(drive)) == KeyedSpeeds(0.0, -0.02, 0.002, -0.02)


@pytest.mark.parametrize("key", [" ", "s"])
def test_stop_keys_stop_at_once(key):
    assert press(smooth(after("wwwaa")), key, WAFFLE) == KeyedSpeeds()
